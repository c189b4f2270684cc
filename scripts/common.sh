# What scripts share; to be sourced.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# Real logs, where they are at hand.
if [ -z "${GLOCAL_DATASETS:-}" ] && [ -d ../shared/datasets ]; then
  GLOCAL_DATASETS=$(cd ../shared/datasets && pwd)
  export GLOCAL_DATASETS
fi

# What --help prints: how the script begins.
usage() { sed -n '2,/^[^#]/{/^#/s/^# \{0,1\}//p}' "scripts/${0##*/}"; }
refuse() { echo "scripts/${0##*/}: $1" >&2; exit 2; }

# cmake_build PRESET [--target TARGET…]
cmake_build() {
  cmake --preset "$1" >/dev/null
  cmake --build --preset "$@"
}

# From here on temporary files are in memory, where that has room, until the script ends: results are synced to their disk trial by trial.
keep_temporary_files_in_memory() {
  local memory=/dev/shm
  # Tests build programs and run them there.
  if ! [ "$(df --output=avail $memory 2>/dev/null | tail -n 1)" -gt 4000000 ] 2>/dev/null || grep -q " $memory .*noexec" /proc/mounts; then
    memory=${TMPDIR:-/tmp}
  fi
  TMPDIR=$(mktemp -d "$memory/glocal.XXXXXX")
  chmod 711 "$TMPDIR" # daemons of other users pass through it
  export TMPDIR
  trap 'rm -rf "$TMPDIR"' EXIT
}
