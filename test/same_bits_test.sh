#!/usr/bin/env bash
# Builds the library once more without optimisation, and with clang where it is installed, and compares the state hashes
# of test/same_bits.cpp in all lane widths with those of a given build. --all adds every level of optimisation.
set -euo pipefail

build=$(cd "${1:?usage: same_bits_test.sh BUILD_FOLDER [--all]}" && pwd)
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# hashes COMPILER LIBRARY: all widths this processor runs; the same lines for each.
hashes() {
  local program=$scratch/program width
  "$1" -std=c++20 -ffp-contract=off -I"$source/include" "$source/test/same_bits.cpp" "$2" -pthread -o "$program"
  for width in 1 4 8 16; do
    if "$program" "$width" > "$scratch/out" 2> "$scratch/refused"; then
      echo "width $width" && cat "$scratch/out"
    else
      grep -q simdWidth "$scratch/refused" || { cat "$scratch/refused" >&2; return 1; }
    fi
  done
}

# compare COMPILER LEVEL
compare() {
  local folder=$scratch/$1$2
  cmake -G Ninja -S "$source" -B "$folder" -DAVBD_APP=OFF -DAVBD_TESTS=OFF -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_COMPILER="$1" -DCMAKE_CXX_FLAGS_DEBUG="$2 -DNDEBUG" > /dev/null
  cmake --build "$folder" --target avbd > /dev/null
  hashes "$1" "$folder/libavbd.a" > "$scratch/now"
  diff "$scratch/wanted" "$scratch/now" || { echo "$1 $2: other bits" >&2; exit 1; }
  echo "$1 $2: the same bits"
}

hashes g++ "$build/libavbd.a" > "$scratch/wanted"
cat "$scratch/wanted"
# All widths must print what width 1 prints; the two solvers must not: then one of them would not run.
runs=$(grep -v '^width' "$scratch/wanted" | sort -u)
[ "$(wc -l <<< "$runs")" -eq 6 ] || { echo "the widths differ" >&2; exit 1; }
[ "$(cut -d ' ' -f 1,3- <<< "$runs" | sort -u | wc -l)" -eq 6 ] || { echo "both solvers give the same" >&2; exit 1; }

compare g++ -O0
if command -v clang++ > /dev/null; then compare clang++ -O1; fi
if [ "${2:-}" = --all ]; then
  for level in -O1 -O2 -O3; do compare g++ $level; done
  if command -v clang++ > /dev/null; then for level in -O0 -O3; do compare clang++ $level; done; fi
fi
