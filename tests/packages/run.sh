#!/bin/sh
# Tries the Debian packages in a bare Debian 12: install, serve, record and localise a bag of each format and a
# folder, upgrade, remove, purge; the example of libhoming, the Python package and the wheel; the service under
# systemd.
# usage: sh tests/packages/run.sh [BUILD]     BUILD (default build/release, built if it is missing) is a
# build folder with all programs. PACKED names a folder that pack.sh made, instead of it; BASE_TAR a tar
# of deploy/base.sh to start from. Needs root and mmdebstrap.
set -eu
cd "$(dirname "$0")/../.."
build=${1:-build/release}
packed=${PACKED:-}

work=$(mktemp -d "${TMPDIR:-/tmp}/homing-packages.XXXXXX")
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 130' INT TERM
if [ -z "$packed" ]; then
  if [ ! -x "$build/client/homing" ]; then
    sh deploy/install.sh build client test
    cmake --preset release >/dev/null
    cmake --build --preset release -j "$(nproc)" >build/release-build.log 2>&1 ||
      { tail -n 100 build/release-build.log >&2; exit 1; }
  fi
  packed=$work/packed
  sh tests/packages/pack.sh "$build" "$packed"
fi
for package in "$packed"/new/*.deb; do
  echo "$(basename "$package"): $(stat -c %s "$package") bytes"
done
sh deploy/install.sh lint
lintian --allow-root --fail-on error "$packed"/new/*.deb

base=${BASE_TAR:-}
if [ -z "$base" ]; then
  sh deploy/install.sh container
  base=$work/base.tar
  sh deploy/base.sh "$base"
fi
mkdir "$work/root"
tar -xf "$base" -C "$work/root"
mkdir "$work/root/packages"
cp -r "$packed/new" "$packed/old" "$packed/wheel" "$packed/drive" tests/packages/inside.sh examples "$work/root/packages"
sh .ci/bare_root.sh "$work/root" sh /packages/inside.sh
sh tests/packages/boot.sh "$work/root"
