#!/usr/bin/env bash
# one_definition.sh OBJECT…: fails if a function is defined in two objects, of which one at least is no inline one: the linker then takes either.
set -euo pipefail
nm --defined-only --print-file-name "$@" | awk '
  $2 ~ /^[TW]$/ {  # OBJECT:ADDRESS KIND SYMBOL
    object = $1
    sub(/:[0-9a-f]+$/, "", object)
    objects[$3] = objects[$3] " " object
    n[$3]++
    strong[$3] += $2 == "T"
  }
  END {
    for (symbol in n) {
      checked++
      if (n[symbol] > 1 && strong[symbol] > 0) { print symbol ":" objects[symbol]; faults++ }
    }
    print checked + 0 " functions, " faults + 0 " of them in two objects"
    exit faults > 0 || checked < 1000
  }' | c++filt
