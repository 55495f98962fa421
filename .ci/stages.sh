# shellcheck shell=bash disable=SC2154 # sourced by .ci/run, whose logs, jobs and scratch are meant
# The stages of .ci/run, in its order.

project_sources() { git ls-files '*.cc' '*.h'; }

stage_packages() {
  sh deploy/install.sh build client test check fuzz
  # Packages of the last stages may be missing: these stages then report it.
  sh deploy/install.sh container || echo "containers cannot be tried here"
  sh deploy/install.sh benchmark || echo "the benchmark cannot be compiled here"
  sh deploy/install.sh operations || echo "alert rules and dashboard cannot be tried here"
  sh deploy/install.sh documents || echo "the site of the documents cannot be built here"
  sh deploy/install.sh console || echo "the console cannot be tried in a browser here"
}

stage_format() { project_sources | xargs clang-format --dry-run --Werror; }

stage_shell() {
  git ls-files '*.sh' | xargs shellcheck -S warning .ci/run
}

stage_proto() {
  command -v npm >/dev/null || skip "npm is not installed, so buf cannot be fetched"
  local buf=$PWD/build/ci/buf
  mkdir -p "$buf"
  [ -x "$buf/node_modules/.bin/buf" ] ||
    npm install --prefix "$buf" --ignore-scripts --no-audit --no-fund --loglevel=error @bufbuild/buf@1 ||
    skip "buf cannot be fetched from the npm registry"
  "$buf/node_modules/.bin/buf" lint proto
}

# The manifests against the types of the Kubernetes API.
stage_manifests() {
  command -v npm >/dev/null || skip "npm is not installed, so the API's types cannot be fetched"
  command -v kubectl >/dev/null || skip "kubectl is not installed"
  local status=0
  sh tests/kubernetes/run.sh || status=$?
  [ "$status" -ne 3 ] || skip "the API's types cannot be fetched from the npm registry"
  return "$status"
}

# Files of answers, by Foxglove's own library. Uses the build of the tests.
stage_mcap() {
  command -v npm >/dev/null || skip "npm is not installed, so the library cannot be fetched"
  command -v zstd >/dev/null || skip "zstd is not installed"
  local server status=0
  server=$(built_server) || skip "no build of the server"
  sh tests/mcap/run.sh "${server%/server/homing-server}" || status=$?
  [ "$status" -ne 3 ] || skip "the library cannot be fetched from the npm registry"
  return "$status"
}

# The server that the stage of the tests built.
built_server() {
  local root
  for root in "$scratch/root/homing" "$PWD"; do
    [ ! -x "$root/build/dev/server/homing-server" ] || { echo "$root/build/dev/server/homing-server"; return; }
  done
  return 1
}

# The committed bundle is what its sources make; then the console in a browser.
stage_console() {
  command -v npm >/dev/null || skip "npm is not installed, so the console cannot be built"
  npm ci --prefix console --ignore-scripts --no-audit --no-fund --loglevel=error ||
    skip "the console's packages cannot be fetched from the npm registry"
  mkdir -p build/ci/console
  (cd console && node build.mjs ../build/ci/console)
  diff -r console/dist build/ci/console
  command -v chromium >/dev/null || skip "chromium is not installed; the bundle's bytes are right"
  HOMING_SERVER=$(built_server) || skip "no build of the server; the bundle's bytes are right"
  export HOMING_SERVER
  sh tests/console/run.sh
}

# Alert rules, and the dashboard's queries against a live server.
stage_operations() {
  command -v promtool >/dev/null || skip "prometheus is not installed"
  HOMING_SERVER=$(built_server) || skip "no build of the server"
  export HOMING_SERVER
  sh tests/operations/run.sh
}

# A Debian 12 with git only, and a clone of the last commit.
stage_bare() {
  [ "$(id -u)" -eq 0 ] || skip "a bare root needs root"
  command -v mmdebstrap >/dev/null || skip "mmdebstrap is not installed"
  unshare --mount --pid --fork true || skip "no mount namespaces here"
  sh deploy/base.sh "$scratch/base.tar"
  mkdir "$scratch/root"
  tar -xf "$scratch/base.tar" -C "$scratch/root"
  git clone -q "file://$PWD" "$scratch/root/homing"
}

in_bare_root() { DATA=${HOMING_DATA:-} sh .ci/bare_root.sh "$scratch/root" "$@"; }

# The first command of README.md; then with other images, where set-up must need no network and at most 10 s.
stage_quickstart() {
  if [ ! -d "$scratch/root/homing" ]; then
    sh deploy/quickstart.sh
    return
  fi
  in_bare_root sh /homing/deploy/quickstart.sh
  unshare --net true || skip "no network namespaces here: second run without network not tried"
  mv "$scratch/root/homing/quickstart/glimpse/left" "$scratch/root/images"
  unshare --net sh -c 'ip link set lo up && exec "$@"' sh \
    sh .ci/bare_root.sh "$scratch/root" sh /homing/deploy/quickstart.sh --left /images --home-left /images \
    --home-travel same | tee "$scratch/second.log"
  # "Set-up took N s"
  [ "$(sed -n 's/^Set-up took \([0-9]*\) s.*/\1/p' "$scratch/second.log")" -lt 10 ]
}

# The commands of the tutorial as they are written, then the site and its links.
stage_documents() {
  if [ -d "$scratch/root/homing" ]; then
    in_bare_root sh /homing/tests/documents/tutorial.sh
  else
    sh tests/documents/tutorial.sh
  fi
  command -v mkdocs >/dev/null || skip "mkdocs is not installed; the tutorial is in order"
  sh tests/documents/site.sh
}

# The second command of README.md.
stage_tests() {
  if [ -d "$scratch/root/homing" ]; then
    in_bare_root sh /homing/tests/run.sh
  else
    echo "No bare root: on this machine instead."
    sh tests/run.sh
  fi
}

stage_asan() { HOMING_PRESET=asan sh tests/run.sh; }

# Sources outside tests/, in their unity files, lock annotations included; only generated sources are built.
stage_tidy() {
  cmake --preset tidy
  cmake --build --preset tidy --target homing_proto_sources homing_foxglove_sources
  run-clang-tidy -quiet -p build/tidy -j "$jobs" -extra-arg=-Wno-unknown-warning-option -extra-arg=-Wthread-safety \
    '^(?!.*(\.pb\.cc|/homing_(proto|foxglove)\.dir/.*)$)'
}

# Each source that changed lately by itself. All of them take a processor a quarter of an hour: .ci/locks.sh
stage_locks() { .ci/locks.sh --since HEAD~25; }

# Kills, power cuts, full and failing disks: few of each. Uses the build of the tests.
stage_faults() {
  if [ -d "$scratch/root/homing" ]; then
    in_bare_root sh /homing/tests/faults/run.sh --quick
  else
    sh tests/faults/run.sh --quick
  fi
}

# Robots drive home by the answers alone: some under each condition, and two through a server. Uses the build of the
# tests.
stage_drive() {
  if [ -d "$scratch/root/homing" ]; then
    in_bare_root sh /homing/tests/drive/run.sh --quick
  else
    sh tests/drive/run.sh --quick
  fi
}

# Three servers on one PostgreSQL: few rounds of kills, pauses and promotions. Its gaps may be longer
# by half than on a machine that does nothing else. Uses the build of the tests.
stage_scale() {
  if [ -d "$scratch/root/homing" ]; then
    in_bare_root sh /homing/tests/scale/run.sh --quick --loaded
  else
    sh tests/scale/run.sh --quick --loaded
  fi
}

stage_fuzz_build() { cmake --preset fuzz && cmake --build --preset fuzz -j "$jobs"; }

stage_fuzz() { sh tests/fuzz/run.sh 15; }

stage_tsan_build() { cmake --preset tsan -DHOMING_TESTS=ON && cmake --build --preset tsan -j "$jobs"; }

stage_tsan() { HOMING_PRESET=tsan sh tests/run.sh; }

# The Debian packages of the build of the tests, in their own Debian 12.
stage_packages_deb() {
  [ "$(id -u)" -eq 0 ] || skip "a bare root needs root"
  command -v mmdebstrap >/dev/null || skip "mmdebstrap is not installed"
  if [ -x "$scratch/root/homing/build/dev/client/homing" ]; then
    in_bare_root sh /homing/tests/packages/pack.sh build/dev /homing/build/packed
    PACKED=$scratch/root/homing/build/packed BASE_TAR=$scratch/base.tar sh tests/packages/run.sh
  else
    sh tests/packages/run.sh
  fi
}

stage_image() {
  [ "$(id -u)" -eq 0 ] || skip "building images here needs root"
  command -v buildah >/dev/null || skip "buildah is not installed"
  command -v podman >/dev/null || skip "podman is not installed"
  [ ! -f "$scratch/base.tar" ] || export BASE_TAR=$scratch/base.tar
  local client=$scratch/root/homing/build/dev/client/homing
  [ ! -x "$client" ] || export CLIENT=$client
  sh deploy/image.sh
}
