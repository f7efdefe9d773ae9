#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# clang-tidy over our sources that the given build compiles (the tests are left out: their macros are not ours).
#   tidy.sh BUILD_DIR [PATH_REGEX]
set -euo pipefail
build=$(realpath "${1:?usage: tidy.sh BUILD_DIR [PATH_REGEX]}")
cd "$(dirname "$0")/../.."
filter=${2:-.}
sources=$(sed -nE 's/^ *"file": "(.*)",?$/\1/p' "$build/compile_commands.json" | sed "s|^$PWD/||" |
  grep -E '^(platform|vision|loc|hal)/.*\.cpp$' | grep -E "$filter" | sort -u)
[ -n "$sources" ] || { echo "tidy: $build compiles none of our sources" >&2; exit 2; }
echo "tidy: $(wc -l <<<"$sources") files"
# Each run prints its findings at once, so that two runs do not mix their lines.
tr '\n' '\0' <<<"$sources" | sed 's/\x00$//' | xargs -0 -P "$(nproc)" -n 1 bash -c '
  found=$(clang-tidy --quiet -p "$0" "$1" 2>/dev/null) || { printf "%s\n" "$found"; exit 1; }' "$build"
