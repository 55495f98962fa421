#!/bin/sh
# Fuzzes each target for SECONDS (default 30), from the inputs kept in corpus/, with AddressSanitizer,
# LeakSanitizer and UndefinedBehaviorSanitizer. A line each: name executions ok|short; exit code 1 if any
# is short. An input that breaks something is left in build/fuzz/findings/.
# usage: sh tests/fuzz/run.sh [SECONDS [TARGET...]]
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:-30}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- image flow import database config request
mkdir -p build
log=build/fuzz-build.log
{
  sh deploy/install.sh build fuzz
  cmake --preset fuzz
  cmake --build --preset fuzz -j "$(nproc)"
} >"$log" 2>&1 </dev/null || { tail -n 100 "$log" >&2; exit 1; }
findings=build/fuzz/findings
mkdir -p "$findings"
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0 UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$PWD/.ci/lsan.supp:print_suppressions=0"
status=0
for target; do
  found=build/fuzz/corpus/$target
  mkdir -p "$found"
  # No input is longer than a message or takes longer than 25 s, and no process more than 2 GiB.
  if "build/fuzz/tests/fuzz/${target}_fuzz" "$found" "tests/fuzz/corpus/$target" \
    -max_total_time="$seconds" -max_len=65536 -timeout=25 -rss_limit_mb=2048 -malloc_limit_mb=512 \
    -artifact_prefix="$findings/$target-" -print_final_stats=1 >"build/fuzz/$target.log" 2>&1; then
    result=ok
  else
    result=short
    status=1
    grep -aE 'ERROR|SUMMARY|runtime error|artifact_prefix|Test unit written' "build/fuzz/$target.log" >&2 || true
  fi
  echo "fuzz_$target $(sed -n 's/^stat::number_of_executed_units: *//p' "build/fuzz/$target.log") $result"
done
exit $status
