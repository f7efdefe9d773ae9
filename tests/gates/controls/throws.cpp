// SPDX-License-Identifier: Apache-2.0
// Control of the core's symbol check: throws.
void control_throws(int value) {
  if (value < 0) throw value;
}
