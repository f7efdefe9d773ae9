#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Holds every source against .clang-format; with --write it puts them in order instead.
#   format.sh [--write]
set -euo pipefail
cd "$(dirname "$0")/../.."
mode=(--dry-run --Werror)
[ "${1:-}" = --write ] && mode=(-i)
find platform vision loc hal tests \( -name '*.h' -o -name '*.cpp' -o -name '*.c' \) -print0 |
  xargs -0 -P 2 -n 20 clang-format --style=file "${mode[@]}"
