// SPDX-License-Identifier: Apache-2.0
// Control of the core's symbol check: has a constant that is computed before main.
int control_answer();
extern const int control_constant;
const int control_constant = control_answer();
