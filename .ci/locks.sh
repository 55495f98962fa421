#!/bin/bash
# Checks each product source by itself with clang's thread-safety analysis. A file that relies on
# what another one includes fails too: nothing is compiled together here.
# usage: .ci/locks.sh [PATTERN]     Only sources whose path matches the extended regular expression.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cmake --preset locks >/dev/null
cmake --build --preset locks --target homing_proto_sources homing_foxglove_sources
python3 - "${1:-.}" <<'PYTHON' | xargs -0 -P "$(nproc)" -I{} sh -c 'cd build/locks && {}'
import json, re, sys
for entry in json.load(open("build/locks/compile_commands.json")):
    if "/build/" not in entry["file"] and re.search(sys.argv[1], entry["file"]):
        command = entry["command"].replace(" -c ", " -fsyntax-only -Wthread-safety -Werror ")
        print(command, end="\0")
PYTHON
