#!/bin/sh
# Alert rules by promtool; then a live server, Prometheus, and each query of the dashboard, which must answer.
# usage: sh tests/operations/run.sh
set -eu
cd "$(dirname "$0")/../.."
server=${HOMING_SERVER:-build/${HOMING_PRESET:-dev}/server/homing-server}
command -v promtool >/dev/null || { echo "tests/operations/run.sh: apt-get install prometheus" >&2; exit 2; }
promtool test rules tests/operations/alerts_test.yaml
[ -x "$server" ] || { echo "tests/operations/run.sh: build homing-server first (sh tests/run.sh)" >&2; exit 2; }
scratch=$(mktemp -d)
server_pid='' prometheus_pid=''
trap 'kill $server_pid $prometheus_pid 2>/dev/null || true; wait; rm -rf "$scratch"' EXIT
"$server" --listen 127.0.0.1:0 --http 127.0.0.1:0 --database "sqlite:$scratch/homing.db" >"$scratch/server.log" 2>&1 &
server_pid=$!
address=
while [ -z "$address" ]; do
  kill -0 $server_pid
  sleep 0.1
  address=$(sed -n 's|^metrics on http://\(.*\)/metrics$|\1|p' "$scratch/server.log")
done
curl -sf "http://$address/metrics" | promtool check metrics || echo "(promtool's advice on names above)"
cat >"$scratch/prometheus.yml" <<YAML
global: {scrape_interval: 1s}
rule_files: [$PWD/deploy/prometheus/alerts.yaml]
scrape_configs: [{job_name: homing, static_configs: [{targets: ["$address"]}]}]
YAML
port=$((19000 + $$ % 500))
prometheus --config.file="$scratch/prometheus.yml" --storage.tsdb.path="$scratch/tsdb" \
  --web.listen-address="127.0.0.1:$port" >"$scratch/prometheus.log" 2>&1 &
prometheus_pid=$!
sleep 8
python3 - "$port" <<'PYTHON'
import json, sys, urllib.parse, urllib.request
bad = 0
for panel in json.load(open("deploy/grafana/homing.json"))["panels"]:
    for target in panel["targets"]:
        url = f"http://127.0.0.1:{sys.argv[1]}/api/v1/query?query=" + urllib.parse.quote(target["expr"])
        found = json.load(urllib.request.urlopen(url))["data"]["result"]
        print("ok" if found else "EMPTY", panel["title"], target["expr"], len(found))
        bad += not found
sys.exit(bad != 0)
PYTHON
