// SPDX-License-Identifier: Apache-2.0
// Control of the core's symbol check: remembers something between calls, outside any object of the caller.
int control_counts() {
  static int calls = 0;
  return ++calls;
}
