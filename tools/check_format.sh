#!/usr/bin/env bash
# Checks that all C++ sources are formatted as .clang-format says; with --fix, formats them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tool=$(command -v clang-format-14 || command -v clang-format) || { echo "no clang-format" >&2; exit 2; }
sources() {
  find include src io app viewer scenes samples bench test \
    \( -name node_modules -o -name dist \) -prune -o \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z
}

if [ "${1:-}" = --fix ]; then
  sources | xargs -0 -r "$tool" -i
  exit
fi
if said=$(sources | xargs -0 -r -n 20 -P 2 "$tool" --dry-run -Werror 2>&1); then exit; fi
# Names of the files are enough where there are any: ./dev format says the rest better.
names=$(sed -nE 's/^([^: ]+):[0-9]+:[0-9]+: .*/\1/p' <<< "$said" | sort -u)
printf 'not formatted, see ./dev format:\n%s\n' "${names:-$said}"
exit 1
