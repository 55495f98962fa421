#!/bin/sh
# Makes the Debian packages of a build folder with all programs: OUT/new, OUT/old (server and client of a
# lower version, to upgrade from) and OUT/wheel.
# usage: sh tests/packages/pack.sh BUILD OUT
set -eu
cd "$(dirname "$0")/../.."
build=$1
out=$2
sh deploy/install.sh pack
mkdir -p "$out"

# pack FOLDER [CPACK OPTION...]
pack() {
  folder=$1
  shift
  cpack --config "$build/CPackConfig.cmake" -B "$folder" "$@" >"$out/cpack.log" 2>&1 ||
    { cat "$out/cpack.log" >&2; exit 1; }
  rm -rf "$folder/_CPack_Packages"
}
pack "$out/new"
pack "$out/old" -D CPACK_DEBIAN_PACKAGE_VERSION=0.0.9 -D CPACK_COMPONENTS_ALL='server;client'
mkdir -p "$out/wheel"
cp "$build"/python/wheel/dist/*.whl "$out/wheel"
