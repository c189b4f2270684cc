#!/usr/bin/env bash
# Follows docs/tutorial.md word by word, and checks what comes out against the files it came from.
# Arguments: the build folder, a folder to work in.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$(cd "$1" && pwd) work=$2
rm -rf "$work"
mkdir -p "$work"
work=$(cd "$work" && pwd)
lab=$work/lab
fail() { echo "FAILED: $1" >&2; exit 1; }

# Only the build folder may have another name, and where there is no cluster the section on it is left out.
. "$root/tests/cluster/slurm.sh"
leave_out=
why=$(why_no_slurm)
command -v parallel >/dev/null || why='there is no GNU parallel (scripts/setup --cluster)'
if [ -z "$why" ]; then
  trap stop_slurm EXIT
  start_slurm
else
  echo "without the section on clusters: $why"
  leave_out='/^## .* On a cluster$/,/^## Where/d'
fi
sed "$leave_out" "$root/docs/tutorial.md" |
  sed -n '/^```bash$/,/^```$/{/^```/!p}' | sed "s#\$PWD/build/release#$build#" >"$work/commands"
[ "$(grep -c '^glocal ' "$work/commands")" -gt 10 ] || fail "the page has hardly any commands"
grep -q "$build" "$work/commands" || fail "the page does not name the build folder"
(cd "$root" && WORK=$lab bash -euo pipefail "$work/commands") >"$work/said" 2>&1 || { cat "$work/said"; fail "docs/tutorial.md"; }

# The summary counts what the trials say.
count() { jq -s "map(select(.outcome == \"$1\")) | length" "$lab/results/first_try/trials.jsonl"; }
right=$(count right) wrong=$(count wrong) undecided=$(count undecided)
[ "$right" -ge 10 ] && [ "$wrong" -eq 0 ] || fail "first try: $right right, $wrong wrong"
jq -e ".trials == {count: $((right + wrong + undecided)), right: $right, wrong: $wrong, undecided: $undecided}" \
  "$lab/results/first_try/summary.json" >/dev/null || fail "the summary counts other outcomes than the trials"

# Declared poses are where the log's reference says the robot was: each scan of this log is an observation.
grep ^TRUEPOS "$lab/first/drive.log" | awk '{ print $2, $3 }' >"$work/reference"
jq -r 'select(.pose) | [.start.sample + .steps, .pose.x, .pose.y] | @tsv' "$lab/results/first_try/trials.jsonl" |
  while read -r line x y; do
    sed -n "${line}p" "$work/reference" | awk -v x="$x" -v y="$y" '{ exit !(sqrt((x - $1) ^ 2 + (y - $2) ^ 2) < 0.5) }' ||
      fail "a declared pose, $x $y, is not at line $line of the reference"
  done

# What the page prints and tells.
grep -q '6289 map points, 128 observations, 16 trials' "$work/said" || fail "what glocal check says is not what the page shows"
grep -q 'lost        not on the map: of the local map' "$work/said" || fail "glocal explain says something else than the page"
[ "$(find "$lab/results/variants" -name summary.json | wc -l)" -eq 5 ] || fail "there are not five variants"
grep -q '4 methods compared with default, by ' "$work/said" || fail "glocal compare does not name the baseline"
grep -qE 'indexed (is|against) .*default' "$work/said" || fail "glocal compare does not name the variant"
for variant in default indexed; do
  jq -e '.trials.right > 9 and .trials.wrong == 0' "$lab/results/second_drive/$variant/summary.json" >/dev/null || fail "$variant on the second drive"
done
for page in first_try second_drive; do
  grep -qi '</html>' "$lab/$page.html" || fail "$page.html is no page"
done
# On the whole drive the tuned experiment is localized most of the time, and right; the unknown place is the room that is not on the map.
jq -e -s 'map(select(.verdict == "localized"))
  | length > 50 and all((.estimate.x - .reference.x | . * .) + (.estimate.y - .reference.y | . * .) < 0.25)' "$lab/results/tuned/steps.jsonl" >/dev/null ||
  fail "the tuned experiment is seldom localized, or wrong"
jq -e -s 'map(select(.verdict == "unknown_place")) | length > 5 and all(.reference.x > 16.5)' "$lab/results/tuned/steps.jsonl" >/dev/null ||
  fail "the tuned experiment does not notice the room that is not on the map"

# Shards leave what one machine leaves; times are left out as everywhere.
if [ -d "$lab/results/cluster" ]; then
  . "$root/scripts/compare_results.sh"
  for ((i = 0; i < 100; ++i)); do [ -n "$(squeue --noheader)" ] || break; sleep 0.2; done
  without_times "$lab/results/variants" "$work/variants"
  for shards in cluster parallel; do
    without_times "$lab/results/$shards" "$work/$shards"
    diff -r -x provenance.json "$work/variants" "$work/$shards" >"$work/difference" || fail "$shards: $(head -c 1000 "$work/difference")"
  done
fi
