#!/bin/sh
# Makes a minimal Debian 12 as a tar file, without a registry: the bare root of .ci/run and, imported,
# the debian:bookworm-slim that the Dockerfile starts from. Needs root and mmdebstrap.
# usage: sh deploy/base.sh OUT.tar
set -eu
out=$1
sources=/etc/apt/sources.list.d/debian.sources
if [ -r "$sources" ]; then
  set -- - # The machine's own mirror, as deb822 on stdin.
else
  sources=/dev/null
  set -- 'deb http://deb.debian.org/debian bookworm main' \
    'deb http://deb.debian.org/debian bookworm-updates main' \
    'deb http://deb.debian.org/debian-security bookworm-security main'
fi
# The hook keeps downloaded packages out of the image's layers.
# shellcheck disable=SC2016 # $1 is expanded by the hook's own shell
mmdebstrap --quiet --variant=minbase --include=git,ca-certificates \
  --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-exclude=/usr/share/man/*' \
  --dpkgopt='path-exclude=/usr/share/locale/*' --aptopt='Acquire::Languages "none"' \
  --customize-hook='echo "DPkg::Post-Invoke { \"rm -f /var/cache/apt/archives/*.deb || true\"; };" \
    >"$1/etc/apt/apt.conf.d/docker-clean"' \
  bookworm "$out" "$@" <"$sources"
