#!/bin/sh
# Measures speed beside other programs; prints a line for each bound
# (name value bound ok|short|unsure) and writes docs/performance.md. Exits 1 if any is short.
# usage: tests/benchmark/run.sh [--quick]    smaller sizes and fewer robots, no report in docs/
# HOMING_BUILD names a build with homing-server, homing-bench and homing_benchmark (default: build/dev, built if
# need be).
set -eu
cd "$(dirname "$0")/../.."
root=$PWD
quick=
robots=1000
seconds=30
# Localising, a robot costs more until it has found its place: once more with a fleet that sets out within so many seconds.
ramp=20
repeats=5
report=docs/performance.md
if [ "${1:-}" = --quick ]; then
  quick=--quick
  robots=100
  seconds=5
  ramp=
  repeats=2
  report=build/performance/performance.md
fi
build=${HOMING_BUILD:-$root/build/dev}
mkdir -p build/performance/images
if [ -z "${HOMING_BUILD:-}" ]; then
  sh deploy/install.sh build client test benchmark
  { cmake --preset dev -DHOMING_TESTS=ON && cmake --build --preset dev --target homing-server homing-bench homing_benchmark -j "$(nproc)"; } \
    >build/performance/build.log 2>&1 </dev/null || { tail -n 50 build/performance/build.log >&2; exit 1; }
fi

work=$(mktemp -d "${TMPDIR:-/tmp}/homing-benchmark.XXXXXX")
server=
stop_server() {
  [ -z "$server" ] || { kill "$server" 2>/dev/null && wait "$server" || true; }
  server=
}
finish() {
  stop_server
  rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' INT TERM
# start COMMAND...: a server, which says that it is "listening on" $address.
start() {
  "$@" >"$work/server.log" 2>&1 </dev/null &
  server=$!
  address=
  while [ -z "$address" ]; do
    kill -0 "$server" || { cat "$work/server.log" >&2; exit 1; }
    address=$(sed -n 's/.*listening on \([^ ]*\).*/\1/p' "$work/server.log" | head -n 1)
    [ -n "$address" ] || sleep 0.02
  done
}
# start_server NAME [FLAGS]: on a database of that name.
start_server() {
  name=$1
  shift
  start "$build/server/homing-server" --listen 127.0.0.1:0 --database "sqlite:$work/$name.db" "$@"
}
resident_kib() { sed -n 's/^VmRSS:[[:space:]]*\([0-9]*\) kB/\1/p' "/proc/$server/status"; }
field() { sed -n "s/.*\"$2\":\([0-9.e+-]*\).*/\1/p" "$1"; }
# keep RUN COUNTER VALUE
keep() { echo "$1 $2 $3" >>"$work/load"; }
bench() { "$build/client/bench/homing-bench" --server "$address" --quiet --json "$@"; }

# load RUN TLS_FLAGS_OF_CLIENT FLAGS_OF_HOMING_BENCH: one repetition, with the memory that the streams took.
load() {
  run=$1
  tls=$2
  shift 2
  before=$(resident_kib)
  # shellcheck disable=SC2086
  bench $tls --robots "$robots" --rate 10 --seconds "$seconds" "$@" >"$work/bench" &
  client=$!
  most=$before
  while kill -0 "$client" 2>/dev/null; do
    now=$(resident_kib)
    [ "$now" -le "$most" ] || most=$now
    sleep 0.2
  done
  wait "$client" || true
  keep "$run" p99_ms "$(field "$work/bench" p99_ms)"
  keep "$run" dropped "$(field "$work/bench" dropped)"
  keep "$run" late "$(field "$work/bench" late)"
  keep "$run" kib_a_stream "$(((most - before) / robots))"
}

: >"$work/load"
openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -addext subjectAltName=IP:127.0.0.1 \
  -keyout "$work/key.pem" -out "$work/cert.pem" 2>/dev/null
repeat=0
while [ "$repeat" -lt "$repeats" ]; do
  repeat=$((repeat + 1))
  echo "load $repeat of $repeats" >&2
  start "$build/tests/benchmark/homing_benchmark" --echo
  load echo_1000 ""
  stop_server
  start_server "plain$repeat"
  load record_1000 ""
  stop_server
  start_server "tls$repeat" --tls-cert "$work/cert.pem" --tls-key "$work/key.pem"
  load record_1000_tls "--tls-ca $work/cert.pem"
  stop_server
  start_server shared
  bench --prepare --journeys 10 --steps 2000
  load localize_1000 "" --localize --journeys 10 --steps 2000
  stop_server
  if [ -n "$ramp" ]; then
    start_server shared
    load localize_1000_ramp "" --localize --journeys 10 --steps 2000 --ramp "$ramp"
    stop_server
  fi
  rm -f "$work"/plain* "$work"/tls*
done

# Ten thousand journeys: one is recorded, its rows are copied.
if [ -z "$quick" ]; then
  start_server many
  bench --prepare --journeys 1 --steps 1000
  stop_server
  "$build/tests/benchmark/homing_benchmark" --copy-journeys "$work/many.db" 10000
  repeat=0
  while [ "$repeat" -lt "$repeats" ]; do
    repeat=$((repeat + 1))
    begun=$(date +%s%N)
    start_server many
    keep start serving_s "$(awk "BEGIN { print ($(date +%s%N) - $begun) / 1e9 }")"
    stop_server
  done
fi

status=0
"$build/tests/benchmark/homing_benchmark" $quick --load "$work/load" --report "$report" \
  --command "sh tests/benchmark/run.sh${quick:+ $quick}" >"$work/rows" || status=$?
cat "$work/rows"
exit "$status"
