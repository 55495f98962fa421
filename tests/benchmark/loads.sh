# Servers and load clients; sourced by run.sh, which sets build, work, robots, seconds, ramp and repeats. Each result is
# a line of $work/load: RUN COUNTER VALUE.
# shellcheck shell=sh disable=SC2154 # set by run.sh

server=
stop_server() {
  [ -z "$server" ] || { kill "$server" 2>/dev/null && wait "$server" || true; }
  server=
}
# start COMMAND...: a server, which says that it is "listening on" $address.
start() {
  # Else the address of the server before could be read.
  : >"$work/server.log"
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
# start_echo [CERT KEY]
start_echo() { start "$build/tests/benchmark/homing_benchmark" --echo "$@"; }
resident_kib() { sed -n 's/^VmRSS:[[:space:]]*\([0-9]*\) kB/\1/p' "/proc/$server/status"; }
# Processor time of the server so far, in ticks of 10 ms.
cpu_ticks() { awk '{ print $14 + $15 }' "/proc/$server/stat"; }
field() { sed -n "s/.*\"$2\":\([0-9.e+-]*\).*/\1/p" "$1"; }
# keep RUN COUNTER VALUE
keep() { echo "$1 $2 $3" >>"$work/load"; }
bench() { "$build/client/bench/homing-bench" --server "$address" --json "$@" 2>"$work/bench.log"; }

# load RUN FLAGS_OF_HOMING_BENCH: one repetition. Processor time counts once all robots are connected.
load() {
  run=$1
  shift
  before=$(resident_kib)
  ticks=
  bench --rate 10 --seconds "$seconds" "$@" >"$work/bench" &
  client=$!
  most=$before
  while kill -0 "$client" 2>/dev/null; do
    now=$(resident_kib)
    [ "$now" -le "$most" ] || most=$now
    [ -n "$ticks" ] || ! grep -q 'robots are connected' "$work/bench.log" || ticks=$(cpu_ticks)
    sleep 0.2
  done
  wait "$client" || cat "$work/bench.log" >&2
  for counter in p99_ms dropped late per_second first_answer_ms settled_p99_ms; do
    keep "$run" "$counter" "$(field "$work/bench" "$counter")"
  done
  keep "$run" cpu_us "$(awk "BEGIN { print ($(cpu_ticks) - $ticks) * 1e4 / $(field "$work/bench" answered) }")"
  keep "$run" kib_a_stream "$(((most - before) / $(field "$work/bench" robots)))"
  keep "$run" mib "$((most / 1024))"
}

# In turns, so that each load has its echo beside it.
run_loads() {
  openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -addext subjectAltName=IP:127.0.0.1 \
    -keyout "$work/key.pem" -out "$work/cert.pem" 2>/dev/null
  start_server shared
  bench --prepare --journeys 10 --steps 2000
  stop_server
  localize="--robots $robots --localize --journeys 10 --steps 2000"
  repeat=0
  while [ "$repeat" -lt "$repeats" ]; do
    repeat=$((repeat + 1))
    echo "load $repeat of $repeats" >&2
    start_echo
    load echo_1000 --robots "$robots"
    stop_server
    start_server plain
    load record_1000 --robots "$robots"
    stop_server
    start_echo "$work/cert.pem" "$work/key.pem"
    load echo_1000_tls --robots "$robots" --tls-ca "$work/cert.pem"
    stop_server
    start_server tls --tls-cert "$work/cert.pem" --tls-key "$work/key.pem"
    load record_1000_tls --robots "$robots" --tls-ca "$work/cert.pem"
    stop_server
    start_echo
    load echo_1000_ramp --robots "$robots" --ramp "$ramp"
    stop_server
    start_server shared
    # shellcheck disable=SC2086
    load localize_1000 $localize --ramp "$ramp"
    stop_server
    start_server shared
    # shellcheck disable=SC2086
    load localize_1000_at_once $localize
    stop_server
    rm -f "$work"/plain* "$work"/tls*
  done
}

# From few robots to more than the machine carries.
run_growth() {
  start_server shared
  bench --prepare --journeys 10 --steps 2000
  stop_server
  for count in 10 20 50 100 200 500 1000 2000; do
    echo "growth: $count robots" >&2
    start_echo
    load "growth_echo/$count" --robots "$count"
    stop_server
    start_server plain
    load "growth_record/$count" --robots "$count"
    stop_server
    start_server shared
    load "growth_localize/$count" --robots "$count" --localize --journeys 10 --steps 2000 --ramp 1
    stop_server
    rm -f "$work"/plain*
  done
}

# Ten thousand journeys: one is recorded, its rows are copied.
run_starts() {
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
}
