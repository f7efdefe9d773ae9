// SPDX-License-Identifier: Apache-2.0
// The camera frame as vision reads it. The types live in platform/core, since hal delivers them and must not need
// vision.
#pragma once

#include "platform/core/frame.h"
