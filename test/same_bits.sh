#!/usr/bin/env bash
# Compares the state hashes that test/same_bits.cpp prints with those kept in test/golden_hashes.txt.
#   same_bits.sh check PROGRAM           in all lane widths, and with several workers
#   same_bits.sh matrix [CELL|TRIAL...]  builds the library and the program anew for each cell, and checks it; with
#                                        trials named, those alone
#   same_bits.sh golden PROGRAM REASON   keeps what PROGRAM prints, and says in the changelog why
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly kGolden=test/golden_hashes.txt
readonly kCells=(g++-O0 g++-O1 g++-O2 g++-O3 clang++-O0 clang++-O1 clang++-O2 clang++-O3 aarch64 wasm)
readonly kWidths=(1 4 8 16)
readonly kWorkers=(1 2 5 8)
trials=()  # none: all
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp "$kGolden" "$scratch/golden"
different=0

die() { printf 'same_bits: %s\n' "$*" >&2; exit 2; }

# one WORD PROGRAM... : a word of the table's row. Status 3 of the program: this processor has no such width.
one() {
  local word=$1 status=0
  shift
  "$@" > "$scratch/out" 2> "$scratch/err" || status=$?
  if [ $status -eq 3 ]; then
    printf ' %s:-' "$word"
  elif [ $status -ne 0 ]; then
    printf ' %s:FAILED' "$word"
    cat "$scratch/err" >&2
    different=1
  elif diff "$scratch/golden" "$scratch/out" > "$scratch/diff"; then
    printf ' %s:same' "$word"
  else
    printf ' %s:OTHER' "$word"
    head -n 4 "$scratch/diff" >&2
    different=1
  fi
}

# row NAME WORKERS PROGRAM...
row() {
  local name=$1 workers=$2 n
  shift 2
  printf '%-11s widths' "$name"
  for n in "${kWidths[@]}"; do one "$n" "$@" --width "$n" "${trials[@]}"; done
  if [ "$workers" = workers ]; then
    printf '   workers'
    for n in "${kWorkers[@]}"; do one "$n" "$@" --workers "$n" "${trials[@]}"; done
  fi
  printf '\n'
}

# Debian's clang-14 alone brings no clang++.
compiler() {
  if [ "$1" = clang++ ] && ! command -v clang++ > /dev/null; then echo clang++-14; else echo "$1"; fi
}

# build NAME CMAKE-ARGUMENTS... into build/bits_NAME
build() {
  local folder=build/bits_$1
  mkdir -p "$folder"
  shift
  {
    cmake -G Ninja -S . -B "$folder" -DAVBD_APP=OFF -DAVBD_TESTS=OFF -DAVBD_BITS=ON -DCMAKE_BUILD_TYPE=Debug "$@" &&
      cmake --build "$folder" --target same_bits
  } > "$folder/log" 2>&1 || { tail -n 40 "$folder/log" >&2; die "$folder does not build"; }
}

cell() {
  local level
  case $1 in
    g++-O? | clang++-O?)
      level=${1##*-}
      build "$1" -DCMAKE_CXX_COMPILER="$(compiler "${1%-O?}")" -DCMAKE_CXX_FLAGS_DEBUG="-$level -DNDEBUG"
      row "$1" workers "build/bits_$1/bin/same_bits"
      ;;
    aarch64)
      build aarch64 -DCMAKE_TOOLCHAIN_FILE=cmake/aarch64.cmake -DCMAKE_CXX_FLAGS_DEBUG="-O2 -DNDEBUG"
      row aarch64 workers qemu-aarch64 -L /usr/aarch64-linux-gnu build/bits_aarch64/bin/same_bits
      ;;
    wasm)  # one thread: browsers want special headers before they give more
      export NODE_PATH=/usr/share/nodejs
      build wasm -DCMAKE_TOOLCHAIN_FILE=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake \
        -DCMAKE_CXX_FLAGS="-msimd128 -fexceptions" -DCMAKE_CXX_FLAGS_DEBUG="-O2 -DNDEBUG" \
        -DCMAKE_EXE_LINKER_FLAGS="-sALLOW_MEMORY_GROWTH=1"
      row wasm alone node --no-experimental-fetch build/bits_wasm/bin/same_bits.js
      ;;
    *) die "no cell '$1'; there are: ${kCells[*]}" ;;
  esac
}

command=${1:-}
[ $# -gt 0 ] && shift
case $command in
  check) row "$(basename "${1:?check which program?}")" workers "$1" ;;
  matrix)
    cells=()
    for name in "$@"; do
      if grep -q "^$name " "$kGolden"; then trials+=("$name"); else cells+=("$name"); fi
    done
    [ ${#cells[@]} -gt 0 ] || cells=("${kCells[@]}")
    if [ ${#trials[@]} -gt 0 ]; then
      for name in "${trials[@]}"; do printf '%s \n' "$name"; done > "$scratch/names"
      sed 's/^/^/' "$scratch/names" | grep -f - "$kGolden" > "$scratch/golden"
    fi
    printf '%s of %s runs\n' "$(wc -l < "$scratch/golden")" "$(wc -l < "$kGolden")"
    for name in "${cells[@]}"; do cell "$name"; done
    ;;
  golden)
    [ $# -eq 2 ] && [ -n "$2" ] || die "golden needs a program and a reason"
    "$1" > "$scratch/golden"
    if cmp -s "$scratch/golden" "$kGolden"; then echo "the hashes are as they were" && exit; fi
    cp "$scratch/golden" "$kGolden"
    printf -- '- Recorded hashes %s: %s\n' "$(sha256sum "$kGolden" | cut -c 1-8)" "$2" >> CHANGELOG.md
    tail -n 1 CHANGELOG.md
    ;;
  *) sed -n 's/^#  *same_bits.sh/same_bits.sh/p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac
exit $different
