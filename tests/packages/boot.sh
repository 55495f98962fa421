#!/bin/sh
# Boots a bare root of run.sh with systemd and runs booted.sh in it, without a network.
# usage: sh tests/packages/boot.sh ROOT      Skipped where containers cannot boot.
set -eu
cd "$(dirname "$0")/../.."
root=$1
if ! command -v systemd-nspawn >/dev/null || ! [ -w /sys/fs/cgroup ]; then
  echo "packages: SKIPPED: systemd-nspawn cannot boot a root here"
  exit 0
fi
cp tests/packages/booted.sh "$root/packages"
sh .ci/bare_root.sh "$root" apt-get -q -y --no-install-recommends install systemd >"$root/packages/apt.log" 2>&1 ||
  { cat "$root/packages/apt.log" >&2; exit 1; }

log=$root/packages/boot.log
systemd-nspawn --quiet -D "$root" --boot --private-network --register=no --keep-unit --console=pipe >"$log" 2>&1 </dev/null &
nspawn=$!
# SIGTERM shuts the system in it down.
trap 'kill "$nspawn" 2>/dev/null || true; wait "$nspawn" || true' EXIT
trap 'exit 130' INT TERM
init=
for _ in $(seq 100); do
  init=$(ps -o pid= --ppid "$nspawn" | tr -d ' ')
  [ -z "$init" ] || ! nsenter -t "$init" -a systemctl is-system-running --quiet 2>/dev/null || break
  kill -0 "$nspawn" 2>/dev/null || { cat "$log" >&2; exit 1; }
  sleep 0.3
done
nsenter -t "$init" -a sh /packages/booted.sh
