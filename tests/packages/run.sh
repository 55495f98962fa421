#!/bin/sh
# Tries the Debian packages in a bare Debian 12: install, serve, record, localise, upgrade, remove, purge.
# usage: sh tests/packages/run.sh [BUILD]     BUILD (default build/release, built if it is missing) is a
# build folder with all programs. BASE_TAR names a tar of deploy/base.sh to start from. Needs root and
# mmdebstrap; LINTIAN=no leaves out lintian.
set -eu
cd "$(dirname "$0")/../.."
build=${1:-build/release}

if [ ! -x "$build/client/homing" ]; then
  sh deploy/install.sh build client test
  cmake --preset release >/dev/null
  cmake --build --preset release -j "$(nproc)" >build/release-build.log 2>&1 ||
    { tail -n 100 build/release-build.log >&2; exit 1; }
fi
work=$(mktemp -d "${TMPDIR:-/tmp}/homing-packages.XXXXXX")
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 130' INT TERM

# pack FOLDER [CPACK OPTION...]
pack() {
  folder=$1
  shift
  cpack --config "$build/CPackConfig.cmake" -B "$folder" "$@" >"$work/cpack.log" 2>&1 ||
    { cat "$work/cpack.log" >&2; exit 1; }
  rm -rf "$folder/_CPack_Packages"
}
pack "$work/new"
# A release before this one, to upgrade from.
pack "$work/old" -D CPACK_DEBIAN_PACKAGE_VERSION=0.0.9 -D CPACK_COMPONENTS_ALL='server;client'
for package in "$work"/new/*.deb; do
  echo "$(basename "$package"): $(stat -c %s "$package") bytes"
done

if [ "${LINTIAN:-}" != no ]; then
  sh deploy/install.sh lint
  lintian --allow-root --fail-on error "$work"/new/*.deb
fi

base=${BASE_TAR:-}
if [ -z "$base" ]; then
  sh deploy/install.sh container
  base=$work/base.tar
  sh deploy/base.sh "$base"
fi
mkdir "$work/root"
tar -xf "$base" -C "$work/root"
mkdir "$work/root/packages"
cp -r "$work/new" "$work/old" tests/packages/inside.sh examples "$work/root/packages"
mkdir "$work/root/packages/wheel"
cp "$build"/python/wheel/dist/*.whl "$work/root/packages/wheel"
sh .ci/bare_root.sh "$work/root" sh /packages/inside.sh
