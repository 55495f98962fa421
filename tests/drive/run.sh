#!/bin/sh
# Drives simulated robots home by the answers alone and prints a line for each bound (name value bound ok|short). Exits 1 if
# any is short. The robots of the statistics run the server's recorder and localizer in this process, on corners that are
# projected from the same worlds (true flow, with the noise, losses and clutter of a tracker): an image drive takes 20 s of a
# core, a projected one 1 s. Those on rendered images with tracked flow are the last rows, and the drives through a real
# server, one of which is killed and started again on the way.
# usage: tests/drive/run.sh [--quick]     --quick: 24 robots a row instead of 100, but 100 where the share is near its bound;
# and one image drive of a kind; about 3 minutes
# HOMING_BUILD names a build with homing-server, homing and homing_drive_rows (default: build/dev, built if need be).
set -eu
cd "$(dirname "$0")/../.."
robots=100
rendered=8
drives='street,return landmarks,return street,same landmarks,same'
if [ "${1:-}" = --quick ]; then
  robots=24
  rendered=1
  drives='street,return'
fi
build=${HOMING_BUILD:-$PWD/build/dev}
mkdir -p build
if [ -z "${HOMING_BUILD:-}" ]; then
  sh deploy/install.sh build client test
  { cmake --preset dev -DHOMING_TESTS=ON && cmake --build --preset dev --target homing-server homing homing_drive_rows -j "$(nproc)"; } \
    >build/drive-build.log 2>&1 </dev/null || { tail -n 50 build/drive-build.log >&2; exit 1; }
fi
status=0
"$build/tests/drive/homing_drive_rows" --robots "$robots" --rendered "$rendered" || status=$?

work=$(mktemp -d "${TMPDIR:-/tmp}/homing-drive.XXXXXX")
server=
finish() {
  [ -z "$server" ] || { kill "$server" 2>/dev/null && wait "$server" || true; }
  rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' INT TERM
# start ADDRESS: as the server was, the second time at the same place.
start() {
  "$build/server/homing-server" --listen "$1" --http 127.0.0.1:0 --database "sqlite:$work/homing.db" \
    >"$work/server.log" 2>&1 </dev/null &
  server=$!
  address=
  while [ -z "$address" ]; do
    kill -0 "$server" || { cat "$work/server.log" >&2; exit 1; }
    address=$(sed -n 's/.*listening on \([^ ]*\).*/\1/p' "$work/server.log" | head -n 1)
    [ -n "$address" ] || sleep 0.1
  done
}
# through_server NAME SCENE TRAVEL: one image drive by the command.
through_server() {
  if "$build/client/homing" --server "$address" --quiet drive --journey "robots/$2/journeys/$3" \
    --scene "$2,length=60,fps=10,seed=201" --travel "$3" >"$work/drive.log" 2>&1; then
    verdict=ok
  else
    verdict=short
  fi
  echo "$1: $(head -n 1 "$work/drive.log") $verdict" | tee -a "$work/verdicts"
}
start 127.0.0.1:0
for drive in $drives; do
  through_server "through a server, $drive" "${drive%,*}" "${drive#*,}"
done
# Killed on the way: the journey is there, so that the drive home is all that runs.
(
  sleep 6
  kill -9 "$server"
) &
killer=$!
through_server 'server killed and started again' street return &
drive=$!
wait "$killer"
wait "$server" 2>/dev/null || true
start "$address"
wait "$drive"
! grep -q ' short$' "$work/verdicts" || status=1
exit "$status"
