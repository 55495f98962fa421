#!/bin/sh
# The part of run.sh that runs in the bare root, from /packages.
set -eu
cd /packages
export DEBIAN_FRONTEND=noninteractive
unit=/usr/lib/systemd/system/homing-server.service
out=drive/out
home=drive/home
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

# record NAME LEFT RIGHT: as robots/r1/journeys/NAME, and its map as NAME.map.
record() {
  homing --quiet --json record --journey "robots/r1/journeys/$1" --left "$2" --right "$3" >record.json
  homing --quiet journeys export "robots/r1/journeys/$1" "$1.map" >export.txt
}
# localise NAME LEFT RIGHT: on that journey.
localise() {
  homing --quiet --json localize --journey "robots/r1/journeys/$1" --travel return --left "$2" --right "$3" >home.json
  grep -q '"outcome":"MATCH"' home.json || { head -n 3 home.json; fail "no MATCH on the way home along $1"; }
}
show() { homing --quiet journeys show robots/r1/journeys/folder; }

begun=$(date +%s)
apt update
apt install ./old/homing-server_*.deb ./old/homing_*.deb
say "installed $(version homing-server) in $(($(date +%s) - begun)) s"
start
homing-server healthcheck || fail "not healthy"
record zstd.mcap $out/bags/zstd.mcap $out/bags/zstd.mcap
localise zstd.mcap $home/bags/zstd.mcap $home/bags/zstd.mcap
seconds=$(($(date +%s) - begun))
[ "$seconds" -lt 120 ] || fail "$seconds s from the installation to the first answers"
say "$(wc -l <record.json) observations of a bag recorded, $(wc -l <home.json) localised, $seconds s after the installation began"
for bag in none.mcap lz4.mcap none.bag bz2.bag lz4.bag rosbag2.db3; do
  record $bag $out/bags/$bag $out/bags/$bag
  localise $bag $home/bags/$bag $home/bags/$bag
  cmp zstd.mcap.map $bag.map || fail "the map of $bag differs"
done
record folder $out/left $out/right
localise folder $home/left $home/right
say "recorded and localised: a folder, and a bag of each format with the same map, $(stat -c %s zstd.mcap.map) bytes"
[ "$(stat -c '%U %a' /var/lib/homing)" = 'homing 700' ] || fail "others may read /var/lib/homing"
show >before.txt
stop

echo '# kept by the administrator' >>/etc/homing/server.toml
apt install -o Dpkg::Options::=--force-confold ./new/*.deb
[ "$(version homing-server)" != 0.0.9 ] || fail "not upgraded"
grep -q 'kept by the administrator' /etc/homing/server.toml || fail "the upgrade lost the options"
start
show >after.txt
cmp before.txt after.txt || fail "the upgrade changed the journey"
localise folder $home/left $home/right
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
  "$program" 127.0.0.1:50551 "robots/r1/journeys/$(basename $program)" $out/left/*.png >steps.txt
  [ "$(tail -n 1 steps.txt | cut -d ' ' -f 2)" -gt 10 ] || { cat steps.txt; fail "the example $program does not localise"; }
done
say "the example of libhoming localises: $(tail -n 1 steps.txt)"

python3 examples/python/there_and_back.py 127.0.0.1:50551 robots/r1/journeys/python $out/left $out/left same >python.txt
grep -q ' MATCH ' python.txt || { cat python.txt; fail "the Python example does not localise"; }
homing --quiet --json localize --journey robots/r1/journeys/folder --travel return --left $home/left --right $home/right |
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
venv/bin/python examples/python/there_and_back_async.py 127.0.0.1:50551 pki r1 $out/left $out/left >python.txt
grep -q 'places recognised' python.txt || { cat python.txt; fail "the asyncio example fails"; }
say "Python: synchronous from the package, asyncio over TLS from the wheel: $(tail -n 1 python.txt | sed 's/.*\r//')"
stop

apt remove homing-server
[ ! -e /usr/bin/homing-server ] || fail "remove leaves the program"
[ -s /var/lib/homing/homing.db ] && [ -s /etc/homing/server.toml ] || fail "remove deleted data or options"
apt install ./new/homing-server_*.deb
start
show >after.txt
cmp before.txt after.txt || fail "the journey was lost by remove and install"
stop
apt purge homing-server
[ ! -e /var/lib/homing ] && [ ! -e /etc/homing ] || fail "purge leaves data or options"
# shellcheck disable=SC2046 # one word a package
apt purge $(dpkg-query -W -f '${Package} ' 'homing*' 'libhoming*' 'python3-homing*' 2>/dev/null)
left=$(find /usr /etc /var/lib -name '*homing*' ! -path '/var/lib/dpkg/*' ! -path '/var/lib/apt/*' ! -path '/var/lib/systemd/*')
[ -z "$left" ] || fail "purge leaves $left"
say "removed, installed again, purged: all in order after $(($(date +%s) - begun)) s"
