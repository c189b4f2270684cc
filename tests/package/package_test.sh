#!/usr/bin/env bash
# Installs glocal into an empty folder, builds a plugin with nothing but that, and runs an experiment with it.
# Arguments: the build folder, a folder to work in.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$1 work=$2
rm -rf "$work"
mkdir -p "$work/outside"
fail() { echo "FAILED: $1" >&2; exit 1; }
prefix=$work/prefix

cmake --install "$build" --prefix "$prefix" >/dev/null
[ "$("$prefix/bin/glocal" --version | cut -d ' ' -f 1)" = glocal ] || fail "the installed program does not run"
for library in pcl octomap vtk Qt; do
  ! ldd "$prefix/bin/glocal" "$prefix"/lib*/libglocal.so | grep -qi "lib$library" || fail "the framework needs $library"
done

# Each header compiles alone, and brings in no other library.
mkdir "$work/headers"
for header in "$prefix"/include/glocal/*.hpp; do
  name=$(basename "$header")
  echo "#include <glocal/$name>" >"$work/headers/${name%.hpp}.cpp"
done
find "$work/headers" -name '*.cpp' -print0 |
  xargs -0 -n 1 -P "$(nproc)" c++ -std=c++20 -fsyntax-only -Wall -Wextra -Werror -I "$prefix/include" || fail "a header does not compile alone"
for source in "$work"/headers/*.cpp; do
  brought=$(c++ -std=c++20 -M -I "$prefix/include" "$source" | tr ' ' '\n' | grep '^/usr' | grep -Ev '/c\+\+/|/gcc/|/x86_64-linux-gnu/|^/usr/include/[a-z0-9_-]*\.h$|^/usr/include/(linux|asm-generic)/' || true)
  [ -z "$brought" ] || fail "$(basename "$source" .cpp).hpp brings in $brought"
done

# A plugin outside of the tree.
cp "$here/../plugins/modules/every_kind.cpp" "$work/outside/mine.cpp"
cat >"$work/outside/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(mine LANGUAGES CXX)
find_package(glocal REQUIRED)
glocal_add_plugin(mine mine.cpp)
CMAKE
cat >"$work/outside/experiment.yaml" <<'YAML'
schema: 1
name: outside
plugins: [build/mine.so]
map: room
observations: standing
trials: {whole: true}
localizer: {local_mapper: last_scan, matcher: oracle, clusterer: each_alone, rater: all_alike, threshold_policy: fixed, verdict_rule: at_once}
YAML
cmake -S "$work/outside" -B "$work/outside/build" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$work/outside/build" >/dev/null
"$prefix/bin/glocal" run "$work/outside/experiment.yaml" --out "$work/results" | grep -q '1 right' || fail "the experiment"

# The same without CMake.
if command -v pkg-config >/dev/null; then
  export PKG_CONFIG_PATH
  PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name glocal.pc)")
  c++ -shared -fPIC "$work/outside/mine.cpp" $(pkg-config --cflags --libs glocal) -o "$work/by_hand.so"
  "$prefix/bin/glocal" list matcher --plugin "$work/by_hand.so" | grep -q oracle || fail "pkg-config"
fi
