#!/bin/sh
# The lane tests, with their golden hashes of bits, in every compiler, level and instruction set at hand.
# -fno-tree-vectorize: g++ 12 turns a*b -+ c into vfmaddsub when it vectorises, whatever -ffp-contract says.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
common="-std=c++20 -Wall -Wextra -Wshadow -Wno-psabi -fno-tree-vectorize"
common="$common -ffp-contract=off -fno-fast-math -fno-math-errno -fno-trapping-math"
failed=0
for compiler in ${COMPILERS:-g++ clang++}; do
  command -v "$compiler" > "$out/which" || continue
  for level in ${LEVELS:--O0 -O1 -O2 -O3}; do
    for isa in "" "-mavx2 -mfma" "-mavx512f -mavx512vl -mavx512dq -mfma -mprefer-vector-width=512"; do
      for test in "$root"/src/lane/*_test.cpp; do
        # shellcheck disable=SC2086
        "$compiler" $common $level $isa -I"$root/include" -I"$root/src" -c "$test" -o "$out/$(basename "$test" .cpp).o"
      done
      if objdump -d "$out"/*.o | grep -q "vfn\?m[as]"; then echo "FAILED: fused arithmetic in the code"; failed=1; fi
      "$compiler" "$out"/*.o -o "$out/test" -lgtest -lgtest_main -lpthread
      if "$out/test" --gtest_brief=1 > "$out/log"; then verdict=ok; else verdict=FAILED; failed=1; cat "$out/log"; fi
      echo "$verdict: $compiler $level $isa"
    done
  done
done
exit $failed
