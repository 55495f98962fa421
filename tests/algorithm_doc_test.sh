#!/bin/sh
# docs/algorithm.md against the headers: every option of the method is listed once in the table of its
# struct and nothing else is; every equation has its row; every file and function it names exists.
# usage: algorithm_doc_test.sh [PROJECT_ROOT]
set -u
cd "${1:-$(dirname "$0")/..}" || exit 1
doc=docs/algorithm.md
failures=0
fail() {
  echo "$doc: $1" >&2
  failures=$((failures + 1))
}

# Members of struct $2 in header $1.
fields() {
  awk -v start="struct $2 {" '
    $0 == start { inside = 1; next }
    inside && /^};/ { exit }
    inside && !/^ *\/\// && !/[()]/ && /;/ {
      sub(/ *(=.*)?;.*$/, ""); sub(/^.* /, ""); print
    }' "$1" | sort
}

# First column of the first table after the paragraph that begins with `$1`,.
listed() {
  awk -v start="\`$1\`," '
    index($0, start) == 1 { seen = 1; next }
    seen && /^\| `/ { split($0, part, "`"); print part[2]; rows = 1; next }
    seen && rows && !/^\|/ { exit }' "$doc" | sort
}

compare() {
  expected=$(fields "$1" "$2")
  found=$(listed "$2")
  [ -n "$expected" ] || fail "no fields of $2 found in $1"
  for name in $expected; do
    echo "$found" | grep -qx "$name" || fail "$2::$name of $1 is not listed"
  done
  for name in $found; do
    echo "$expected" | grep -qx "$name" || fail "$name is listed but not in $2 of $1"
  done
  [ "$(echo "$found" | uniq -d)" = "" ] || fail "an option of $2 is listed twice"
}

compare homing/flow/flow_tracker.h FlowOptions
compare homing/landmark/landmark_options.h LandmarkOptions
compare homing/similarity/deviation_training.h TrainingOptions
compare homing/matching/matcher.h MatchOptions
compare homing/localization/position_filter.h PositionOptions
compare homing/localization/step_likelihood.h LikelihoodOptions

for equation in $(seq 1 15); do
  grep -q "^| .*($equation)[^|]*|.*\`homing/" "$doc" || fail "equation ($equation) has no row"
done

for path in $(grep -o '`[a-z_/0-9]*/[a-z_/0-9.]*`' "$doc" | tr -d '`' | sort -u); do
  [ -e "$path" ] || fail "$path does not exist"
done

# Functions of the rows "| `Function`, ... | `file` |" of the table of equations.
grep '^| (' "$doc" | while IFS='|' read -r _ _ _ functions file _; do
  path=$(echo "$file" | tr -d '` ')
  for function in $(echo "$functions" | tr -d '`,'); do
    grep -q "\b$function(" "$path" || echo "$function is not in $path"
  done
done >"${TMPDIR:-/tmp}/algorithm_doc_test.$$"
while read -r line; do fail "$line"; done <"${TMPDIR:-/tmp}/algorithm_doc_test.$$"
rm -f "${TMPDIR:-/tmp}/algorithm_doc_test.$$"

[ "$failures" -eq 0 ] && echo "$doc agrees with the headers"
exit "$failures"
