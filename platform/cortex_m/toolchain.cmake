# SPDX-License-Identifier: Apache-2.0
# Cortex-M boards with no operating system, by Debian's gcc-arm-none-eabi.
#   cmake -S . -B build/BOARD --toolchain platform/cortex_m/toolchain.cmake -DTOUCHLINE_BOARD=mps2-an500
# A board is boards/NAME.cmake (processor, and which source counts instructions) and boards/NAME.ld (memories).
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # nothing links without a linker script
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TOUCHLINE_BOARD)

set(TOUCHLINE_BOARD mps2-an500 CACHE STRING "A board of platform/cortex_m/boards")
include(${CMAKE_CURRENT_LIST_DIR}/boards/${TOUCHLINE_BOARD}.cmake)  # processor_flags
set(flags "${processor_flags} -mthumb -ffunction-sections -fdata-sections")
set(CMAKE_C_FLAGS_INIT "${flags}")
set(CMAKE_CXX_FLAGS_INIT "${flags} -fno-threadsafe-statics")
# Small functions of other files are inlined: 2 % fewer instructions a frame. Fat objects can be looked at by nm.
set(CMAKE_CXX_FLAGS_RELEASE_INIT "-flto -ffat-lto-objects")
