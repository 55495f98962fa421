#!/bin/sh
# Records from an RTSP camera. usage: sh rtsp_test.sh HOMING HOMING_SERVER
# Exit 77: the packages of rtsp_server.py are missing.
set -eu
homing=$1
work=$(mktemp -d)
camera=
server=
finish() {
  [ -z "$camera" ] || kill "$camera" 2>/dev/null || true
  [ -z "$server" ] || kill "$server" 2>/dev/null || true
  wait
  rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' INT TERM

# await PID FILE SCRIPT: the first line that sed's script prints of the file.
await() {
  for _ in $(seq 100); do
    found=$(sed -n "$3" "$2" | head -n 1)
    [ -z "$found" ] || { echo "$found"; return 0; }
    kill -0 "$1" 2>/dev/null || return 1
    sleep 0.1
  done
  return 1
}
/usr/bin/python3 "$(dirname "$0")/rtsp_server.py" >"$work/camera.log" 2>&1 &
camera=$!
if ! address=$(await "$camera" "$work/camera.log" '/^rtsp:/p'); then
  wait "$camera" || status=$?
  camera=
  [ "${status:-0}" -ne 77 ] || { echo "the packages of an RTSP server are missing"; exit 77; }
  cat "$work/camera.log" >&2
  exit 1
fi
"$2" --listen 127.0.0.1:0 --http off --database "sqlite:$work/homing.db" >"$work/server.log" 2>&1 &
server=$!
listening=$(await "$server" "$work/server.log" 's/.*listening on //p')

"$homing" --server "$listening" --json record --journey robots/r/journeys/live --left "$address" --seconds 3 \
  >"$work/record.json"
count=$(wc -l <"$work/record.json")
echo "recorded $count frames from $address"
[ "$count" -ge 20 ]
"$homing" --server "$listening" --json journeys show robots/r/journeys/live | head -n 1 | grep -q FINISHED
