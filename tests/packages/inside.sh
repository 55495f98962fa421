#!/bin/sh
# The part of run.sh that runs in the bare root, from /packages.
set -eu
cd /packages
export DEBIAN_FRONTEND=noninteractive
unit=/usr/lib/systemd/system/homing-server.service
journey=robots/r1/journeys/out
server=

fail() { echo "packages: $*" >&2; exit 1; }
say() { echo "packages: $*"; }
apt() { apt-get -q -y --no-install-recommends -o Dpkg::Use-Pty=0 "$@" >apt.log 2>&1 || { cat apt.log >&2; fail "apt-get $*"; }; }
version() { dpkg-query -W -f '${Version}' "$1"; }

# As the unit says, without systemd. Arguments are added.
start() {
  user=$(sed -n 's/^User=//p' "$unit")
  command=$(sed -n 's/^ExecStart=//p' "$unit")
  # shellcheck disable=SC2086 # one word an argument
  setpriv --reuid "$user" --regid "$user" --clear-groups env -C /var/lib/homing $command "$@" >server.log 2>&1 &
  server=$!
  for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    ! grep -q 'listening on' server.log || return 0
    kill -0 "$server" 2>/dev/null || break
    sleep 0.2
  done
  cat server.log >&2
  fail "the service does not serve"
}
stop() {
  kill "$server"
  wait "$server" || fail "SIGTERM ended the service with $?"
  server=
}
trap '[ -z "$server" ] || kill "$server"' EXIT

localise() {
  homing --quiet --json localize --journey "$journey" --travel return --left home/left --right home/right >home.json
  grep -q '"outcome":"MATCH"' home.json || { head -n 3 home.json; fail "no MATCH on the way home"; }
}

begun=$(date +%s)
apt update
apt install ./old/homing-server_*.deb ./old/homing_*.deb
say "installed $(version homing-server) in $(($(date +%s) - begun)) s"
start
homing-server healthcheck || fail "not healthy"
homing --quiet simulate --scene street,length=20,seed=1 --out out >/dev/null
homing --quiet simulate --scene street,length=20,seed=1,travel=return,offset=-1 --out home >/dev/null
homing --quiet --json record --journey "$journey" --left out/left --right out/right >record.json
localise
seconds=$(($(date +%s) - begun))
[ "$seconds" -lt 120 ] || fail "$seconds s from the installation to the first answers"
say "$(wc -l <record.json) observations recorded, $(wc -l <home.json) localised, $seconds s after the installation began"
[ "$(stat -c '%U %a' /var/lib/homing)" = 'homing 700' ] || fail "others may read /var/lib/homing"
homing --quiet journeys show "$journey" >before.txt
stop

echo '# kept by the administrator' >>/etc/homing/server.toml
apt install -o Dpkg::Options::=--force-confold ./new/*.deb
[ "$(version homing-server)" != 0.0.9 ] || fail "not upgraded"
grep -q 'kept by the administrator' /etc/homing/server.toml || fail "the upgrade lost the options"
start
homing --quiet journeys show "$journey" >after.txt
cmp before.txt after.txt || fail "the upgrade changed the journey"
localise
homing-bench --robots 2 --rate 5 --seconds 1 --ramp 0 >/dev/null
say "upgraded to $(version homing-server): the journey and the options are the same"
for program in homing homing-bench; do
  bash -c ". /usr/share/bash-completion/completions/$program; COMP_WORDS=($program --js); COMP_CWORD=1; _$(echo $program | tr - _)
    [ \"\${COMPREPLY[*]}\" = --json ]" || fail "no completion for $program"
done

# The installed library, as a robot's program finds it.
apt install g++ cmake make pkg-config
# This root leaves out documentation, and with it the installed examples.
cp -r examples/cpp example
cmake -S example -B built >cmake.log && cmake --build built >>cmake.log 2>&1 || { cat cmake.log; fail "the example does not build"; }
# shellcheck disable=SC2046 # one word an argument
g++ -std=c++17 -Wall -Wextra -Werror example/there_and_back.cc -o by_pkg_config $(pkg-config --cflags --libs homing-client)
for program in built/there_and_back ./by_pkg_config; do
  "$program" 127.0.0.1:50551 "robots/r1/journeys/$(basename $program)" out/left/*.png >steps.txt
  [ "$(tail -n 1 steps.txt | cut -d ' ' -f 2)" -gt 10 ] || { cat steps.txt; fail "the example $program does not localise"; }
done
say "the example of libhoming localises: $(tail -n 1 steps.txt)"

python3 examples/python/there_and_back.py 127.0.0.1:50551 robots/r1/journeys/python out/left out/left same >python.txt
grep -q ' MATCH ' python.txt || { cat python.txt; fail "the Python example does not localise"; }
homing --quiet --json localize --journey "$journey" --travel return --left home/left --right home/right |
  homing-vda5050 --map-id street >states.txt
[ "$(wc -l <states.txt)" = "$(wc -l <home.json)" ] || fail "not one VDA 5050 fragment an answer"
stop

# The wheel in its own environment, with asyncio over TLS.
apt install python3-venv
homing-server certs --out pki --host 127.0.0.1 --robot r1 >/dev/null
chown -R homing pki
python3 -m venv --system-site-packages venv
apt remove python3-homing
venv/bin/pip -q install --no-index wheel/homing-*.whl
start --tls-cert /packages/pki/server.pem --tls-key /packages/pki/server.key --tls-client-ca /packages/pki/ca.pem
venv/bin/python examples/python/there_and_back_async.py 127.0.0.1:50551 pki r1 out/left out/left >python.txt
grep -q 'places recognised' python.txt || { cat python.txt; fail "the asyncio example fails"; }
say "Python: synchronous from the package, asyncio over TLS from the wheel: $(tail -n 1 python.txt | sed 's/.*\r//')"
stop

apt remove homing-server
[ ! -e /usr/bin/homing-server ] || fail "remove leaves the program"
[ -s /var/lib/homing/homing.db ] && [ -s /etc/homing/server.toml ] || fail "remove deleted data or options"
apt install ./new/homing-server_*.deb
start
homing --quiet journeys show "$journey" >after.txt
cmp before.txt after.txt || fail "the journey was lost by remove and install"
stop
apt purge homing-server
[ ! -e /var/lib/homing ] && [ ! -e /etc/homing ] || fail "purge leaves data or options"
# shellcheck disable=SC2046 # one word a package
apt purge $(dpkg-query -W -f '${Package} ' 'homing*' 'libhoming*' 'python3-homing*' 2>/dev/null)
left=$(find /usr /etc /var/lib -name '*homing*' ! -path '/var/lib/dpkg/*' ! -path '/var/lib/apt/*' ! -path '/var/lib/systemd/*')
[ -z "$left" ] || fail "purge leaves $left"
say "removed, installed again, purged: all in order after $(($(date +%s) - begun)) s"
