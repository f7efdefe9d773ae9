#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Holds figures that do not depend on the machine within 5 % of those in budget.txt beside this script. Costlier than that
# fails; so does cheaper, as a budget that is never taken back holds nothing.
#   budget.sh --check|--write PREFIX FIGURES     FIGURES: lines "PREFIX.name value"
set -euo pipefail
[ $# -eq 3 ] && { [ "$1" = --check ] || [ "$1" = --write ]; } || { echo "usage: $0 --check|--write PREFIX FIGURES" >&2; exit 2; }
mode=$1
prefix=$2
figures=$3
budget=$(dirname "$0")/budget.txt
[ -s "$figures" ] || { echo "budget: $figures has no figures" >&2; exit 2; }

if [ "$mode" = --write ]; then
  { grep '^#' "$budget"; { awk -v p="$prefix." '!/^#/ && index($1, p) != 1' "$budget"; cat "$figures"; } | sort; } >"$budget.new"
  mv "$budget.new" "$budget"
  exit 0
fi
awk -v p="$prefix." '
  /^#/ || NF != 2 { next }
  FNR == NR { if (index($1, p) == 1) allowed[$1] = $2; next }
  { found[$1] = $2 }
  END {
    for (name in allowed) if (!(name in found)) { printf "budget: %s was not measured\n", name; bad = 1 }
    for (name in found) {
      if (!(name in allowed)) { printf "budget: %s = %d has no line in budget.txt\n", name, found[name]; bad = 1; continue }
      change = 100 * (found[name] - allowed[name]) / allowed[name]
      if (change > 5 || change < -5) { printf "budget: %s is %d, budget.txt says %d (%+.1f %%)\n", name, found[name], allowed[name], change; bad = 1 }
    }
    if (bad) print "Where the change is meant: make budget, and say why in the commit."
    exit bad
  }' "$budget" "$figures"
echo "budget: $(wc -l <"$figures") figures of $prefix within 5 % of budget.txt"
