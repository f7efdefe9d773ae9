# SPDX-License-Identifier: Apache-2.0
# 32-bit Arm boards with a floating-point unit (ARMv7, Debian armhf) by Debian's cross compiler; tests run under qemu-user.
#   cmake -S . -B build/armhf --toolchain platform/sbc/armhf.cmake -DTOUCHLINE_HOST=OFF -DTOUCHLINE_BACKENDS=OFF
set(CMAKE_SYSTEM_PROCESSOR armv7l)
set(triplet arm-linux-gnueabihf)
set(emulator qemu-arm-static)
include(${CMAKE_CURRENT_LIST_DIR}/cross.cmake)
# g++ 12 sees an overlap where a text is put before another: its bug 105651, which shows on 32 bits.
string(APPEND CMAKE_CXX_FLAGS_INIT " -Wno-restrict")
