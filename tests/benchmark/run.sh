#!/bin/sh
# Measures speed beside other programs; prints a line for each bound (name value bound ok|short|unsure) and writes
# docs/performance.md. Exits 1 if any is short.
# usage: tests/benchmark/run.sh [--quick] [--repeats N] [--seconds N] [--only PART]
#   --quick      smaller sizes and fewer robots
#   --repeats N  of each load (default 5)
#   --seconds N  of each load (default 30)
#   --only PART  loads, growth, starts, or a regular expression of benchmarks such as flow_grpc
# With --quick or --only the report goes to build/performance/ instead.
# HOMING_BUILD names a build with homing-server, homing-bench and homing_benchmark (default: build/dev, built if need be).
# shellcheck disable=SC2034 # loads.sh uses them
set -eu
cd "$(dirname "$0")/../.."
root=$PWD
command="sh tests/benchmark/run.sh${*:+ $*}"
quick=
only=
robots=1000
seconds=30
# Localising, a robot costs more until it has found its place: a fleet sets out within so many seconds.
ramp=20
repeats=5
report=docs/performance.md
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=--quick robots=100 seconds=5 ramp=2 repeats=2 ;;
    --only) only=$2; shift ;;
    --repeats) repeats=$2; shift ;;
    --seconds) seconds=$2; shift ;;
    *) echo "run.sh: unknown: $1" >&2; exit 2 ;;
  esac
  shift
done
[ -z "$quick$only" ] || report=build/performance/performance.md
build=${HOMING_BUILD:-$root/build/dev}
mkdir -p build/performance/images
if [ -z "${HOMING_BUILD:-}" ]; then
  sh deploy/install.sh build client test benchmark
  { cmake --preset dev -DHOMING_TESTS=ON && cmake --build --preset dev --target homing-server homing-bench homing_benchmark -j "$(nproc)"; } \
    >build/performance/build.log 2>&1 </dev/null || { tail -n 50 build/performance/build.log >&2; exit 1; }
fi

. tests/benchmark/loads.sh
work=$(mktemp -d "${TMPDIR:-/tmp}/homing-benchmark.XXXXXX")
finish() {
  stop_server
  rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' INT TERM
: >"$work/load"

filter=${only:-all}
case $only in
  loads) run_loads ;;
  growth) seconds=10; run_growth ;;
  starts) run_starts ;;
  '')
    run_loads
    # Not with --quick, which has five minutes.
    [ -n "$quick" ] || { run_starts; seconds=10; run_growth; }
    ;;
esac
case $only in loads | growth | starts) filter='^$' ;; esac
status=0
"$build/tests/benchmark/homing_benchmark" $quick --filter "$filter" --load "$work/load" --report "$report" \
  --command "$command" >"$work/rows" || status=$?
cat "$work/rows"
exit "$status"
