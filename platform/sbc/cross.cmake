# SPDX-License-Identifier: Apache-2.0
# What the toolchain files of this folder share. They set `triplet` and `emulator` first.
#   -DTOUCHLINE_SYSROOT=FOLDER   Debian packages of the board, unpacked by sysroot.sh: needed for TOUCHLINE_HOST and
#                                TOUCHLINE_BACKENDS. Without it, the core and its tests are linked statically, all but the
#                                one that counts allocations (tests/heap).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_C_COMPILER ${triplet}-gcc)
set(CMAKE_CXX_COMPILER ${triplet}-g++)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TOUCHLINE_SYSROOT)

set(CMAKE_CROSSCOMPILING_EMULATOR ${emulator})
if(TOUCHLINE_SYSROOT)
  list(APPEND CMAKE_CROSSCOMPILING_EMULATOR -L /usr/${triplet})
  set(CMAKE_FIND_ROOT_PATH ${TOUCHLINE_SYSROOT})
  set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
  set(CMAKE_CXX_FLAGS_INIT "-isystem ${TOUCHLINE_SYSROOT}/usr/include/${triplet}")
  # Libraries that are needed by libraries only: found when linking, and in the build tree when the tests run.
  set(folders ${TOUCHLINE_SYSROOT}/usr/lib/${triplet} ${TOUCHLINE_SYSROOT}/lib/${triplet})
  foreach(folder IN LISTS folders)
    string(APPEND CMAKE_EXE_LINKER_FLAGS_INIT " -Wl,-rpath-link,${folder}")
  endforeach()
  list(JOIN folders ":" run_path)
  list(APPEND CMAKE_CROSSCOMPILING_EMULATOR -E LD_LIBRARY_PATH=${run_path})
else()
  set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
endif()
