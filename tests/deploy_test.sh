#!/bin/sh
# The files of deploy/ that other programs read, as far as those programs are installed.
#   deploy_test.sh ROOT
set -u
cd "${1:-.}" || exit 2
failed=0
scratch=$(mktemp -d) || exit 2
trap 'rm -rf "$scratch"' EXIT

report() { # report WHAT STATUS
  if [ "$2" -eq 0 ]; then echo "deploy: $1: in order"; else echo "deploy: $1: FAILED"; failed=1; fi
}

if command -v kubectl >/dev/null; then
  for overlay in base postgres; do
    kubectl kustomize "deploy/kubernetes/$overlay" >"$scratch/$overlay.yaml" &&
      grep -q 'kind: Service' "$scratch/$overlay.yaml"
    report "kubernetes/$overlay" $?
  done
  # The overlay replaces the one server with several.
  if grep -q 'kind: StatefulSet' "$scratch/postgres.yaml"; then report "kubernetes/postgres has no StatefulSet" 1; fi
else
  echo "deploy: SKIPPED kubernetes: kubectl is not installed"
fi

if command -v docker-compose >/dev/null; then
  for file in deploy/compose.yaml deploy/scale/compose.yaml; do
    HOMING_DB_PASSWORD=secret docker-compose -f "$file" config -q
    report "$file" $?
  done
else
  echo "deploy: SKIPPED compose: docker-compose is not installed"
fi

if command -v nginx >/dev/null; then
  sed 's/homing-[0-9]:50551/127.0.0.1:50551/; s/listen 50551 /listen 127.0.0.1:50999 /; s|/tmp/|'"$scratch"'/|; s|/dev/stderr|stderr|' \
    deploy/scale/nginx.conf >"$scratch/nginx.conf"
  nginx -t -q -c "$scratch/nginx.conf"
  report "scale/nginx.conf" $?
else
  echo "deploy: SKIPPED nginx: it is not installed"
fi
exit "$failed"
