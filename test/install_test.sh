#!/usr/bin/env bash
# Installs a build into a fresh prefix, moves it, and builds samples/hello against it by find_package and by pkg-config.
set -euo pipefail

build=${1:?usage: install_test.sh BUILD_FOLDER}
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() { echo "install_test: $*" >&2; exit 1; }

# The box must lie on the ground, the ball hang on its joint.
checkHello() {
  local output
  output=$("$1") || fail "$1 exits with $?"
  echo "$output"
  awk '
    function near(value, wanted, by) { return value >= wanted - by && value <= wanted + by }
    { gsub(/[(),]/, " ") }
    $1 == "box" { box = near($3, 0, 0.001) && near($4, 0.5, 0.004) && near($5, 0, 0.001) }
    $1 == "ball" { ball = near(sqrt(($3 - 2) ^ 2 + ($4 - 5) ^ 2 + $5 ^ 2), 2, 0.02) && near($7, 0, 0.001) }
    END { exit !(box && ball) }' <<< "$output" || fail "hello's figures are wrong"
}

cmake --install "$build" --prefix "$scratch/first" > /dev/null
# Nothing may depend on the prefix that was installed to.
mv "$scratch/first" "$scratch/prefix"
prefix=$scratch/prefix
for wanted in include/avbd/avbd.h include/avbd/world.h bin/avbd; do
  [ -e "$prefix/$wanted" ] || fail "not installed: $wanted"
done
"$prefix/bin/avbd" --help > /dev/null || fail "bin/avbd --help exits with $?"

cmake -G Ninja -S "$source/samples" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release > /dev/null
cmake --build "$scratch/build" > /dev/null
checkHello "$scratch/build/hello"

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name avbd.pc)")
export PKG_CONFIG_PATH
read -r -a flags <<< "$(pkg-config --cflags --libs avbd)"
# Warnings in a public header are warnings in every user's program.
g++ -std=c++20 -O2 -Wall -Wextra -Wpedantic -Wshadow -Werror "$source/samples/hello.cpp" -o "$scratch/hello" "${flags[@]}"
checkHello "$scratch/hello"
