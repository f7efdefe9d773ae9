#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds for a board of another architecture by Debian's cross compiler, and runs the core's tests and the golden outputs
# under qemu-user. Host tools and backends are linked against Debian's packages of that architecture.
#   cross.sh arm64|armhf FOLDER [CMAKE_ARGUMENT...]
# Status 77: skipped, for the reason that is printed.
set -euo pipefail
cd "$(dirname "$0")/../.."
[ $# -ge 2 ] || { echo "usage: $0 arm64|armhf FOLDER [CMAKE_ARGUMENT...]" >&2; exit 2; }
architecture=$1
folder=$2
shift 2
log=$folder.log
loudly() { "$@" >"$log" 2>&1 || { cat "$log"; exit 1; }; }

bash platform/host/scripts/need.sh build test cross >"$log" 2>&1 || { echo "skipped: no cross compiler or no qemu-user: $(tail -1 "$log")"; exit 77; }
tests=(test_core test_hal test_loc test_vision test_vision_image test_vision_lens)
names='^(core|hal|loc|vision|vision_image|vision_lens)$'
arguments=(-DTOUCHLINE_HOST=OFF -DTOUCHLINE_BACKENDS=OFF)
if bash platform/sbc/sysroot.sh "$architecture" "$folder-sysroot" >"$log" 2>&1; then
  arguments=("-DTOUCHLINE_SYSROOT=$PWD/$folder-sysroot")
  tests+=(golden_outputs playback test_hal_linux_camera test_hal_linux_imu test_hal_linux_gait)
  names='^(core|hal|hal_linux_camera|hal_linux_imu|hal_linux_gait|loc|vision|vision_image|vision_lens|golden|playback)$'
  [ "$architecture" = arm64 ] && tests+=(touchline)  # links all backends with the real libraries
else
  echo "skipped: golden outputs and backends on $architecture: $(tail -1 "$log")"
fi
loudly cmake -S . -B "$folder" -G Ninja --toolchain "$PWD/platform/sbc/$architecture.cmake" "${arguments[@]}" "$@"
loudly nice cmake --build "$folder" --target "${tests[@]}"
log=$folder.test.log
loudly ctest --test-dir "$folder" --no-tests=error --parallel "$(nproc)" --output-on-failure -R "$names"
grep -E 'tests passed|Total Test time' "$log"
