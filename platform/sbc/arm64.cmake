# SPDX-License-Identifier: Apache-2.0
# 64-bit Arm boards (Raspberry Pi 3 and newer, Odroid, Jetson) by Debian's cross compiler; tests run under qemu-user.
#   cmake -S . -B build/arm64 --toolchain platform/sbc/arm64.cmake -DTOUCHLINE_HOST=OFF -DTOUCHLINE_BACKENDS=OFF
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(triplet aarch64-linux-gnu)
set(emulator qemu-aarch64-static)
include(${CMAKE_CURRENT_LIST_DIR}/cross.cmake)
