# SPDX-License-Identifier: Apache-2.0
set(processor_flags "-mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard")
set(board_source cmsdk_timer.cpp)
set(board_definitions TIMER_HZ=25000000)
