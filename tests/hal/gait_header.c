// SPDX-License-Identifier: Apache-2.0
// Compiles the firmware's header as C99; the tests link this, and the size check compiles it for the Cortex-M7.
#include "tests/hal/gait_header.h"

uint32_t encode_gait_in_c(const touchline_gait* gait, uint8_t* frame) { return touchline_gait_encode(gait, frame); }
