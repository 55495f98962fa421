#!/bin/sh
# Alert rules by promtool; then a live server under load, Prometheus, Alertmanager and a webhook: each query of the
# dashboard must answer with a number, and the alert of a robot that is lost must arrive, and its end too.
# usage: sh tests/operations/run.sh     HOMING_SERVER is a program of a whole build.
set -eu
cd "$(dirname "$0")/../.."
server=${HOMING_SERVER:-build/${HOMING_PRESET:-dev}/server/homing-server}
client=$(dirname "$server")/../client
for program in promtool prometheus prometheus-alertmanager curl python3; do
  command -v "$program" >/dev/null || { echo "tests/operations/run.sh: sh deploy/install.sh operations" >&2; exit 2; }
done
promtool test rules tests/operations/alerts_test.yaml
[ -x "$server" ] && [ -x "$client/homing" ] && [ -x "$client/bench/homing-bench" ] ||
  { echo "tests/operations/run.sh: build first (sh tests/run.sh)" >&2; exit 2; }
scratch=$(mktemp -d)
pids=
# shellcheck disable=SC2086,SC2317 # a list; called by the trap
finish() {
  kill $pids 2>/dev/null || true
  wait
  rm -rf "$scratch"
}
trap finish EXIT
# said FILE PATTERN: the part of a line that the pattern's group matches, as soon as the program has printed it.
said() {
  for _ in $(seq 100); do
    found=$(sed -n "s|$2|\1|p" "$1" | head -n 1)
    [ -z "$found" ] || { echo "$found"; return; }
    sleep 0.1
  done
  cat "$1" >&2
  return 1
}

"$server" --listen 127.0.0.1:0 --http 127.0.0.1:0 --database "sqlite:$scratch/homing.db" --log-format json \
  >"$scratch/server.log" 2>"$scratch/server.json" &
pids="$pids $!"
address=$(said "$scratch/server.log" '^listening on \(.*\)$')
http=$(said "$scratch/server.log" '^metrics on http://\(.*\)/metrics$')
curl -sf "http://$http/metrics" | promtool check metrics || echo "(promtool's advice on names above)"

python3 -u tests/operations/webhook.py "$scratch/alerts" >"$scratch/webhook.log" 2>&1 &
pids="$pids $!"
webhook=$(said "$scratch/webhook.log" '^\(127.*\)$')
port=$((19000 + $$ % 500))
manager=$((port + 500))
cat >"$scratch/alertmanager.yml" <<YAML
route: {receiver: hook, group_by: [alertname], group_wait: 1s, group_interval: 1s}
receivers: [{name: hook, webhook_configs: [{url: "http://$webhook/"}]}]
YAML
prometheus-alertmanager --config.file="$scratch/alertmanager.yml" --storage.path="$scratch/alertmanager" \
  --cluster.listen-address= --web.listen-address="127.0.0.1:$manager" >"$scratch/alertmanager.log" 2>&1 &
pids="$pids $!"
cat >"$scratch/prometheus.yml" <<YAML
global: {scrape_interval: 1s, evaluation_interval: 1s}
rule_files: [$PWD/deploy/prometheus/alerts.yaml]
alerting: {alertmanagers: [{static_configs: [{targets: ["127.0.0.1:$manager"]}]}]}
scrape_configs: [{job_name: homing, static_configs: [{targets: ["$http"]}]}]
YAML
prometheus --config.file="$scratch/prometheus.yml" --storage.tsdb.path="$scratch/tsdb" \
  --web.listen-address="127.0.0.1:$port" >"$scratch/prometheus.log" 2>&1 &
pids="$pids $!"

# A rate needs a sample from before, and Prometheus takes its time to begin.
for _ in $(seq 600); do
  ! curl -sf "http://127.0.0.1:$port/api/v1/query?query=homing_open_streams" | grep -q '"value"' || break
  sleep 0.1
done
"$client/bench/homing-bench" --server "$address" --robots 20 --rate 5 --seconds 12 --localize >"$scratch/load.log" 2>&1 &
load=$!
pids="$pids $load"
# A robot in a foreign street. Its answers are read slowly, so that it is lost for a while.
homing() { "$client/homing" --quiet --json --server "$address" "$@"; }
homing record --journey robots/lost/journeys/out --left sim:street,length=20,seed=1 --right sim:street,length=20,seed=1 \
  >/dev/null
homing localize --journey robots/lost/journeys/out --left sim:street,length=40,seed=9 --right sim:street,length=40,seed=9 |
  while read -r _; do sleep 0.2; done &
pids="$pids $!"
sleep 8
python3 tests/operations/dashboard.py "127.0.0.1:$port"
wait "$load" || { cat "$scratch/load.log" >&2; exit 1; }
for state in firing resolved; do
  for _ in $(seq 120); do
    ! grep -q "$state HomingRobotLost" "$scratch/alerts" 2>/dev/null || break
    sleep 0.5
  done
  grep -m 1 "$state HomingRobotLost" "$scratch/alerts" || { cat "$scratch/alertmanager.log" >&2; exit 1; }
done
echo "operations: in order"
