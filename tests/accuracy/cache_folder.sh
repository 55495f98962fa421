#!/bin/sh
# Makes and prints the folder that keeps the flow of all drives, for homing_accuracy --cache. It is another one
# whenever what makes the flow has changed.
# usage: tests/accuracy/cache_folder.sh
set -eu
cd "$(dirname "$0")/../.."
key=$(cat homing/flow/*.* homing/image/*.* client/simulator/*.* tests/accuracy/drive.* tests/accuracy/drive_cache.* tests/accuracy/real_runs.cc \
  tests/accuracy/simulated_runs.cc | sha256sum | cut -c 1-16)
mkdir -p "build/accuracy-cache/$key"
echo "build/accuracy-cache/$key"
