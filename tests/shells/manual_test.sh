#!/usr/bin/env bash
# Every command has a manual page that roff finds nothing wrong with, and that tells all that --help does.
# Arguments: the program, the folder of the pages.
set -euo pipefail
program=$1 pages=$2
command -v groff >/dev/null || exit 77
fail() { echo "FAILED: $1" >&2; exit 1; }

# commands_of WORD…: the commands below one.
commands_of() { "$program" "$@" --help | sed -n '/^Subcommands:$/,/^$/s/^  \([a-z-]\{1,\}\) .*/\1/p'; }

# check_page WORD…: of one command, and of those below it.
check_page() {
  local name page text option below
  name=$(IFS=-; echo "glocal${*:+-$*}")
  page=$pages/$name.1
  [ -f "$page" ] || fail "$name has no page"
  said=$(groff -man -ww -z "$page" 2>&1)
  [ -z "$said" ] || fail "$page: $said"
  text=$(groff -man -Tutf8 -P -cbou -rLL=200n "$page")
  while read -r option; do
    grep -q -- "$option" <<<"$text" || fail "$page does not tell of $option"
  done < <("$program" "$@" --help | sed -n 's/^  \(-[a-z],\)\{0,1\}\(--[a-z-]\{1,\}\).*/\2/p')
  for below in $(commands_of "$@"); do
    grep -q -- "$name-$below(1)" <<<"$text" || fail "$page does not tell of $below"
    check_page "$@" "$below"
  done
}
[ "$(commands_of | wc -l)" -gt 20 ] || fail "the commands of --help are not found"
check_page
