#!/usr/bin/env bash
# Checks the objects of back-ends built with wider instructions (*_w4, *_w8, *_w16) in a build folder: every weak symbol
# must carry its width in its name. The linker keeps one of several equal weak symbols, whichever comes first; one built
# for AVX-512 would then run, and fail, on a processor without it. (DW.ref.* are pointers for exceptions, no code.)
set -euo pipefail

build=${1:?usage: check_backends.sh BUILD_FOLDER}
objects=0 problems=0
while IFS= read -r -d '' object; do
  objects=$((objects + 1))
  [[ $object =~ _w([0-9]+)\.cpp\.o$ ]] && width=${BASH_REMATCH[1]}
  while read -r name; do
    printf '%s: weak: %s\n' "${object#"$build"/}" "$name"
    problems=$((problems + 1))
  done < <(nm -C --defined-only "$object" | sed -nE '/ DW\.ref\./d; s/^[0-9a-f]* [WVu] //p' | grep -vE "(^|[^A-Za-z0-9])(\w*_)?w$width::" || true)
done < <(find "$build" \( -name '*_w4.cpp.o' -o -name '*_w8.cpp.o' -o -name '*_w16.cpp.o' \) -print0)

echo "backends: $objects object(s), $problems problem(s)"
[ "$objects" -gt 0 ] && [ "$problems" -eq 0 ]
