#!/bin/sh
# Runs the commands of docs/tutorial.md as they are written there, in at most three minutes. Variables give the
# server its own port, so that another one on this machine is left alone.
# usage: sh tests/documents/tutorial.sh [--built]
#   --built: without the section "Build", in a separate folder; the programs are in PATH.
set -eu
cd "$(dirname "$0")/../.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
awk -v built="${1:-}" '
  /^## / { build = /Build$/ }
  /^```/ { code = !code && $0 == "```sh"; next }
  code && !(built == "--built" && build)' docs/tutorial.md >"$scratch/commands"
[ "${1:-}" != --built ] || cd "$scratch"
port=$((20000 + $$ % 10000))
export HOMING_LISTEN="127.0.0.1:$port" HOMING_SERVER="127.0.0.1:$port" HOMING_HTTP=127.0.0.1:0
# A failed command ends it, and the server with it.
status=0
# shellcheck disable=SC2016 # expanded by the inner shell
timeout --kill-after 5 180 sh -euc '
  trap "kill \${server:-} 2>/dev/null || true" EXIT
  set -x
  . "$1"' sh "$scratch/commands" || status=$?
[ "$status" -ne 124 ] || echo "tutorial: not over after three minutes" >&2
[ "$status" -ne 0 ] || echo "tutorial: in order"
exit "$status"
