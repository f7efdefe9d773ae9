# SPDX-License-Identifier: Apache-2.0
set(processor_flags "-mcpu=cortex-m33 -mfpu=fpv5-sp-d16 -mfloat-abi=hard")
set(board_source cmsdk_timer.cpp)
set(board_definitions TIMER_HZ=20000000)
