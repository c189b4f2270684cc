#!/usr/bin/env bash
# Makes Debian's package of glocal without plugins, and looks into it.
# Arguments: the build folder, a folder to work in, what the program is run by where that is another machine's.
set -euo pipefail
command -v lintian >/dev/null || { echo "lintian is not installed" >&2; exit 77; }
build=$1 work=$2
shift 2
rm -rf "$work"
mkdir -p "$work"
fail() { echo "FAILED: $1" >&2; exit 1; }

cpack -G DEB --config "$build/CPackConfig.cmake" -D CPACK_COMPONENTS_ALL=core -B "$work" >"$work/said" 2>&1 || { cat "$work/said"; fail "cpack"; }
packages=("$work"/*.deb)
[ ${#packages[@]} -eq 1 ] || fail "there are ${packages[*]}"
package=${packages[0]}
lintian --allow-root --fail-on error,warning "$package" || fail "lintian"

depends=$(dpkg-deb -f "$package" Depends)
for library in libc6 libstdc++6 libtbb12 libyaml-cpp0.7; do
  [[ $depends == *"$library "* ]] || fail "it does not depend on $library: $depends"
done
! grep -Eqi 'mrpt|octomap|open3d|pcl|dds|python' <<<"$depends" || fail "it depends on what plugins need: $depends"

dpkg-deb -x "$package" "$work/root"
"$@" "$work/root/usr/bin/glocal" list matcher | grep -q indexed_ransam || fail "the program does not run"
