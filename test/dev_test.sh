#!/usr/bin/env bash
# What ./dev says when it is asked wrongly or for help; none of this builds or installs anything.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() { echo "dev_test: $*" >&2; exit 1; }

for command in run test build bench verify same-bits golden tsan fuzz format; do
  ./dev help | grep -q "^  $command" || fail "help does not name $command"
done

if ./dev nonsense 2> /dev/null; then fail "an unknown command exits with 0"; fi
message=$(./dev nonsense 2>&1 > /dev/null) || true
grep -q "no command 'nonsense'" <<< "$message" || fail "an unknown command is not named"

message=$(./dev build nonsense 2>&1 > /dev/null) && fail "an unknown preset exits with 0"
grep -q "no preset 'nonsense'" <<< "$message" || fail "an unknown preset is not named"

for preset in $(sed -n 's/^readonly kPresets="\(.*\)"$/\1/p' dev); do
  grep -q "\"name\": \"$preset\"" CMakePresets.json || fail "no preset $preset in CMakePresets.json"
done
