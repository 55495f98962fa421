#!/bin/sh
# Copies a program with every shared library it links, and a user to run it, into its own root folder.
# usage: sh deploy/closure.sh PROGRAM ROOT
set -eu
program=$1
root=$2

mkdir -p "$root/usr/bin" "$root/etc" "$root/tmp"
chmod 1777 "$root/tmp"
# bookworm has /lib and /lib64 as links into /usr; the program names its loader by the short path.
ln -s usr/lib "$root/lib"
ln -s usr/lib64 "$root/lib64"
install -m 755 -s "$program" "$root/usr/bin/"

ldd "$program" | grep -o '/[^ ]*' | sort -u | while read -r library; do
  case $library in
    /usr/*) ;;
    *) library=/usr$library ;;
  esac
  mkdir -p "$root$(dirname "$library")"
  cp -L "$library" "$root$library"
done
echo 'homing:x:10001:10001:homing:/data:/nonexistent' >"$root/etc/passwd"
echo 'homing:x:10001:' >"$root/etc/group"
