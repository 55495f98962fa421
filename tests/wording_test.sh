#!/bin/sh
# Exact phrases that make a sentence hard to read, and the words of our own for which the field has a
# standard term. Single common words are not listed.
#   wording_test.sh ROOT
set -u
cd "${1:-.}" || exit 2
failed=0

# One phrase a line, as fgrep takes it.
phrases='Source: own design
let go of
lets go of
are told of
is told of
who tells of
is told about
of its own making
waits until nothing of it is on its way
on its way to the disk
as long as it is heard of
is taken in
takes the queue in
What is due
which is due
whom it is
who they are
who it is that
what is there already
what there is to
is good no more
good any more
Not the first of a burst
what it goes on from
What recording goes on from
what was read before stays in force
wants nothing more
nobody is asked
what came of
has been through
what is seen of
goes on from
what was acknowledged stays'

files=$(git ls-files server storage proto client homing tests deploy README.md SECURITY.md CONTRIBUTING.md docs |
  grep -v '^tests/wording_test.sh')
# shellcheck disable=SC2086
found=$(echo "$phrases" | grep -nFi -f - $files)
if [ -n "$found" ]; then
  echo "$found" | sed 's/^/wording: /'
  failed=1
fi

# Lines of the documents that are too long to read, tables, links and code apart.
long=$(awk 'FNR == 1 { code = 0 } /^```/ { code = !code }
  !code && length($0) > 100 && !/^\|/ && !/\]\(/ && !/^    / { print FILENAME ":" FNR ": " length($0) " columns" }' \
  ./*.md docs/*.md docs/decisions/*.md)
[ -z "$long" ] || { echo "$long"; failed=1; }

# Lists that begin right after a line of text: the site shows them as part of that line.
lists=$(awk 'FNR == 1 { code = 0; before = "" } /^```/ { code = !code }
  !code && /^(- |1\. )/ && before != "" && before !~ /^( |- |[0-9]+\. )/ {
    print FILENAME ":" FNR ": a list needs an empty line before it"
  }
  { before = $0 }' ./*.md docs/*.md docs/decisions/*.md)
[ -z "$lists" ] || { echo "$lists"; failed=1; }

[ "$failed" -ne 0 ] || echo "wording: in order"
exit "$failed"
