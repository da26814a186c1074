#!/usr/bin/env bash
# Checks that all C++ sources are formatted as .clang-format says; with --fix, formats them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tool=$(command -v clang-format-14 || command -v clang-format) || { echo "no clang-format" >&2; exit 2; }
how=(--dry-run -Werror)
if [ "${1:-}" = --fix ]; then how=(-i); fi

find include src io app viewer scenes samples bench test \
  \( -name node_modules -o -name dist \) -prune -o \( -name '*.h' -o -name '*.cpp' \) -print0 |
  sort -z | xargs -0 -r -n 20 -P 2 "$tool" "${how[@]}"
