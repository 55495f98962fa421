#!/bin/sh
# Builds the container image with buildah, without a registry, and tries it with podman: at most 120 MB,
# healthy, serves the client of this machine if one is built, SIGTERM ends it with 0. Its bill of materials
# is left in build/sbom.cdx.json. Needs root.
# BASE_TAR names a tar of deploy/base.sh to start from, IMAGE the tag, CLIENT the homing command.
set -eu
cd "$(dirname "$0")/.."
image=${IMAGE:-localhost/homing-server:latest}
base=localhost/homing-base:bookworm
client=${CLIENT:-build/dev/client/homing}

sh deploy/install.sh container
work=$(mktemp -d)
container=homing-image-$$
finish() {
  podman rm -f -v -t 0 "$container" >/dev/null 2>&1 || true
  rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' INT TERM

if ! buildah inspect --type image "$base" >/dev/null 2>&1; then
  tar=${BASE_TAR:-}
  if [ -z "$tar" ]; then
    tar=$work/base.tar
    sh deploy/base.sh "$tar"
  fi
  podman import --quiet "$tar" "$base"
fi
# Docker's format keeps the health check.
mkdir -p build
buildah bud --isolation chroot --pull-never --layers --format docker --build-arg BASE="$base" \
  -f deploy/Dockerfile -t "$image" . >build/image.log 2>&1 || { tail -n 60 build/image.log >&2; exit 1; }
size=$(podman image inspect --format '{{.Size}}' "$image")
echo "Image $size bytes"
[ "$size" -le 120000000 ] || { echo "image.sh: it must have at most 120 MB" >&2; exit 1; }

# As compose.yaml runs it, on the host's network; limits cannot be raised above this shell's own.
# shellcheck disable=SC3045 # dash has -n
files=$(ulimit -n)
podman run -d --name "$container" --runtime runc --cgroup-manager cgroupfs --network host --read-only --tmpfs /tmp \
  --cap-drop all --security-opt no-new-privileges --memory 2g \
  --ulimit "nofile=$files:$files" --ulimit nproc=1024:1024 \
  "$image" --listen 127.0.0.1:0 >"$work/podman.log" 2>&1 || { cat "$work/podman.log" >&2; exit 1; }
address=
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
  address=$(podman logs "$container" 2>&1 | sed -n 's/.*listening on \([0-9.:]*\).*/\1/p' | head -n 1)
  [ -z "$address" ] || break
  sleep 0.5
done
[ -n "$address" ] || { podman logs "$container" >&2; echo "image.sh: the server did not start" >&2; exit 1; }
podman exec "$container" /usr/bin/homing-server healthcheck --server "$address" >"$work/health.log" 2>&1 ||
  { cat "$work/health.log" >&2; exit 1; }
echo "Healthy at $address"
podman cp "$container:/usr/share/homing/sbom.cdx.json" build/sbom.cdx.json >"$work/cp.log" 2>&1 ||
  { cat "$work/cp.log" >&2; exit 1; }
parts=$(python3 -c 'import json, sys; print(len(json.load(sys.stdin)["components"]))' <build/sbom.cdx.json)
[ "$parts" -gt 50 ] || { echo "image.sh: the bill of materials has only $parts parts" >&2; exit 1; }
echo "Bill of materials: $parts parts"

if [ -x "$client" ]; then
  "$client" --server "$address" record --journey robots/image/journeys/out \
    --left sim:street,length=20 --right sim:street,length=20 --json >"$work/record.json"
  "$client" --server "$address" localize --journey robots/image/journeys/out --travel return \
    --left sim:street,length=20,travel=return --right sim:street,length=20,travel=return --json \
    >"$work/localize.json"
  grep -q '"outcome":"MATCH"' "$work/localize.json"
  echo "Recorded $(wc -l <"$work/record.json") observations, localised $(wc -l <"$work/localize.json")"
else
  echo "No client at $client: recording through the image not tried"
fi

podman stop -t 30 "$container" >/dev/null 2>&1
status=$(podman inspect --format '{{.State.ExitCode}}' "$container")
[ "$status" -eq 0 ] || { echo "image.sh: SIGTERM ended the server with $status" >&2; exit 1; }
echo "SIGTERM: exit 0"
