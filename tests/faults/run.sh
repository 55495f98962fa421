#!/bin/sh
# The faults that the server must survive, a line each: name figure bound ok|short. Exit code 1 if any is short.
# usage: sh tests/faults/run.sh [--quick] [--soak MINUTES] [--only kill|power|full|bad|lost|sockets|memory|leaks|soak] [--seed N]
# Fuzzing has lines of the same form: sh tests/fuzz/run.sh.
# HOMING_PRESET (default dev) names the CMake preset. As root the full disk is a real one, of 24 MiB.
set -eu
cd "$(dirname "$0")/../.."
preset=${HOMING_PRESET:-dev}
mkdir -p build
log=build/$preset-faults.log
{
  sh deploy/install.sh build client test
  cmake --preset "$preset" -DHOMING_TESTS=ON
  cmake --build --preset "$preset" -j "$(nproc)" --target homing-server homing_faults faulty_disk server_test
} >"$log" 2>&1 </dev/null || { tail -n 100 "$log" >&2; exit 1; }
build=build/$preset
set -- "$build/tests/faults/homing_faults" "$PWD/$build/server/homing-server" \
  "$PWD/$build/tests/faults/libfaulty_disk.so" "$@"
if command -v valgrind >/dev/null; then
  set -- "$@" --valgrind
else
  echo "# valgrind is not installed: leaks are not looked for"
fi
# Syncs to a file system in memory return at once, so that more runs fit into a minute. The faulty disk
# decides which data a power cut leaves.
[ -n "${TMPDIR:-}" ] || [ ! -w /dev/shm ] || export TMPDIR=/dev/shm
status=0
if command -v systemd-analyze >/dev/null; then
  exposure=$(systemd-analyze security --offline=true --no-pager deploy/homing-server.service 2>/dev/null |
    sed -n 's/.*Overall exposure level[^:]*: \([0-9.]*\) .*/\1/p')
  verdict=$(awk -v e="${exposure:-10}" 'BEGIN { print e <= 2.0 ? "ok" : "short" }')
  echo "systemd_exposure ${exposure:-unknown} <=2.0 $verdict"
  [ "$verdict" = ok ] || status=1
fi
# Access: role x method x owner, and callers with bad certificates or none.
case " $* " in
  *' --only '*) ;;
  *)
    "$build/tests/server/server_test" --gtest_filter='*AccessTableTest*:TlsTest*' >"build/$preset-roles.log" 2>&1 ||
      tail -n 50 "build/$preset-roles.log" >&2
    tests=$(grep -c '^\[       OK \]' "build/$preset-roles.log" || true)
    asked=$(sed -n 's/^\[==========\] Running \([0-9]*\) tests.*/\1/p' "build/$preset-roles.log")
    verdict=$([ "$tests" -gt 0 ] && [ "$tests" -eq "${asked:-0}" ] && echo ok || echo short)
    echo "roles_and_refusals $tests >=${asked:-1} $verdict"
    [ "$verdict" = ok ] || status=1
    ;;
esac
if [ "$(id -u)" -eq 0 ] && unshare --mount true 2>/dev/null; then
  small=$(mktemp -d)
  trap 'rmdir "$small"' EXIT
  # The mount ends with the command.
  # shellcheck disable=SC2016 # expanded by the inner shell
  unshare --mount --propagation private sh -euc '
    small=$1
    shift
    mount -t tmpfs -o size=24m tmpfs "$small"
    "$@" --small-disk "$small"' sh "$small" "$@" || status=$?
else
  "$@" || status=$?
fi
exit "$status"
