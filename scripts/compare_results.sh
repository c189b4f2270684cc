# What tests share that compare results byte by byte, but for times; to be sourced.

# A results folder as text that is the same for all runs of an experiment.
without_times() { # from, to: absolute
  rm -rf "$2"
  cp -r "$1" "$2"
  # How the work was divided is no result.
  rm -rf "$2/.shards"
  (
    cd "$2"
    find . -name summary.json -o -name '*.jsonl' | sort >"$2.files"
    # How many trials ran at once, since when and by which command is of the times, too.
    find . -name provenance.json -exec sed -i -E '/^  "(jobs|began|command)": /d' {} +
    xargs jq -c '[input_filename, del(.stage_ms, .stage_cpu_ms, .step_ms, .answer_ms, .peak_rss_mb, .others_load, .map.build_ms, .map.index_ms, .map.index.build_ms)]' <"$2.files" >"$2.lines"
    xargs rm <"$2.files"
    mv "$2.lines" lines
    rm "$2.files"
  )
}
