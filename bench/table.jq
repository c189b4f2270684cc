# Google Benchmark's results as a table: jq -r --slurpfile before OLD.json -f bench/table.jq NEW.json. With results from before
# (`before` is [] without), their times and the ratio of now to before; times are also compared as multiples of each run's own
# reference loop, so that a slower machine does not look like a slower program.

def unit_ns: {ns: 1, us: 1e3, ms: 1e6, s: 1e9}[.];
def rounded(digits): . as $x | (if $x == 0 then 0 else ($x | fabs | log10 | floor) end) as $magnitude
  | pow(10; digits - 1 - $magnitude) as $scale | ($x * $scale | round) / $scale;
def human: if . >= 1e9 then "\(. / 1e9 | rounded(3)) s" elif . >= 1e6 then "\(. / 1e6 | rounded(3)) ms"
  elif . >= 1e3 then "\(. / 1e3 | rounded(3)) us" else "\(rounded(3)) ns" end;
def counters: with_entries(select((.value | type) == "number")
  | select(.key | IN("family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads", "iterations",
      "real_time", "cpu_time", "cv") | not));
# Times of items come in seconds.
def shown: to_entries | map("\(.key) " + if .key | startswith("per_") then .value * 1e9 | human else .value | rounded(4) | tostring end)
  | join(", ");

# {program/benchmark: {ns, counters, loops}}, medians where there are repetitions.
def results: .benchmarks | map(select(.run_type == "iteration" or .aggregate_name == "median"))
  | group_by(.program) | map((map(select(.run_name == "reference_loop")) | first | if . then .real_time * (.time_unit | unit_ns) else null end) as $loop
      | map(select(.error_occurred | not) | (.real_time * (.time_unit | unit_ns)) as $ns
          | {key: "\(.program)/\(.run_name)", value: {$ns, counters: counters, loops: (if $loop then $ns / $loop else null end)}}))
  | add // [] | from_entries;
def loops: if . then rounded(3) | tostring else "-" end;

results as $now
| ($before | if length == 0 then null else first | results end) as $old
| if $old == null then
    "| benchmark | time | reference loops | |", "|---|---|---|---|",
    ($now | to_entries[] | "| \(.key) | \(.value.ns | human) | \(.value.loops | loops) | \(.value.counters | shown) |")
  else
    "| benchmark | before | now | now / before | the same in reference loops |", "|---|---|---|---|---|",
    ($now | to_entries[] | .key as $key | .value as $new | $old[$key] | select(.)
      | "| \($key) | \(.ns | human) | \($new.ns | human) | \($new.ns / .ns | rounded(3)) | " +
        (if $new.loops and .loops then $new.loops / .loops else null end | loops) + " |")
  end
