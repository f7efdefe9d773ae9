# SPDX-License-Identifier: Apache-2.0
set(processor_flags "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard")
set(board_source cmsdk_timer.cpp)
set(board_definitions TIMER_HZ=25000000)
