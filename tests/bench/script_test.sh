#!/usr/bin/env bash
# scripts/bench: what it writes, the table, the comparison, and what it says to bad arguments.
# Arguments: the build folder, a folder to work in.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
fail() { echo "FAILED: $1" >&2; exit 1; }

# Two programs' results: the machine is half as fast as before, and one benchmark has become faster all the same.
results() { # reference loop (ms), fast (us), slow (us)
  jq -n --argjson loop "$1" --argjson fast "$2" --argjson slow "$3" '
    def run($name; $time; $unit): {program: "p", run_name: $name, run_type: "iteration", real_time: $time, time_unit: $unit};
    {benchmarks: [run("reference_loop"; $loop; "ms"), run("fast"; $fast; "us") + {points: 7, per_point: 2e-9}, run("slow"; $slow; "us")]}'
}
results 10 100 100 >"$work/old.json"
results 20 50 200 >"$work/new.json"
table=$(jq -r --slurpfile before "$work/old.json" -f bench/table.jq "$work/new.json")
grep -qF '| p/fast | 100 us | 50 us | 0.5 | 0.25 |' <<<"$table" || fail "what became faster: $table"
grep -qF '| p/slow | 100 us | 200 us | 2 | 1 |' <<<"$table" || fail "what only the machine slowed down: $table"
echo >"$work/none.json"
table=$(jq -r --slurpfile before "$work/none.json" -f bench/table.jq "$work/new.json")
grep -qF '| p/fast | 50 us | 0.0025 | points 7, per_point 2 ns |' <<<"$table" || fail "the plain table: $table"

# The real thing.
scripts/bench --build "$build" --results "$work/results" --min-time 0.001 --filter plain_draws sampling >"$work/table.md"
grep -q '^| sampling/reference_loop | .* | 1 |' "$work/table.md" || fail "no reference loop: $(cat "$work/table.md")"
grep -q '^| sampling/plain_draws | .* per_triple ' "$work/table.md" || fail "no draws: $(cat "$work/table.md")"
jq -e '.context.num_cpus > 0 and (.benchmarks | length) == 2' "$work/results/bench_sampling.json" >/dev/null || fail "results"
cp "$work/results/all.json" "$work/before.json"
scripts/bench --build "$build" --results "$work/results" --min-time 0.001 --filter plain_draws --against "$work/before.json" sampling |
  grep -q '^| sampling/plain_draws | .* | .* | [0-9.]* | [0-9.]* |$' || fail "no comparison"

# Bad arguments: one line that says what is wrong, exit code 2.
refused() { # what the message must contain, arguments…
  local words=$1 code=0 said
  shift
  said=$(scripts/bench --build "$build" --results "$work/refused" "$@" 2>&1 >/dev/null) || code=$?
  [ "$code" -eq 2 ] && grep -qF -- "$words" <<<"$said" || fail "scripts/bench $*: exit $code, '$said'"
}
refused 'unknown option --agains' --agains x
refused '--against needs a value' --against
refused 'is not a file of results' --against "$work/table.md"
refused 'there is no' no_such_benchmark
