# SPDX-License-Identifier: Apache-2.0
# The emulator's command for a board: of the target play, and one argument a line for a script, with
#   cmake -DBOARD=mps2-an500 -P platform/cortex_m/qemu.cmake
# shift=5: 32 ns pass for an instruction, whatever the machine is busy with; see boards/cmsdk_timer.cpp.
set(qemu_command qemu-system-arm -M ${BOARD} -icount shift=5 -display none -monitor none -serial null
  -chardev stdio,id=out -semihosting-config enable=on,target=native,chardev=out)
if(CMAKE_SCRIPT_MODE_FILE)
  foreach(argument IN LISTS qemu_command)
    message(NOTICE "${argument}")
  endforeach()
endif()
