#!/bin/bash
# Compiles each product source by itself with clang: a file that relies on what another one includes fails, since nothing
# is compiled together here. Locks are analysed too, as in the stage tidy. The programs that measure are compiled as well, since no
# other stage compiles them.
# usage: .ci/locks.sh [PATTERN]          Only sources whose path matches the extended regular expression.
#        .ci/locks.sh --since REVISION   Only sources that changed after it, or whose header did, and the programs that
#                                        measure; all if the revision is unknown.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
pattern=${1:-.}
if [ "$pattern" = --since ]; then
  # a/b.h and a/b.cc: both stand for a/b.cc.
  pattern=$(git diff --name-only "$2" -- '*.cc' '*.h' 2>/dev/null | sed 's/\.[a-z]*$//' | sort -u |
    sed 's|.*|/&[.]cc$|' | paste -sd '|')'|/tests/(accuracy|benchmark)/' || pattern=.
fi
cmake --preset locks >/dev/null
cmake --build --preset locks --target homing_proto_sources homing_foxglove_sources
python3 - "$pattern" <<'PYTHON' | xargs -0 -P "$(nproc)" -I{} sh -c 'cd build/locks && {}'
import json, re, sys
for entry in json.load(open("build/locks/compile_commands.json")):
    path = entry["file"]
    if re.search("/build/|/tests/(?!accuracy/|benchmark/)", path):
        continue
    if re.search(sys.argv[1].strip("|"), path):
        command = entry["command"].replace(" -c ", " -fsyntax-only -Wthread-safety -Werror ")
        print(command, end="\0")
PYTHON
