#!/bin/sh
# Bundles src/ and three.js into dist/viewer.js. With --check: fails if the committed bundle is not what src/ gives.
set -eu
cd "$(dirname "$0")"
if [ ! -x node_modules/.bin/esbuild ]; then npm ci --no-audit --no-fund; fi
out=dist/viewer.js
if [ "${1:-}" = --check ]; then
  out=$(mktemp --suffix=.js)
  trap 'rm -f "$out"' EXIT
fi
node_modules/.bin/esbuild src/main.js --bundle --minify --format=iife --target=es2021 --charset=ascii \
  --loader:.css=text --legal-comments=eof --log-level=warning --outfile="$out"
# Either would end or confuse the script element that the page puts this text into.
if grep -qiE '</script|<!--' "$out"; then
  echo "build.sh: $out holds text that ends a script element" >&2
  exit 1
fi
if [ "${1:-}" = --check ] && ! cmp -s "$out" dist/viewer.js; then
  echo "build.sh: dist/viewer.js is out of date; run viewer/build.sh" >&2
  exit 1
fi
