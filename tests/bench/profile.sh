#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Instructions per stage and frame, by callgrind: the same on every run of one build, however busy the machine is.
#   profile.sh PROFILE_CHAIN FOLDER_FOR_THE_PROFILE [DATASET]
set -euo pipefail
program=${1:?usage: profile.sh PROFILE_CHAIN FOLDER [DATASET]}
folder=${2:?usage: profile.sh PROFILE_CHAIN FOLDER [DATASET]}
# What the program says goes to one file, what valgrind says to another.
frames=$(valgrind --tool=callgrind --log-file="$folder/profile.valgrind" --callgrind-out-file="$folder/profile.callgrind" \
  --toggle-collect='touchline::Pipeline::process*' --toggle-collect='touchline::Localizer::update(*' \
  "$program" ${3:+"$3"} 2>"$folder/profile.log" | awk '/^[1-9][0-9]* frames/ {print $1}') || frames=
if [ -z "$frames" ]; then
  echo "profile: $program did not come to its end" >&2
  if [ -s "$folder/profile.log" ]; then cat "$folder/profile.log"; else cat "$folder/profile.valgrind"; fi >&2
  exit 1
fi
callgrind_annotate --inclusive=yes --threshold=100 "$folder/profile.callgrind" | awk -v frames="$frames" '
  function row(name) { gsub(",", "", $1); listed = 1; printf "| %s | %.0f |\n", name, $1 / frames }
  BEGIN { print "| stage | instructions a frame |\n|---|---|" }
  END { if (!listed) { print "profile: no stages in it; has the program lost its symbols?" >"/dev/stderr"; exit 1 } }
  match($0, /Pipeline::(average|find_green_stage|find_roi|find_candidates|make_line_mask|make_skeleton|digest_skeleton|build_graph|find_features|make_line_points|process)\(/) && !($0 in seen) {
    name = substr($0, RSTART + 10, RLENGTH - 11); if (!done[name]++) row(name) }
  /Localizer::update\(/ && !done["update"]++ { row("localize") }'
