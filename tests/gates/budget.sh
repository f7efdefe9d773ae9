#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Holds figures that do not depend on the machine within 5 % of those in budget.txt beside this script. Costlier than that
# fails; so does cheaper, as a budget that is never taken back holds nothing.
#   budget.sh --check|--write PREFIX FIGURES [BUDGET]     FIGURES: lines "PREFIX.name value"; BUDGET: in place of budget.txt
set -euo pipefail
mode=${1:-}
if [ $# -lt 3 ] || [ $# -gt 4 ] || { [ "$mode" != --check ] && [ "$mode" != --write ]; }; then
  echo "usage: $0 --check|--write PREFIX FIGURES [BUDGET]" >&2
  exit 2
fi
prefix=$2
figures=$3
budget=${4:-$(dirname "$0")/budget.txt}
[ -s "$figures" ] || { echo "budget: $figures has no figures" >&2; exit 2; }
for file in "$figures" "$budget"; do
  awk '/^#/ { next }
    NF != 2 || $2 !~ /^[1-9][0-9]*$/ { printf "budget: %s:%d: \"%s\" is not a name and a whole number above 0\n", FILENAME, FNR, $0; bad = 1 }
    $1 in seen { printf "budget: %s:%d: %s stands there twice\n", FILENAME, FNR, $1; bad = 1 }
    { seen[$1] = 1 }
    END { exit bad }' "$file" || exit 2
done
foreign=$(awk -v p="$prefix." 'index($1, p) != 1 {print $1}' "$figures")
[ -z "$foreign" ] || { echo "budget: $figures has figures of others than $prefix: $foreign" >&2; exit 2; }

if [ "$mode" = --write ]; then
  { grep '^#' "$budget"; { awk -v p="$prefix." '!/^#/ && index($1, p) != 1' "$budget"; cat "$figures"; } | sort; } >"$budget.new"
  mv "$budget.new" "$budget"
  exit 0
fi
awk -v p="$prefix." '
  /^#/ { next }
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
