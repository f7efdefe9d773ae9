# SPDX-License-Identifier: Apache-2.0
# Cortex-M boards with no operating system, by Debian's gcc-arm-none-eabi. After the host's build in build/, which makes
# the recording:
#   cmake -S . -B build/BOARD -G Ninja --toolchain platform/cortex_m/toolchain.cmake -DTOUCHLINE_BOARD=BOARD
# A board is boards/NAME.cmake (processor, and which source counts instructions) and boards/NAME.ld (memories).
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # nothing links without a linker script
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TOUCHLINE_BOARD)

set(TOUCHLINE_BOARD mps2-an500 CACHE STRING "A board of platform/cortex_m/boards")
set(board_file ${CMAKE_CURRENT_LIST_DIR}/boards/${TOUCHLINE_BOARD})
if(NOT EXISTS ${board_file}.cmake OR NOT EXISTS ${board_file}.ld)
  file(GLOB boards RELATIVE ${CMAKE_CURRENT_LIST_DIR}/boards ${CMAKE_CURRENT_LIST_DIR}/boards/*.cmake)
  list(TRANSFORM boards REPLACE "[.]cmake$" "")
  list(JOIN boards ", " boards)
  message(FATAL_ERROR "TOUCHLINE_BOARD: '${TOUCHLINE_BOARD}' needs boards/${TOUCHLINE_BOARD}.cmake and "
                      "boards/${TOUCHLINE_BOARD}.ld in platform/cortex_m; those with a .cmake are: ${boards}")
endif()
include(${board_file}.cmake)  # processor_flags
separate_arguments(flags UNIX_COMMAND "${processor_flags} -mthumb -ffunction-sections -fdata-sections")
# Given with each run of CMake, so that another board and edited flags count in a folder that was configured before;
# CMAKE_CXX_FLAGS_INIT counts in the first run alone.
add_compile_options(${flags} "$<$<COMPILE_LANGUAGE:CXX>:-fno-threadsafe-statics>")
add_link_options(${flags} -fno-threadsafe-statics)
# Small functions of other files are inlined: 2 % fewer instructions a frame. Fat objects can be looked at by nm.
add_compile_options("$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-flto;-ffat-lto-objects>")
add_link_options("$<$<CONFIG:Release>:-flto;-ffat-lto-objects>")
