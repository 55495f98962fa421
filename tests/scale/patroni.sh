#!/bin/sh
# PostgreSQL 15 with a synchronous replica under Patroni and etcd, in a folder, with the configuration of deploy/scale, for
# tests/scale. One machine; all ports are on loopback.
# usage: sh patroni.sh start|failover|replica|stop FOLDER
# start prints the URL. failover kills the leader with its Patroni, as a machine that dies, and waits until the other
# database leads; replica starts the killed one again and waits until it follows synchronously.
set -eu
command=$1
folder=$2
here=$(cd "$(dirname "$0")" && pwd)
deploy=$(cd "$here/../../deploy/scale" && pwd)
etcd=42379

as_postgres() {
  if [ "$(id -u)" -eq 0 ]; then runuser -u postgres -- "$@"; else "$@"; fi
}

query() { # query PORT SQL: as Patroni's superuser
  PGPASSWORD=secret PGCONNECT_TIMEOUT=2 psql -X -A -t -q -h 127.0.0.1 -p "$1" -U postgres -d "${3:-postgres}" -c "$2" 2>/dev/null || true
}

# background NAME COMMAND...: a process of the user postgres, whose number is in $folder/NAME.pid.
background() {
  name=$1
  shift
  # Keeps no pipe of the caller open.
  (
    exec >/dev/null 2>&1 </dev/null
    # shellcheck disable=SC2016 # expanded by the inner shell
    as_postgres setsid python3 "$here/reaper.py" sh -c 'echo $$ >"$1.pid"; log=$1.log; shift; exec "$@" >>"$log" 2>&1' sh "$folder/$name" "$@"
  ) &
}

# await SECONDS COMMAND...: until it succeeds.
await() {
  end=$(($(date +%s) + $1))
  shift
  until "$@"; do
    [ "$(date +%s)" -lt "$end" ] || { tail -n 8 "$folder"/patroni*.log >&2; echo "patroni.sh: not in time: $*" >&2; exit 1; }
    sleep 0.2
  done
}

leads() { [ "$(query "$1" 'SELECT pg_is_in_recovery()')" = f ]; }
# Patroni promotes no replica that it has not noted as the synchronous one.
follows() { python3 -c 'import sys, urllib.request as r; r.urlopen(sys.argv[1], timeout=2)' "http://127.0.0.1:$(($1 + 1000))/sync" 2>/dev/null; }
has_database() { [ "$(query "$1" 'SELECT 1' homing)" = 1 ]; }
leader() { cat "$folder/leader"; }
other() { echo $((90883 - $1)); }

start_member() { # start_member PORT: a database, and Patroni's REST server on the port above the next thousand
  background "patroni$1" env PATRONI_SCOPE=homing PATRONI_NAME="db-$1" PATRONI_ETCD3_HOSTS="127.0.0.1:$etcd" \
    PATRONI_SUPERUSER_USERNAME=postgres PATRONI_SUPERUSER_PASSWORD=secret PATRONI_REPLICATION_USERNAME=replica \
    PATRONI_REPLICATION_PASSWORD=secret HOMING_DB_PASSWORD=secret PATRONI_POSTGRESQL_DATA_DIR="$folder/$1" \
    PATRONI_POSTGRESQL_LISTEN="127.0.0.1:$1" PATRONI_POSTGRESQL_CONNECT_ADDRESS="127.0.0.1:$1" \
    PATRONI_RESTAPI_LISTEN="127.0.0.1:$(($1 + 1000))" PATRONI_RESTAPI_CONNECT_ADDRESS="127.0.0.1:$(($1 + 1000))" \
    PATRONI_POSTGRESQL_PGPASS="$folder/pgpass$1" patroni "$folder/patroni.yml"
}

kill_one() { # kill_one FILE NAME: the program NAME whose process number is the file's first line
  pid=$(head -n 1 "$1" 2>/dev/null || true)
  if [ -n "$pid" ] && [ "$(cat "/proc/$pid/comm" 2>/dev/null)" = "$2" ]; then kill -9 "$pid" || true; fi
}

kill_member() {
  kill_one "$folder/patroni$1.pid" patroni
  kill_one "$folder/$1/postmaster.pid" postgres
}

case $command in
  start)
    [ "$(id -u)" -ne 0 ] || chown postgres "$folder"
    # The deployed configuration, but for what names a path of the image; the sockets of both databases are here.
    cp "$deploy/create_database.sh" "$folder/create_database.sh"
    sed "s|post_bootstrap: .*|post_bootstrap: sh $folder/create_database.sh|; s|^  use_pg_rewind: true|&\n  parameters: {unix_socket_directories: $folder}|" \
      "$deploy/patroni.yml" >"$folder/patroni.yml"
    chmod a+r "$folder/create_database.sh" "$folder/patroni.yml"
    background etcd etcd --data-dir="$folder/etcd" --listen-client-urls="http://127.0.0.1:$etcd" \
      --advertise-client-urls="http://127.0.0.1:$etcd" --listen-peer-urls="http://127.0.0.1:$((etcd + 1))" \
      --initial-advertise-peer-urls="http://127.0.0.1:$((etcd + 1))" --initial-cluster="default=http://127.0.0.1:$((etcd + 1))"
    start_member 45441
    await 60 has_database 45441
    start_member 45442
    await 60 follows 45442
    echo 45441 >"$folder/leader"
    echo "postgresql://homing:secret@127.0.0.1:45441,127.0.0.1:45442/homing"
    ;;
  failover)
    old=$(leader)
    kill_member "$old"
    await 60 leads "$(other "$old")"
    other "$old" >"$folder/leader"
    ;;
  replica)
    start_member "$(other "$(leader)")"
    await 90 follows "$(other "$(leader)")"
    ;;
  stop)
    kill_member 45441
    kill_member 45442
    kill_one "$folder/etcd.pid" etcd
    ;;
  *) exit 2 ;;
esac
