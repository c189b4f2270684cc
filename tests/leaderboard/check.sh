#!/usr/bin/env bash
# Runs a fixed share of a suite anew and compares it with the leaderboard: check.sh GLOCAL CASES OPTION…. CASES, in one word, are those that need
# no data sets; without GLOCAL_DATASETS only they are tried. The rest is for glocal leaderboard check.
set -euo pipefail
glocal=$1 cases=$2
shift 2
options=()
if [ -z "${GLOCAL_DATASETS:-}" ]; then
  [ -n "$cases" ] || { echo "GLOCAL_DATASETS is not set"; exit 77; }
  for name in $cases; do options+=(--case "$name"); done
fi
"$glocal" leaderboard check "$@" "${options[@]}"
