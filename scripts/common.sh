# What demo and test share; to be sourced.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# Real logs, where they are at hand.
if [ -z "${GLOCAL_DATASETS:-}" ] && [ -d ../shared/datasets ]; then
  GLOCAL_DATASETS=$(cd ../shared/datasets && pwd)
  export GLOCAL_DATASETS
fi
