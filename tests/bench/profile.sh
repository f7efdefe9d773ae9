#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Instructions per stage and frame, by callgrind: the same on every run of one build, however busy the machine is.
#   profile.sh PROFILE_CHAIN FOLDER_FOR_THE_PROFILE [DATASET]
set -euo pipefail
program=${1:?usage: profile.sh PROFILE_CHAIN FOLDER [DATASET]}
folder=${2:?usage: profile.sh PROFILE_CHAIN FOLDER [DATASET]}
frames=$(valgrind --tool=callgrind --callgrind-out-file="$folder/profile.callgrind" --toggle-collect='touchline::Pipeline::process*' \
  --toggle-collect='touchline::Localizer::update(*' "$program" ${3:+"$3"} 2>"$folder/profile.log" | awk '/frames/ {print $1}') || {
  cat "$folder/profile.log"; exit 1; }
callgrind_annotate --inclusive=yes --threshold=100 "$folder/profile.callgrind" | awk -v frames="$frames" '
  function row(name) { gsub(",", "", $1); printf "| %s | %.0f |\n", name, $1 / frames }
  BEGIN { print "| stage | instructions a frame |\n|---|---|" }
  match($0, /Pipeline::(average|find_green_stage|find_roi|find_candidates|make_line_mask|make_skeleton|digest_skeleton|build_graph|find_features|find_posts|make_line_points|process)\(/) && !($0 in seen) {
    name = substr($0, RSTART + 10, RLENGTH - 11); if (!done[name]++) row(name) }
  /Localizer::update\(/ && !done["update"]++ { row("localize") }'
