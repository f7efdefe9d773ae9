#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The budget has to refuse what is costlier, cheaper, missing, new or no number, and to leave the file alone where the
# figures are no good; and to pass what is within 5 %.
set -euo pipefail
check=$(dirname "$(realpath "$0")")/budget.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
budget=$work/budget.txt
figures=$work/figures
printf '# a comment\na.x 1000\na.y 200\nb.x 7\n' >"$work/good"
expect() {  # expect STATUS FINDING MODE FIGURES_TEXT [BUDGET_TEXT]
  local status=0
  cp "$work/good" "$budget"
  [ $# -lt 5 ] || printf '%b' "$5" >"$budget"
  cp "$budget" "$work/before"
  printf '%b' "$4" >"$figures"
  bash "$check" "$3" a "$figures" "$budget" >"$work/said" 2>&1 || status=$?
  if [ $status -ne "$1" ] || { [ -n "$2" ] && ! grep -qF -- "$2" "$work/said"; }; then
    echo "budget_control: status $status in place of $1, or no '$2', of $3 '$4' '${5:-}'"
    cat "$work/said"
    exit 1
  fi
  if [ "$1" -ne 0 ] && ! cmp -s "$budget" "$work/before"; then
    echo "budget_control: figures that are no good were written: '$4'"
    exit 1
  fi
}

expect 0 'within 5 %' --check 'a.x 1050\na.y 190\n'
expect 1 '+5.1 %' --check 'a.x 1051\na.y 200\n'
expect 1 '-5.5 %' --check 'a.x 1000\na.y 189\n'
expect 1 'a.y was not measured' --check 'a.x 1000\n'
expect 1 'has no line' --check 'a.x 1000\na.y 200\na.z 1\n'
for mode in --check --write; do
  expect 2 'has no figures' $mode ''
  expect 2 'whole number' $mode 'a.x 0\na.y 200\n'
  expect 2 'whole number' $mode 'a.x\na.y 200\n'
  expect 2 'of others' $mode 'a.x 1000\nb.x 7\n'
  expect 2 'whole number' $mode 'a.x 1000\n' 'a.x abc\n'
  expect 2 'whole number' $mode 'a.x 1000\n' 'a.x 0\n'
  expect 2 'twice' $mode 'a.x 1000\n' 'a.x 1000\na.x 1000\n'
done
expect 0 '' --write 'a.x 5\n'
printf '# a comment\na.x 5\nb.x 7\n' | cmp - "$budget" || { echo "budget_control: written wrongly"; exit 1; }
echo "budget_control: ok"
