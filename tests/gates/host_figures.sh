#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Instructions per stage under callgrind while the host plays the microcontrollers' recording, and bytes of state.
#   host_figures.sh HOST_BUILD FIGURES
# Status 77: skipped, for the reason that is printed.
set -euo pipefail
cd "$(dirname "$0")/../.."
[ $# -eq 2 ] || { echo "usage: $0 HOST_BUILD FIGURES" >&2; exit 2; }
build=$1
figures=$2
work=$(dirname "$figures")
rm -f "$figures"  # those of another run are not this one's
bash platform/host/scripts/need.sh profile >"$figures.log" 2>&1 || { echo "skipped: no valgrind: $(tail -1 "$figures.log")"; exit 77; }
bash tests/bench/profile.sh "$build/platform/cortex_m/playback" "$work" >"$figures.profile"
{
  awk -F '[|]' '$3 ~ /[0-9]/ {gsub(" ", "", $2); gsub(" ", "", $3); print "x86-64." $2 "_instructions " $3}' "$figures.profile"
  "$build/platform/host/touchline" memory | awk '/FIFO of [0-9]+ frame/ {depth = ($4 == "1") ? 1 : 4; size = $1}
    /vision and localization/ {sub(",", "", size); print "x86-64.state_" size "_depth" depth "_bytes " $4}'
} >"$figures.new"
mv "$figures.new" "$figures"
awk '{printf "  %-44s %12d\n", $1, $2}' "$figures"
