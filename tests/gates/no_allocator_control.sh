#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The check for allocators has to fail on objects that allocate or throw, on one without names, and where nm fails; and
# to pass on one that does none of these.
#   no_allocator_control.sh NM STRIP CLEAN ALLOCATING THROWING...
set -euo pipefail
[ $# -ge 5 ] || { echo "usage: $0 NM STRIP CLEAN ALLOCATING THROWING..." >&2; exit 2; }
nm=$1
strip=$2
clean=$3
shift 3
check=$(dirname "$(realpath "$0")")/no_allocator.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
expect() {  # expect STATUS FINDING NM PROGRAM KNOWN
  local status=0
  bash "$check" "${@:3}" >"$work/said" 2>&1 || status=$?
  if [ $status -ne "$1" ] || { [ -n "$2" ] && ! grep -qF -- "$2" "$work/said"; }; then
    echo "no_allocator_control: status $status in place of $1, or no '$2', of: ${*:3}"
    cat "$work/said"
    exit 1
  fi
}
known_of() { "$nm" --format=posix "$1" | awk '$2 == "T" && !n++ {print $1}'; }

known=$(known_of "$clean")
expect 0 "" "$nm" "$clean" "$known"
for program in "$@"; do
  expect 1 "contains an allocator or exceptions" "$nm" "$program" "$(known_of "$program")"
done
expect 2 "has no symbol" "$nm" "$clean" "$known.elsewhere"
cp "$clean" "$work/stripped"
"$strip" "$work/stripped"
expect 2 "has no symbol" "$nm" "$work/stripped" "$known"
expect 2 "cannot read" "$nm" "$work/missing" "$known"
expect 2 "cannot read" false "$clean" "$known"
expect 2 "cannot read" "$work/no-such-nm" "$clean" "$known"
echo "no_allocator_control: ok"
