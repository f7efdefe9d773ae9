// SPDX-License-Identifier: Apache-2.0
// All of touchline's core in one header: vision from the camera's frame to features, localization from features to
// pose, and the kernels that suit the processor.
#pragma once

// 201709: what compilers say that had not all of C++20 yet.
#if __cplusplus < 201709L
#error "touchline.h needs C++20: compile with -std=c++20 (CMake's touchline::touchline asks for it by itself)"
#endif

#include "loc/known_junctions.h"
#include "loc/localizer.h"
#include "platform/processor/fastest_kernels.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"
