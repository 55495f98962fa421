#!/bin/sh
# Runs every real development sequence and every simulated condition through a server, beside methods
# that keep pictures, and prints a line for each bound (name value bound ok|short). Writes docs/results.md.
# Exits 1 if any is short.
# usage: tests/accuracy/run.sh [--quick | --seeds N]     --quick: two simulated worlds a scene instead of twenty, a small fleet,
# no report, recall bounded over all conditions of a scene together; --seeds: so many worlds
# HOMING_DATA names the folder of real sequences (default: ../shared/data beside the checkout; without it the
# simulated part alone is run); HOMING_BUILD a build with homing-server and homing_accuracy (default:
# build/dev, built if need be).
set -eu
cd "$(dirname "$0")/../.."
root=$PWD
seeds=20
fleet=100
report=docs/results.md
pictures=docs/images
case ${1:-} in
  --quick)
    seeds=2
    fleet=10
    report=build/accuracy-quick.md
    pictures=build/accuracy-pictures
    ;;
  --seeds) seeds=$2 ;;
esac
data=${HOMING_DATA:-$root/../shared/data}
if [ ! -d "$data/laps" ]; then
  echo "SKIPPED: no real sequences in $data (HOMING_DATA); simulated ones alone"
  data=
fi
build=${HOMING_BUILD:-$root/build/dev}
mkdir -p build "$pictures"
if [ -z "${HOMING_BUILD:-}" ]; then
  sh deploy/install.sh build client test
  { cmake --preset dev -DHOMING_TESTS=ON && cmake --build --preset dev --target homing-server homing homing_accuracy -j "$(nproc)"; } \
    >build/accuracy-build.log 2>&1 </dev/null || { tail -n 50 build/accuracy-build.log >&2; exit 1; }
fi

work=$(mktemp -d "${TMPDIR:-/tmp}/homing-accuracy.XXXXXX")
server=
finish() {
  [ -z "$server" ] || { kill "$server" 2>/dev/null && wait "$server" || true; }
  rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' INT TERM
"$build/server/homing-server" --listen 127.0.0.1:0 --database "sqlite:$work/homing.db" \
  >"$work/server.log" 2>&1 </dev/null &
server=$!
address=
while [ -z "$address" ]; do
  kill -0 "$server" || { cat "$work/server.log" >&2; exit 1; }
  address=$(sed -n 's/.*listening on \([^ ]*\).*/\1/p' "$work/server.log" | head -n 1)
  [ -n "$address" ] || sleep 0.1
done
homing() { "$build/client/homing" --server "$address" --quiet --json "$@"; }

# A camera that does not move has no landmark; and the map is the same whether frames are sent or the flow.
: >"$work/more.md"
if [ -n "$data" ]; then
  for send in frames flow; do
    homing record --journey "robots/laps/journeys/$send" --left "$data/laps/lap1" --send "$send" >/dev/null
    homing journeys export "robots/laps/journeys/$send" "$work/$send.map" >/dev/null
  done
  cmp "$work/frames.map" "$work/flow.map"
  homing record --journey robots/still/journeys/1 --left "$data/still" >"$work/still"
  steps=$(grep -c '"step":[0-9]' "$work/still")
  standing=$(grep -c '"motion":"STANDING"' "$work/still" || true)
  landmarks=$(grep -c '"landmark":' "$work/still" || true)
  echo "\`still\` (a camera that does not move): $standing of $steps steps told as STANDING, $landmarks with a" \
    "landmark." >"$work/more.md"
  [ "$standing" -eq "$steps" ] && [ "$landmarks" -eq 0 ] || { cat "$work/more.md" >&2; exit 1; }
fi

# Simulated drives are kept as long as what makes them does not change.
key=$(cat homing/flow/*.* homing/image/*.* client/simulator/*.* tests/accuracy/drive.cc | sha256sum | cut -c 1-16)
cache=build/accuracy-cache/$key
mkdir -p "$cache"
status=0
"$build/tests/accuracy/homing_accuracy" --server "$address" --data "$data" --cache "$cache" --seeds "$seeds" --fleet "$fleet" \
  --pictures "$pictures" --report "$work/results.md" >"$work/bounds" || status=$?
if [ -s "$work/results.md" ]; then
  {
    cat tests/accuracy/results_head.md
    echo "Simulated: $seeds worlds a scene."
    echo
    cat "$work/results.md" "$work/more.md"
  } >"$report"
fi
cat "$work/bounds"
exit "$status"
