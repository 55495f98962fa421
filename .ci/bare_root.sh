#!/bin/sh
# Runs a command in its own root folder. The mounts live in a mount namespace that ends with the
# command, so none is left behind however it ends. Needs root.
# usage: sh .ci/bare_root.sh ROOT COMMAND...     DATA=DIR is seen inside, read-only, as /real-data
set -eu
root=$1
mkdir -p "$root/real-data"
# shellcheck disable=SC2016 # expanded by the inner shell
exec unshare --mount --pid --fork --kill-child --propagation private sh -euc '
  root=$1
  shift
  mount -t proc proc "$root/proc"
  mount --bind /dev "$root/dev"
  mount -t tmpfs tmpfs "$root/dev/shm"
  data=
  if [ -n "${DATA:-}" ]; then
    mount --bind "$DATA" "$root/real-data"
    mount -o remount,ro,bind "$root/real-data"
    data=HOMING_DATA=/real-data
  fi
  exec chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} $data "$@"
' sh "$@" </dev/null
