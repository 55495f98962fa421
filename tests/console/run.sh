#!/bin/sh
# The console in Debian's Chromium against a live server with a hundred robots. Screenshots are kept in
# build/console. usage: sh tests/console/run.sh
set -eu
cd "$(dirname "$0")/../.."
preset=${HOMING_PRESET:-dev}
server=${HOMING_SERVER:-$PWD/build/$preset/server/homing-server}
[ -x "$server" ] || { echo "tests/console/run.sh: build homing-server first (sh tests/run.sh)" >&2; exit 2; }
command -v chromium >/dev/null || { echo "tests/console/run.sh: apt-get install chromium" >&2; exit 2; }
[ -d tests/console/node_modules ] ||
  npm ci --prefix tests/console --ignore-scripts --no-audit --no-fund --loglevel=error
exec node tests/console/console.mjs "$server" "$PWD/proto" "$PWD/build/console"
