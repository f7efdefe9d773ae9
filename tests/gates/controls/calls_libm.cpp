// SPDX-License-Identifier: Apache-2.0
// Control of the core's symbol check: calls a function whose last bit depends on the C library.
#include <cmath>
float control_sine(float x) { return std::sin(x); }
