#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs the fuzz targets, each for SECONDS (default 600), from good inputs in tests/fuzz/seeds and from what was
# found before, in tests/fuzz/corpus. Inputs that reach
# new code are kept there with --keep. A finding ends the run and leaves its input in build/fuzz.
#   fuzz.sh [--keep] [SECONDS [TARGET...]]
set -euo pipefail
cd "$(dirname "$0")/../.."
keep=0
[ "${1:-}" = --keep ] && { keep=1; shift; }
seconds=${1:-600}
[ $# -gt 0 ] && shift
targets=("${@:-gait hid toml jsonl image}")
read -ra targets <<<"${targets[*]}"
build=build/fuzz
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache)
mkdir -p build
flags='-O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all'
cmake -S . -B "$build" -G Ninja -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DTOUCHLINE_FUZZ=ON -DTOUCHLINE_TESTS=OFF \
  -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="$flags" -DCMAKE_C_FLAGS="$flags" "${launcher[@]}" >build/fuzz.log 2>&1 ||
  { cat build/fuzz.log; exit 1; }
cmake --build "$build" --target "${targets[@]/#/fuzz_}" >build/fuzz.log 2>&1 || { cat build/fuzz.log; exit 1; }

limit() { case $1 in image) echo 16384 ;; gait) echo 2048 ;; hid) echo 128 ;; toml) echo 16384 ;; *) echo 4096 ;; esac; }
# Says all it has to say at once: two targets run at a time.
fuzz_one() {  # fuzz_one TARGET
  local target=$1 corpus=tests/fuzz/corpus/$1 found=$build/found/$1
  mkdir -p "$corpus" "$found"
  "$build/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -max_len="$(limit "$target")" -timeout=10 -rss_limit_mb=2048 \
    -print_final_stats=1 -artifact_prefix="$build/$target-" "$found" "$corpus" "tests/fuzz/seeds/$target" >"$build/$target.log" 2>&1 ||
    { echo "$(tail -40 "$build/$target.log")"$'\n'"=== fuzz $target: FAILED, the input is in $build/$target-*"; return 1; }
  echo "=== fuzz $target for $seconds s: $(awk '/number_of_executed_units/ {print $2}' "$build/$target.log") inputs, no finding"
}
keep_corpus() {  # keep_corpus TARGET
  local target=$1 corpus=tests/fuzz/corpus/$1
  rm -rf "$build/merged"
  mkdir -p "$build/merged"
  "$build/tests/fuzz/fuzz_$target" -merge=1 -use_counters=0 -max_len="$(limit "$target")" "$build/merged" "$corpus" "tests/fuzz/seeds/$target" "$build/found/$target" >"$build/merge.log" 2>&1
  rm -rf "$corpus"
  mkdir -p "$corpus"
  cp "$build/merged"/* "$corpus"/
  echo "corpus of $target: $(find "$corpus" -type f | wc -l) inputs"
}

export build seconds
export -f limit fuzz_one
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I{} bash -c 'fuzz_one {}'
[ $keep = 0 ] || for target in "${targets[@]}"; do keep_corpus "$target"; done
