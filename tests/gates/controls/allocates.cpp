// SPDX-License-Identifier: Apache-2.0
// Control of the core's symbol check: takes memory from the heap.
int* control_allocates(int value) { return new int(value); }
