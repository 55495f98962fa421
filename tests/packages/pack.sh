#!/bin/sh
# Makes the Debian packages of a build folder with all programs: OUT/new, OUT/old (server and client of a
# lower version, to upgrade from) and OUT/wheel; and OUT/drive, what a robot recorded out and home: folders, and
# bags of every format, with raw images out and compressed ones home.
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

rm -rf "$out/drive"
"$build/client/homing" --quiet simulate --scene street,length=12,seed=1 --out "$out/drive/out" >"$out/simulate.log"
"$build/client/homing" --quiet simulate --scene street,length=12,seed=1,travel=return,offset=-1 --out "$out/drive/home" \
  >>"$out/simulate.log"
/usr/bin/python3 tests/support/make_bags.py "$out/drive/out" "$out/drive/out/bags"
/usr/bin/python3 tests/support/make_bags.py --png "$out/drive/home" "$out/drive/home/bags"
