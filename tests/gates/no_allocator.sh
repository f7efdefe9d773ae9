#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A program has neither allocator nor exceptions in it, by its names. A program whose names cannot be read, or that has
# been stripped of them, does not pass: KNOWN is a symbol that has to be there.
#   no_allocator.sh NM PROGRAM KNOWN      NM: arm-none-eabi-nm, or nm
set -euo pipefail
[ $# -eq 3 ] || { echo "usage: $0 NM PROGRAM KNOWN" >&2; exit 2; }
names=$("$1" --format=posix "$2" | awk '{print $1}') || { echo "no_allocator: $1 cannot read $2"; exit 2; }
grep -qxF -- "$3" <<<"$names" || { echo "no_allocator: $2 has no symbol $3; is it stripped?"; exit 2; }
if found=$(grep -xE '_*(malloc|calloc|realloc|free|sbrk)(_r)?|_Zn[aw][jm].*|__cxa_(throw|allocate_exception)' <<<"$names"); then
  echo "no_allocator: $2 contains an allocator or exceptions: $(tr '\n' ' ' <<<"$found")"
  exit 1
fi
