// SPDX-License-Identifier: Apache-2.0
// The firmware's encoder as the C compiler makes it, for the C++ tests.
#pragma once

#ifdef __cplusplus
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"  // the header is C
#endif
#include "hal/firmware/touchline_gait.h"
#ifdef __cplusplus
#pragma GCC diagnostic pop
#endif

#ifdef __cplusplus
extern "C" {
#endif
uint32_t encode_gait_in_c(const touchline_gait* gait, uint8_t* frame);
#ifdef __cplusplus
}
#endif
