#!/usr/bin/env bash
# Installs glocal into an empty folder, and makes, builds and runs plugins with nothing but that.
# Arguments: the build folder, a folder to work in.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$(cd "$1" && pwd) work=$2
rm -rf "$work"
mkdir -p "$work/outside"
# As for glocal itself; make, CMake's own choice, need not be there.
export CMAKE_GENERATOR=Ninja CXXFLAGS=--param=ggc-min-heapsize=500000
fail() { echo "FAILED: $1" >&2; exit 1; }
prefix=$work/prefix

cmake --install "$build" --prefix "$prefix" >/dev/null
[ "$("$prefix/bin/glocal" --version | cut -d ' ' -f 1)" = glocal ] || fail "the installed program does not run"
for library in mrpt pcl octomap Open3D vtk Qt ddsc; do
  ! ldd "$prefix/bin/glocal" "$prefix"/lib*/libglocal.so | grep -qi "lib$library" || fail "the framework needs $library"
done

for file in man/man1/glocal.1 man/man1/glocal-map-build.1 bash-completion/completions/glocal zsh/vendor-completions/_glocal fish/vendor_completions.d/glocal.fish; do
  [ -s "$prefix/share/$file" ] || fail "$file is not installed"
done

# The plugins of this tree, where they are built, export what every plugin does.
for plugin in "$prefix"/lib*/glocal/*.so; do
  [ -e "$plugin" ] || continue
  [ "$(nm -D --defined-only "$plugin" | cut -d ' ' -f 2-)" = "T glocal_plugin" ] || fail "$plugin exports more than its entry"
  "$prefix/bin/glocal" list --plugin "$plugin" >/dev/null || fail "$plugin cannot be loaded"
done

# Each header compiles alone, and brings in no other library than Eigen. Most of the time is Eigen's: who includes its geometry finds it compiled.
mkdir "$work/headers"
for header in "$prefix"/include/glocal/*.hpp; do
  name=$(basename "$header")
  echo "#include <glocal/$name>" >"$work/headers/${name%.hpp}.cpp"
done
as_users="-std=c++20 -Wall -Wextra -Werror -I $prefix/include -isystem /usr/include/eigen3"
geometry=$work/headers/geometry.h
echo '#include <Eigen/Geometry>' >"$geometry"
c++ $CXXFLAGS $as_users -x c++-header "$geometry" -o "$geometry.gch"
check_header() {
  local compiled=()
  c++ $as_users -M -MF "$1.d" "$1"
  if grep -q eigen3/Eigen/Geometry "$1.d"; then compiled=(-Winvalid-pch -include "$geometry"); fi
  c++ $CXXFLAGS $as_users "${compiled[@]}" -fsyntax-only "$1"
}
export -f check_header
export prefix as_users geometry
find "$work/headers" -name '*.cpp' -print0 | xargs -0 -n 1 -P "$(nproc)" bash -c 'set -e; check_header "$0"' || fail "a header does not compile alone"
for made_of in "$work"/headers/*.d; do
  brought=$(tr ' ' '\n' <"$made_of" | grep '^/usr' | grep -Ev '/c\+\+/|/gcc/|/x86_64-linux-gnu/|^/usr/include/[a-z0-9_-]*\.h$|^/usr/include/(linux|asm-generic|eigen3)/' || true)
  [ -z "$brought" ] || fail "$(basename "$made_of" .cpp.d).hpp brings in $brought"
done

# A plugin of every kind, outside of the tree: as new-plugin writes them, they build, pass their test and run. They only have to compile quickly,
# so what all of them include first is compiled once, with the options of glocal_add_plugin.
compiled=$prefix/include/glocal/plugin.hpp.gch
echo '#include <glocal/plugin.hpp>' >"$work/first.hpp"
c++ $CXXFLAGS -Og -fPIC -fvisibility=hidden -fvisibility-inlines-hidden -ffp-contract=off -std=gnu++20 \
  -isystem "$prefix/include" -isystem /usr/include/eigen3 -x c++-header "$work/first.hpp" -o "$compiled"
kinds=$("$prefix/bin/glocal" list | grep -E '^[a-z_]+$')
[ "$(wc -w <<<"$kinds")" -eq 12 ] || fail "the kinds of strategies are: $kinds"
try_kind() {
  local kind=$1 folder=$work/outside/$1
  "$prefix/bin/glocal" new-plugin "$kind" "my_$kind" -o "$folder" >/dev/null
  cmake -S "$folder" -B "$folder/build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_FLAGS="$CXXFLAGS -Winvalid-pch -Werror" -DCMAKE_CXX_FLAGS_RELEASE=-Og >/dev/null
  cmake --build "$folder/build" >/dev/null
  ctest --test-dir "$folder/build" >/dev/null
  grep -q "my_$kind 0.1.0" "$folder/build/results/provenance.json"
  [ "$(nm -D --defined-only "$folder/build/my_$kind.so" | cut -d ' ' -f 2-)" = "T glocal_plugin" ]
}
export -f try_kind
export work
xargs -n 1 -P "$(nproc)" bash -c 'set -e; try_kind "$0"' <<<"$kinds" || fail "a new plugin"
rm "$compiled"

# What a page of docs/ says, as it stands; only the build folder may have another name.
run_page() {
  local page=$1 reader=$work/$1
  mkdir "$reader"
  sed -n '/^```bash$/,/^```$/{/^```/!p}' "$root/docs/$page.md" | sed "s#build/release#$build#" >"$reader/commands"
  [ "$(wc -l <"$reader/commands")" -gt 5 ] || fail "the commands of docs/$page.md"
  (cd "$root" && PREFIX=$reader/prefix WORK=$reader bash -euo pipefail "$reader/commands") >"$reader/said" 2>&1 ||
    { cat "$reader/said"; fail "docs/$page.md"; }
}
run_page writing-a-strategy
said=$work/writing-a-strategy/said
# Two lines of JSON, and what glocal compare says of the runs.
grep '^{"variant"' "$said" | jq -s -e '.[0].variant == "mine" and .[1].variant == "paper" and .[0].of == .[1].of and .[1].right > 0' >/dev/null ||
  fail "the comparison of docs/writing-a-strategy.md: $(cat "$said")"
grep -q 'against' "$said" || fail "glocal compare in docs/writing-a-strategy.md: $(cat "$said")"
run_page embedding
# The embedding program says what the program says.
"$prefix/bin/glocal" run "$work/embedding/drive/experiment.yaml" --set 'trials={whole: true}' --quiet --out "$work/whole"
diff <(jq -r '"\(.step) \(.verdict)"' "$work/whole/steps.jsonl") <(awk '{ sub(":", "", $2); print $1, $2 }' "$work/embedding/verdicts") ||
  fail "the embedding program's verdicts"

# try_run_experiment HOW PROGRAM: examples/run_experiment, built in some way, runs.
try_run_experiment() {
  local how=$1 run_experiment=$2
  "$run_experiment" "$work/embedding/drive/experiment.yaml" "$work/run_by_$how" >"$work/said_by_$how" 2>/dev/null
  jq -r '.trials | "experiment: \(.right) right, \(.wrong) wrong, \(.undecided) undecided"' "$work/run_by_$how/summary.json" |
    cmp - "$work/said_by_$how" || fail "examples/run_experiment by $how"
  "$prefix/bin/glocal" summarize "$work/run_by_$how" >/dev/null || fail "what examples/run_experiment leaves"
}
cmake -S "$root/examples/run_experiment" -B "$work/run_experiment" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$work/run_experiment" >/dev/null
try_run_experiment cmake "$work/run_experiment/run_experiment"
# The same numbers as the program's own run.
"$prefix/bin/glocal" run "$work/embedding/drive/experiment.yaml" --quiet --out "$work/run_by_program"
diff "$work/run_by_program/trials.jsonl" "$work/run_by_cmake/trials.jsonl" || fail "examples/run_experiment against glocal run"

# The same without CMake. A plugin is not linked with what it does not use.
if command -v pkg-config >/dev/null; then
  export PKG_CONFIG_PATH
  PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name glocal.pc)")
  c++ $CXXFLAGS -shared -fPIC "$work/outside/matcher/my_matcher.cpp" $(pkg-config --cflags --libs glocal) -o "$work/by_hand.so"
  "$prefix/bin/glocal" list matcher --plugin "$work/by_hand.so" | grep -q my_matcher || fail "pkg-config"
  ! readelf -d "$work/by_hand.so" | grep -Eq 'glocal_(builtin|evaluation)' || fail "a plugin is linked with all of glocal"
  for example in embed run_experiment; do
    c++ $CXXFLAGS "$root/examples/$example/$example.cpp" $(pkg-config --cflags --libs glocal) \
      "-Wl,-rpath,$(pkg-config --variable=libdir glocal)" -o "$work/${example}_by_hand"
  done
  awk '$1 == "ROBOTLASER1" { n = $9; printf "%s %s %s", $(n + 14), $(n + 15), $(n + 16); for (i = 10; i < n + 10; ++i) printf " %s", $i; print "" }' \
    "$work/embedding/drive/drive.log" | "$work/embed_by_hand" "$work/embedding/drive/experiment.yaml" >"$work/verdicts_by_hand"
  cmp "$work/embedding/verdicts" "$work/verdicts_by_hand" || fail "examples/embed by pkg-config"
  try_run_experiment pkg_config "$work/run_experiment_by_hand"
fi
