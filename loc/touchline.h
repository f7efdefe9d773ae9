// SPDX-License-Identifier: Apache-2.0
// All of touchline's core in one header: vision from the camera's frame to features, localization from features to
// pose.
#pragma once

#include "loc/known_junctions.h"
#include "loc/localizer.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"
