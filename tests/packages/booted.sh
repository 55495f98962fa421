#!/bin/sh
# The part of boot.sh that runs under systemd: the packages start, restart, upgrade and stop the service.
set -eu
cd /packages
export DEBIAN_FRONTEND=noninteractive

fail() {
  echo "packages: $*" >&2
  journalctl --no-pager -n 30 -u homing-server >&2
  exit 1
}
apt() { apt-get -q -y --no-install-recommends -o Dpkg::Use-Pty=0 "$@" >apt.log 2>&1 || { cat apt.log >&2; fail "apt-get $*"; }; }
pid() { systemctl show -p MainPID --value homing-server; }
# The service runs, and serves, in a process other than $1.
await() {
  for _ in $(seq 50); do
    if [ "$(pid)" != "$1" ] && homing-server healthcheck >health.log 2>&1; then return; fi
    sleep 0.2
  done
  fail "the service does not serve: $(cat health.log)"
}
status() { sed -n "s/^$1:[[:space:]]*\([^[:space:]]*\).*/\1/p" "/proc/$(pid)/status"; }

apt install ./old/homing-server_*.deb ./old/homing_*.deb
await 0
[ "$(status Uid)" = "$(id -u homing)" ] || fail "it runs as user $(status Uid)"
[ "$(status CapEff)$(status CapBnd)" = 00000000000000000000000000000000 ] || fail "it has capabilities"
[ "$(status NoNewPrivs) $(status Seccomp)" = '1 2' ] || fail "its system calls are not filtered"
! nsenter -t "$(pid)" -m touch /usr/homing 2>touch.log || fail "it sees a writable /usr"
homing --quiet record --journey robots/r1/journeys/out --left drive/out/left --right drive/out/right >record.txt
homing --quiet journeys list >before.txt
systemd-analyze --no-pager security homing-server | sed -n 's/.*service: \([0-9.]* [A-Z]*\).*/\1/p' >exposure.txt

killed=$(pid)
kill -9 "$killed"
await "$killed"
old=$(pid)
apt install ./new/homing-server_*.deb ./new/homing_*.deb
await "$old"
homing --quiet journeys list >after.txt
cmp before.txt after.txt || fail "the upgrade changed the journeys"

apt remove homing-server
! systemctl --quiet is-active homing-server || fail "remove leaves the service running"
apt install ./new/homing-server_*.deb
await 0
apt purge homing-server homing
! systemctl --quiet is-active homing-server || fail "purge leaves the service running"
echo "packages: under systemd: started, restarted after kill -9 and by an upgrade, stopped by remove and purge;" \
  "exposure $(cat exposure.txt)"
