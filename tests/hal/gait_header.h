// SPDX-License-Identifier: Apache-2.0
// The firmware's encoder as the C compiler makes it, for the C++ tests.
#pragma once

#include "hal/firmware/touchline_gait.h"  // without a warning in C++ either, -Wold-style-cast and all

#ifdef __cplusplus
extern "C" {
#endif
uint32_t encode_gait_in_c(const touchline_gait* gait, uint8_t* frame);
#ifdef __cplusplus
}
#endif
