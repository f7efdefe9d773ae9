#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds for a microcontroller with no operating system, plays the recorded sequence in its flash under QEMU, and holds
# every hash against the host's. Writes what it costs to FIGURES, a line "name value" each.
#   cortex_m.sh BOARD HOST_BUILD FOLDER FIGURES [CMAKE_ARGUMENT...]
# Status 77: skipped, for the reason that is printed.
set -euo pipefail
cd "$(dirname "$0")/../.."
[ $# -ge 4 ] || { echo "usage: $0 BOARD HOST_BUILD FOLDER FIGURES [CMAKE_ARGUMENT...]" >&2; exit 2; }
board=$1
host=$(realpath "$2")/platform/cortex_m
folder=$3
figures=$4
shift 4
log=$folder.log
rm -f "$figures"  # those of another run are not this one's
loudly() { "$@" >"$log" 2>&1 || { cat "$log"; exit 1; }; }

mkdir -p "$(dirname "$log")"
bash platform/host/scripts/need.sh build bare >"$log" 2>&1 || { echo "skipped: no compiler or no QEMU for Cortex-M: $(tail -1 "$log")"; exit 77; }
loudly cmake -S . -B "$folder" -G Ninja --toolchain "$PWD/platform/cortex_m/toolchain.cmake" "-DTOUCHLINE_BOARD=$board" \
  -DTOUCHLINE_HOST=OFF -DTOUCHLINE_BACKENDS=OFF -DTOUCHLINE_TESTS=OFF "-DTOUCHLINE_RECORDING=$host/recording" "$@"
loudly cmake --build "$folder" --target playback
elf=$folder/platform/cortex_m/playback.elf

# The link has no C library start-up and no system calls; this says it in names.
bash tests/gates/no_allocator.sh arm-none-eabi-nm "$elf" reset_handler || exit 1
"$host/playback" >"$folder.host.txt"
mapfile -t qemu < <(cmake -DBOARD="$board" -P platform/cortex_m/qemu.cmake 2>&1)
status=0
timeout 300 "${qemu[@]}" -kernel "$elf" </dev/null >"$folder.board.txt" 2>"$folder.qemu.txt" || status=$?
if [ $status -ne 0 ]; then
  case $status in
    97) why="a fault; the program says which" ;;  # fault_status of startup.cpp
    124) why="not at its end after 300 s: does it wait for something that this machine has not?" ;;
    134) why="QEMU stopped: a fault where none can be told; do vector table, stack and memories of boards/$board.ld fit the machine?" ;;
    *) why="what it and QEMU said last" ;;
  esac
  echo "cortex_m: $board ended with status $status: $why"
  tail -5 "$folder.board.txt"
  head -3 "$folder.qemu.txt"
  exit 1
fi
grep '^frame ' "$folder.host.txt" >"$folder.host.frames"
grep '^frame ' "$folder.board.txt" >"$folder.board.frames"
if ! diff "$folder.host.frames" "$folder.board.frames" >"$folder.diff"; then
  echo "cortex_m: $board and the host disagree (< host, > board):"
  head -20 "$folder.diff"
  exit 1
fi

section() { arm-none-eabi-size -A "$elf" | awk -v name="$1" '$1 == name {print $2; found = 1} END {if (!found) print 0}'; }
{
  echo "$board.flash_bytes $(($(section .text) + $(section .ARM.exidx) + $(section .data)))"
  echo "$board.static_ram_bytes $(($(section .data) + $(section .bss)))"
  sed -nE "s/^(state_bytes|stack_bytes|instructions_median|instructions_worst) /$board.\1 /p" "$folder.board.txt"
} >"$figures.new"
mv "$figures.new" "$figures"
echo "$board: $(wc -l <"$folder.host.frames") lines equal to the host's: $(grep -c ' pose ' "$folder.host.frames") frames from pixels to pose"
awk '{printf "  %-36s %12d\n", $1, $2}' "$figures"
