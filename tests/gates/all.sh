#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# All gates, one after the other; ends at the first that is red and says which. Builds go to build/check/.
#   all.sh [GATE...]      some gates only; their names stand in the line all=(...) below
set -euo pipefail
cd "$(dirname "$0")/../.."
checks=build/check
jobs=$(nproc)
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache)

# A good step says one line, a bad one all it has.
quietly() {  # quietly LOG COMMAND...
  "${@:2}" >"$1" 2>&1 || { cat "$1"; return 1; }
}
configure() {  # configure NAME CC CXX CMAKE_ARGUMENT...
  local name=$1 cc=$2 cxx=$3
  shift 3
  quietly "$checks/$name.log" cmake -S . -B "$checks/$name" -G Ninja -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" "${launcher[@]}" "$@"
}
compile() { quietly "$checks/$1.log" cmake --build "$checks/$1" --parallel "$jobs" "${@:2}"; }
run_tests() {
  quietly "$checks/$1.test.log" ctest --test-dir "$checks/$1" --no-tests=error --parallel "$jobs" --output-on-failure "${@:2}" || return 1
  grep -E 'tests passed|Total Test time' "$checks/$1.test.log"
}

gate_format() { bash tests/gates/format.sh; }
# The README's command, word for word; g++ with -O3.
gate_test() { quietly "$checks/test.log" env -u MAKEFLAGS -u MAKELEVEL make test && grep -E 'tests passed|Total Test time' "$checks/test.log"; }
# The benchmark is no part of the usual build, and would rot without this.
gate_clang() { configure clang clang clang++ && compile clang && compile clang --target bench_programs && run_tests clang; }
# The core and its tests, with nothing of a vendor or of the host tools.
gate_core() {
  configure core gcc g++ -DTOUCHLINE_BACKENDS=OFF -DTOUCHLINE_HOST=OFF && compile core && run_tests core || return 1
  if grep -nE 'hal/linux|libv4l|libgpiod|-lgpiod|hidapi' "$checks/core/build.ninja" "$checks/core/compile_commands.json"; then
    echo "core: the build without backends still names a vendor's package"
    return 1
  fi
}
gate_sanitize() {
  configure sanitize gcc g++ -DTOUCHLINE_SANITIZE=ON -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO='-O1 -g' \
    -DCMAKE_C_FLAGS_RELWITHDEBINFO='-O1 -g' && compile sanitize && run_tests sanitize
}
# The golden outputs by both compilers without optimisation (and with assertions); the gates above had them with -O3.
gate_golden() {
  local cc cxx
  for cc in gcc clang; do
    cxx=${cc/gcc/g++}
    cxx=${cxx/clang/clang++}
    configure "$cc-O0" "$cc" "$cxx" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 || return 1
    compile "$cc-O0" --target golden_outputs && run_tests "$cc-O0" -R '^golden$' || return 1
  done
}
# The acceptance figures, where the data sets lie beside the project (or TOUCHLINE_DATA names their folder).
gate_accept() {
  local data
  for data in "${TOUCHLINE_DATA:-}" ../*/data; do
    [ -d "$data/render-table2" ] || continue
    make --no-print-directory accept DATA="$data" 2>"$checks/accept.log" || { cat "$checks/accept.log"; return 1; }
    return 0
  done
  echo "no data sets beside the project, and TOUCHLINE_DATA names none"
  return 77
}
# Boards: other processors under qemu-user, and a microcontroller with no operating system. They need the host's build
# in build/ (gate test) for its recording.
gate_arm64() { bash tests/gates/cross.sh arm64 "$checks/arm64" "${launcher[@]}"; }
gate_armhf() { bash tests/gates/cross.sh armhf "$checks/armhf" "${launcher[@]}"; }
host_playback() { quietly "$checks/playback.log" cmake --build build --parallel "$jobs" --target playback; }
boards=(mps2-an500 mps2-an386 mps2-an505)  # that QEMU has
measure_boards() {
  local board
  host_playback || return 1
  for board in "${boards[@]}"; do
    bash tests/gates/cortex_m.sh "$board" build "$checks/$board" "$checks/$board.figures" "${launcher[@]}" || return $?
  done
}
measure_host() { host_playback && bash tests/gates/host_figures.sh build "$checks/x86-64.figures"; }
budget_of() {  # budget_of --check|--write PREFIX...
  local prefix
  for prefix in "${@:2}"; do
    bash tests/gates/budget.sh "$1" "$prefix" "$checks/$prefix.figures" || return 1
  done
}
gate_cortex_m() { measure_boards && budget_of --check "${boards[@]}"; }
gate_budget() { measure_host && budget_of --check x86-64; }
# Not among all: what `make budget` does. Nothing is written before all is measured.
gate_new_budget() {
  if ! measure_boards || ! measure_host; then
    echo "budget.txt stays as it is: not all could be measured"
    return 1
  fi
  budget_of --write "${boards[@]}" x86-64
}
# Random input for the decoders and readers, half a minute each from the corpus that is kept.
gate_fuzz() { bash tests/fuzz/fuzz.sh 30; }
# The whole robot on a real kernel, by the build of the gate "test". "skipped" is said where QEMU cannot be had.
gate_vm() {
  local status=0
  bash tests/vm/vm.sh build >"$checks/vm.log" 2>&1 || status=$?
  [ $status = 0 ] || [ $status = 77 ] || { cat "$checks/vm.log"; return 1; }
  grep -E '^(robot:|vmtest:|skipped)' "$checks/vm.log"
  return $status
}
gate_tidy() { configure clang clang clang++ && bash tests/gates/tidy.sh "$checks/clang"; }

all=(format test clang core sanitize tidy golden fuzz vm accept arm64 armhf cortex_m budget)
mkdir -p "$checks"
for gate in "${@:-${all[@]}}"; do
  declare -F "gate_$gate" >/dev/null || { echo "all.sh: unknown gate '$gate' (${all[*]})" >&2; exit 2; }
  echo "=== gate $gate"
  started=$SECONDS
  status=0
  "gate_$gate" || status=$?
  if [ "$status" -eq 77 ]; then
    echo "=== gate $gate: SKIPPED, for the reason above"
    continue
  fi
  if [ "$status" -ne 0 ]; then
    echo "=== gate $gate: FAILED after $((SECONDS - started)) s"
    exit 1
  fi
  echo "=== gate $gate: passed in $((SECONDS - started)) s"
done
