#!/bin/sh
# Runs every real development sequence and every simulated condition through a server, beside methods
# that keep pictures, and prints a line for each bound (name value bound ok|short). Writes docs/results.md.
# Exits 1 if any is short.
# usage: tests/accuracy/run.sh [--quick | --seeds N | --sets WORDS]     --quick: two simulated worlds a scene instead of twenty, a small
# fleet, no report, recall bounded over all conditions of a scene together; --seeds: so many worlds; --sets: some sets alone, no report
# (words between commas: real, foreign, simulated, a set or how one begins)
# HOMING_DATA names the folder of real sequences (default: ../shared/data beside the checkout; without it the
# simulated part alone is run); HOMING_BUILD a build with homing-server and homing_accuracy (default:
# build/dev, built if need be).
# To try something quickly, without a server:
#   build/dev/tests/accuracy/homing_accuracy --data ../shared/data --cache "$(sh tests/accuracy/cache_folder.sh)" --sets real --no-peers
set -eu
cd "$(dirname "$0")/../.."
root=$PWD
seeds=20
fleet=100
sets=
report=docs/results.md
pictures=docs/images
case ${1:-} in
  --quick)
    seeds=2
    fleet=10
    ;;
  --seeds) seeds=$2 ;;
  --sets)
    sets=$2
    fleet=0
    ;;
esac
case ${1:-} in
  --quick | --sets)
    report=build/accuracy-quick.md
    pictures=build/accuracy-pictures
    ;;
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
  # The first frame has nothing to be compared with.
  homing record --journey robots/still/journeys/1 --left "$data/still" | sed 1d >"$work/still"
  frames=$(grep -c '"sequence":' "$work/still")
  moving=$(grep -c '"motion":"\(MOVING\|TURNING\)"' "$work/still" || true)
  landmarks=$(grep -c '"landmark":[0-9]' "$work/still" || true)
  echo "\`still\` (a camera that does not move): $moving of $frames frames reported as moving, $landmarks with a" \
    "landmark." >"$work/more.md"
  [ "$frames" -gt 0 ] && [ "$moving" -eq 0 ] && [ "$landmarks" -eq 0 ] || { cat "$work/more.md" >&2; exit 1; }
fi

cache=$(sh tests/accuracy/cache_folder.sh)
status=0
"$build/tests/accuracy/homing_accuracy" --server "$address" --data "$data" --cache "$cache" --sets "$sets" --seeds "$seeds" --fleet "$fleet" \
  --pictures "$pictures" --report "$work/results.md" >"$work/bounds" || status=$?
if [ -s "$work/results.md" ]; then
  {
    cat tests/accuracy/results_head.md
    echo "Simulated: $seeds worlds a scene."
    echo
    cat "$work/results.md" "$work/more.md"
    echo
    echo "## Bounds that are not met"
    echo
    echo '```'
    grep ' short$' "$work/bounds" || echo none
    echo '```'
  } >"$report"
fi
cat "$work/bounds"
exit "$status"
