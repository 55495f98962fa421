#!/bin/sh
# A PostgreSQL 15 with a synchronous replica, in a folder, for tests/scale.
# usage: sh database.sh start|failover|replica|stop FOLDER
# start prints the URL. failover stops the primary as a power failure would and promotes the replica; replica then makes
# the old primary a new replica. Both listen on Unix sockets in FOLDER, on ports 5441 and 5442.
set -eu
command=$1
folder=$2
programs=/usr/lib/postgresql/15/bin

as_postgres() {
  if [ "$(id -u)" -eq 0 ]; then runuser -u postgres -- "$@"; else "$@"; fi
}

control() {
  port=$1
  shift
  as_postgres "$programs/pg_ctl" -D "$folder/$port" -l "$folder/$port.log" -w -t 60 "$@" >"$folder/pg_ctl.log" 2>&1 ||
    { cat "$folder/pg_ctl.log" "$folder/$port.log" >&2; exit 1; }
}

# The first run as postgres creates files here. A replica that is promoted just when it has lost its primary would first
# sleep for wal_retrieve_retry_interval, by default 5 s.
start_one() {
  control "$1" start -o "-c listen_addresses= -k $folder -p $1 -c max_connections=100 -c hot_standby_feedback=on -c wal_retrieve_retry_interval=200ms"
}

query() {
  port=$1
  shift
  as_postgres "$programs/psql" -X -A -t -q -h "$folder" -p "$port" -U homing "$@"
}

# A replica on port $2 of the primary on port $1; commits wait for it from now on.
add_replica() {
  rm -rf "${folder:?}/$2"
  as_postgres "$programs/pg_basebackup" -D "$folder/$2" -R -c fast -X stream -N \
    -d "host=$folder port=$1 user=homing application_name=replica"
  # Once promoted it must not wait for a replica that is not there yet.
  as_postgres sh -c "sed -i '/synchronous_standby_names/d' '$folder/$2/postgresql.auto.conf'"
  start_one "$2"
  for _ in $(seq 300); do
    [ "$(query "$1" -d postgres -c "SELECT count(*) FROM pg_stat_replication WHERE state = 'streaming'")" -lt 1 ] || break
    sleep 0.1
  done
  query "$1" -d postgres -c "ALTER SYSTEM SET synchronous_standby_names = 'replica'" -c "SELECT pg_reload_conf()" >/dev/null
  for _ in $(seq 300); do
    [ "$(query "$1" -d postgres -c "SELECT count(*) FROM pg_stat_replication WHERE sync_state = 'sync'")" -lt 1 ] || return 0
    sleep 0.1
  done
  echo "the replica does not follow" >&2
  exit 1
}

case $command in
  start)
    [ "$(id -u)" -ne 0 ] || chown postgres "$folder"
    as_postgres "$programs/initdb" -D "$folder/5441" -U homing -A trust -N -k -E UTF8 --no-locale >/dev/null
    start_one 5441
    query 5441 -d postgres -c "CREATE DATABASE homing"
    add_replica 5441 5442
    echo 5441 >"$folder/primary"
    echo "postgresql://homing@/homing?host=$folder,$folder&port=5441,5442"
    ;;
  failover)
    old=$(cat "$folder/primary")
    new=$((10883 - old))
    control "$old" stop -m immediate
    control "$new" promote
    echo "$new" >"$folder/primary"
    ;;
  replica)
    primary=$(cat "$folder/primary")
    add_replica "$primary" $((10883 - primary))
    ;;
  stop)
    for port in 5441 5442; do
      [ ! -d "$folder/$port" ] || control "$port" stop -m immediate
    done
    ;;
  *) exit 2 ;;
esac
