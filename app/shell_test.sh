#!/usr/bin/env bash
# Runs the built program as a user does: streams, exit statuses, files.
set -euo pipefail

avbd=$(realpath "${1:?usage: shell_test.sh AVBD [SCENE.xml]}")
scene=chain
[ ! -f "${2:-}" ] || scene=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

die() { printf 'shell_test: %s\n' "$*" >&2; exit 1; }

# expect STATUS ARGUMENTS...: leaves out and err.
expect() {
  local wanted=$1 status=0
  shift
  "$avbd" "$@" > out 2> err || status=$?
  [ "$status" -eq "$wanted" ] || die "avbd $*: status $status instead of $wanted: $(cat err)"
}

expect 0 --version
grep -qE '^avbd [0-9]+\.[0-9]+\.[0-9]+$' out || die "version: $(cat out)"

expect 0 run "$scene" --time 0.5 --html page.html --poses poses.csv --fps 10
[ ! -s err ] || die "no terminal, yet something on standard error: $(cat err)"
[ "$(wc -l < out)" -lt 30 ] || die "the report has $(wc -l < out) lines"
grep -q '^hash  *[0-9a-f]\{16\}$' out || die "no hash in: $(cat out)"
grep -q '</html>' page.html || die "the page is not complete"
[ "$(head -1 poses.csv)" = time,body,x,y,z,qw,qx,qy,qz ] || die "head of the CSV: $(head -1 poses.csv)"
[ "$(cut -d, -f1 poses.csv | tail -n +2 | sort -un | wc -l)" -eq 6 ] || die "times of the CSV"
hash=$(sed -n 's/^hash *//p' out)

expect 0 run "$scene" --time 0.5 --json --simd 1
[ "$(wc -l < out)" -eq 1 ] || die "--json prints more than one line"
grep -q "\"hash\":\"$hash\"" out || die "another hash than $hash at one lane: $(cat out)"

expect 2 run no_such_scene --html none.html
[ ! -s out ] && [ "$(wc -l < err)" -eq 1 ] || die "not one message: $(cat out err)"
expect 2 run "$scene" --dt nan --html none.html --poses none.csv
expect 2 verify no_such_line
[ ! -e none.html ] && [ ! -e none.csv ] || die "refused, yet files are left"
if "$avbd" scenes > /dev/full 2> err; then die "a full standard output went unnoticed"; fi

# A signal ends the run without leaving a file.
"$avbd" run "$scene" --time 100000 --poses stopped.csv > out 2> err &
run=$!
for _ in $(seq 200); do
  compgen -G 'stopped.csv.partial*' > /dev/null && break
  sleep 0.05
done
kill -TERM "$run"
status=0
wait "$run" || status=$?
[ "$status" -eq 130 ] || die "stopped with status $status: $(cat err)"
left=$(ls)
[ "$left" = "$(printf '%s\n' err out page.html poses.csv)" ] || die "files left: $left"
