#!/bin/sh
# Many servers on one PostgreSQL, a line each: name figure bound ok|short. Exit code 1 if any is short.
# usage: sh tests/scale/run.sh [--quick] [--loaded] [--only rounds|patroni|throughput]
#   [--rounds N]
# Installs PostgreSQL 15, Patroni and etcd from Debian and runs them in temporary folders. HOMING_PRESET (default dev) names the CMake
# preset; the figures of docs/scaling.md are those of the preset release.
set -eu
cd "$(dirname "$0")/../.."
preset=${HOMING_PRESET:-dev}
mkdir -p build
log=build/$preset-scale.log
{
  sh deploy/install.sh build client test scale
  cmake --preset "$preset" -DHOMING_TESTS=ON
  cmake --build --preset "$preset" -j "$(nproc)" --target homing-server homing-bench homing_scale
} >"$log" 2>&1 </dev/null || { tail -n 100 "$log" >&2; exit 1; }
build=build/$preset
# The user postgres must be able to enter it.
exec "$build/tests/scale/homing_scale" "$PWD/$build/server/homing-server" "$PWD/$build/client/bench/homing-bench" \
  "$PWD/tests/scale/database.sh" "$PWD/tests/scale/patroni.sh" "$@"
