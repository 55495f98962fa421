#!/bin/sh
# A file of homing localize --mcap-out, as Foxglove's own library reads it: by its index and from beginning to
# end, with its checksums and schemas. Needs npm and the npm registry, and zstd; exit code 1 if the file is
# wrong, 3 if the registry is not reached.
# usage: sh tests/mcap/run.sh [BUILD]      BUILD (default build/dev) has homing and homing-server.
set -eu
cd "$(dirname "$0")/../.."
build=$(cd "${1:-build/dev}" && pwd)
work=build/mcap
mkdir -p "$work"
cp tests/mcap/package.json tests/mcap/package-lock.json tests/mcap/check_mcap.mjs "$work"
npm ci --prefix "$work" --ignore-scripts --no-audit --no-fund --loglevel=error || exit 3
cd "$work"

rm -f homing.db* server.log
"$build/server/homing-server" --listen 127.0.0.1:0 --http off --database sqlite:homing.db >server.log 2>&1 &
server=$!
trap 'kill "$server"; wait "$server" || true' EXIT
trap 'exit 130' INT TERM
address=
for _ in $(seq 100); do
  address=$(sed -n 's/.*listening on //p' server.log)
  [ -z "$address" ] || break
  sleep 0.1
done
[ -n "$address" ] || { cat server.log >&2; exit 1; }
scene=sim:street,length=6
homing() { "$build/client/homing" --quiet --server "$address" --json "$@"; }
homing record --journey robots/r/journeys/out --left "$scene" --right "$scene" >record.json
homing localize --journey robots/r/journeys/out --left "$scene,travel=return" --right "$scene,travel=return" \
  --mcap-out answers.mcap --csv answers.csv >answers.json
node check_mcap.mjs answers.mcap "$PWD/node_modules" >topics.json
python3 - "$(wc -l <answers.json)" <<'PYTHON'
import json
import sys

answers = int(sys.argv[1])
with open("topics.json", encoding="utf-8") as file:
    topics = json.load(file)
expected = {"/homing/answer": "homing.v1.LocalizeResponse"}
for camera in ("left", "right"):
    expected[f"/homing/{camera}/image"] = "foxglove.RawImage"
    expected[f"/homing/{camera}/annotations"] = "foxglove.ImageAnnotations"
found = {name: topic["schema"] for name, topic in topics.items()}
assert found == expected, found
for name, topic in topics.items():
    assert topic["messages"] == answers > 10, (name, topic, answers)
for camera in ("left", "right"):
    notes = topics[f"/homing/{camera}/annotations"]
    assert notes["points"] > 100 and notes["circles"] > 10 and "step" in notes["text"], notes
print(f"mcap: {answers} answers with images, flow and landmarks, as @mcap/core reads them")
PYTHON
