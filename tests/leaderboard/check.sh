#!/usr/bin/env bash
# Runs a fixed share of a suite anew and compares it with the leaderboard: check.sh GLOCAL SUITE SHARE [CASE…]. The cases are those that need no
# data sets; without GLOCAL_DATASETS only they are tried.
set -euo pipefail
glocal=$1 suite=$2 share=$3
shift 3
options=()
if [ -z "${GLOCAL_DATASETS:-}" ]; then
  [ $# -gt 0 ] || { echo "GLOCAL_DATASETS is not set"; exit 77; }
  for name; do options+=(--case "$name"); done
fi
"$glocal" leaderboard check "$suite" --share "$share" "${options[@]}"
