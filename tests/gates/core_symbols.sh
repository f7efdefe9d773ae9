#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The core calls nothing but itself and a handful of C functions, keeps no state outside its objects, and runs nothing
# before main. Checked on what the compiler made, as no reading of the source can: whatever the objects ask of the
# outside has to be on the list below, so allocator, exceptions, clock, libm and printing are all out at once.
#   core_symbols.sh ARCHIVE_OR_OBJECT...
set -euo pipefail
export LC_ALL=C

# memcpy and company: the compiler makes them from plain assignments. sqrtf: IEEE 754 rounds it correctly everywhere;
# g++ calls it for the sake of errno where an argument could be negative. __assert_fail: assertions of Debug builds.
allowed='^(memcpy|memmove|memset|memcmp|bcmp|strlen|sqrtf|__assert_fail|__stack_chk_fail|_GLOBAL_OFFSET_TABLE_|__cxa_pure_virtual|_ZTVN10__cxxabiv1[0-9a-z_]+E)$'

[ $# -gt 0 ] || { echo "usage: $0 ARCHIVE_OR_OBJECT..." >&2; exit 2; }
for file in "$@"; do
  [ -s "$file" ] || { echo "core_symbols: $file is missing or empty" >&2; exit 2; }
done

# Undefined symbols that none of the files defines.
symbols=$(nm --format=posix "$@")
outside=$(awk 'NF >= 2 && $2 ~ /^[UwW]$/ && $3 == "" {print $1}' <<<"$symbols" | sort -u)
defined=$(awk 'NF >= 3 && $2 !~ /^[Uw]$/ {print $1}' <<<"$symbols" | sort -u)
calls=$(comm -23 <(echo "$outside") <(echo "$defined") | grep -vE "$allowed" || true)

# b, d, g, s: data that can be written; u: one per program. Arm's assemblers mark where data begins by the name $d; the
# data has a name of its own.
state=$(awk 'NF >= 3 && $2 ~ /^[bBdDgGsSu]$/ && $1 !~ /^(DW\.ref\.|\$d$)/ {print $1}' <<<"$symbols" | sort -u)
startup=$(readelf --wide --sections "$@" 2>/dev/null | grep -oE '\.(init_array|ctors|fini_array|tbss|tdata)[.0-9]*' | sort -u || true)

failed=0
report() {  # report WHAT LIST: one line per finding, with the object that has it
  [ -n "$2" ] || return 0
  failed=1
  while read -r symbol; do
    printf '%s, forbidden in the core: %s\n' "$1" "$(c++filt "$symbol")"
  done <<<"$2"
}
report "call to the outside" "$calls"
report "state that outlives a call" "$state"
report "section that runs before main or per thread" "$startup"
if [ $failed -ne 0 ]; then
  echo "where: nm -AC $* | grep NAME"
  exit 1
fi
echo "core_symbols: $# files, outside calls: $(comm -23 <(echo "$outside") <(echo "$defined") | tr '\n' ' ')"
