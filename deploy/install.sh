#!/bin/sh
# Installs the Debian packages of the named sets of packages.txt (no set: build, client, test).
# Fetches only missing packages, so that a second run needs no network.
set -eu
list=$(dirname "$0")/packages.txt
[ $# -gt 0 ] || set -- build client test

missing=
for set in "$@"; do
  packages=$(sed -n "s/^$set //p" "$list")
  [ -n "$packages" ] || { echo "install.sh: no set '$set' in $list" >&2; exit 2; }
  for package in $packages; do
    case $(dpkg-query -W -f '${Status}' "$package" 2>/dev/null) in
      *' installed') ;;
      *) missing="$missing $package" ;;
    esac
  done
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install.sh: run as root, or install:$missing" >&2; exit 1; }
  as_root=sudo
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600 "$@" \
    >"$log" 2>&1 </dev/null || { cat "$log" >&2; exit 1; }
}
echo "Installing:$missing"
apt update
# shellcheck disable=SC2086 # one word a package
apt install -y --no-install-recommends $missing
