#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The layering check has to fail on a tree that breaks one rule, and pass on the same tree without the breach.
set -euo pipefail
check=$(dirname "$(realpath "$0")")/layering.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
licence='// SPDX-License-Identifier: Apache-2.0'

fresh() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree"/{platform/core,vision,loc,hal/linux,tests}
  printf '%s\n#include <array>\n' "$licence" >"$tree/platform/core/a.h"
  printf '%s\n#include "platform/core/a.h"\n' "$licence" >"$tree/vision/b.h"
  printf '%s\n#include <linux/videodev2.h>\n' "$licence" >"$tree/hal/linux/camera.cpp"
}
expect_failure() {  # expect_failure FILE INCLUDE
  fresh
  printf '%s\n#include %s\n' "$licence" "$2" >"$tree/$1"
  if bash "$check" "$tree" >/dev/null; then
    echo "layering_control: '#include $2' in $1 went unseen"
    exit 1
  fi
}

fresh
bash "$check" "$tree" >/dev/null || { echo "layering_control: a clean tree was refused"; bash "$check" "$tree"; exit 1; }
expect_failure vision/c.cpp '"hal/camera.h"'
expect_failure loc/c.cpp '"hal/camera.h"'
expect_failure vision/c.cpp '"loc/field.h"'
expect_failure platform/core/c.h '"vision/b.h"'
expect_failure platform/core/c.h '<vector>'
expect_failure vision/c.cpp '<cmath>'
expect_failure vision/c.cpp '<immintrin.h>'
expect_failure loc/c.h '<Eigen/Dense>'
expect_failure loc/c.cpp '<chrono>'
expect_failure hal/imu.h '"loc/field.h"'
expect_failure tests/c.cpp '<gpiod.h>'
fresh
echo '#include <array>' >"$tree/vision/no_licence.h"
if bash "$check" "$tree" >/dev/null; then
  echo "layering_control: a missing licence went unseen"
  exit 1
fi
echo "layering_control: every breach was seen"
