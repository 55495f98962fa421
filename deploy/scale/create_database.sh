#!/bin/sh
# Called by Patroni once, on the first leader, with the URL of its superuser: the role and the database of homing-server.
set -eu
psql -X -q -v ON_ERROR_STOP=1 -v password="$HOMING_DB_PASSWORD" "$1" <<'SQL'
CREATE ROLE homing LOGIN PASSWORD :'password';
CREATE DATABASE homing OWNER homing ENCODING 'UTF8' TEMPLATE template0;
SQL
