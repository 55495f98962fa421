#!/bin/sh
# Fuzzes each target for SECONDS (default 30), one a core at a time, from the inputs kept in corpus/, with
# AddressSanitizer, LeakSanitizer and UndefinedBehaviorSanitizer. A line each: name executions ok|short; exit
# code 1 if any is short. An input that breaks something is left in build/fuzz/findings/. The target video,
# mostly FFmpeg, runs only where it is named.
# usage: sh tests/fuzz/run.sh [SECONDS [TARGET...]]
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:-30}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- image bag calibration list flow import database config request
mkdir -p build
log=build/fuzz-build.log
{
  sh deploy/install.sh build client fuzz
  cmake --preset fuzz
  cmake --build --preset fuzz -j "$(nproc)"
} >"$log" 2>&1 </dev/null || { tail -n 100 "$log" >&2; exit 1; }
mkdir -p build/fuzz/findings
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0 UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$PWD/.ci/lsan.supp:print_suppressions=0"
# No input is longer than a message or takes longer than 25 s, and no process more than 2 GiB.
# shellcheck disable=SC2016 # expanded by the inner shell
printf '%s\n' "$@" | xargs -P "$(nproc)" -n 1 sh -euc '
  seconds=$1
  target=$2
  log=build/fuzz/$target.log
  mkdir -p "build/fuzz/corpus/$target"
  result=ok
  "build/fuzz/tests/fuzz/${target}_fuzz" "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target" \
    -max_total_time="$seconds" -max_len=65536 -timeout=25 -rss_limit_mb=2048 -malloc_limit_mb=512 \
    -artifact_prefix="build/fuzz/findings/$target-" -print_final_stats=1 >"$log" 2>&1 || result=short
  echo "fuzz_$target $(sed -n "s/^stat::number_of_executed_units: *//p" "$log") $result"
  [ "$result" = ok ] ||
    { grep -aE "^==.*ERROR|SUMMARY|runtime error|artifact_prefix|Test unit written" "$log" >&2; exit 1; }' sh "$seconds"
