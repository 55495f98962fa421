#!/bin/sh
# The manifests of deploy/kubernetes against the types of the Kubernetes API. Needs kubectl, npm and the npm registry; a
# line a folder, exit code 1 if one is wrong, 3 if the registry is not reached.
# usage: sh tests/kubernetes/run.sh
set -eu
cd "$(dirname "$0")/../.."
work=build/kubernetes
mkdir -p "$work"
cp tests/kubernetes/package.json tests/kubernetes/package-lock.json tests/kubernetes/typed.mjs "$work"
npm ci --prefix "$work" --ignore-scripts --no-audit --no-fund --loglevel=error || exit 3
status=0
compile() { (cd "$work" && node_modules/.bin/tsc --noEmit --strict --skipLibCheck --module nodenext --target es2022 "$1.ts"); }
for folder in base postgres; do
  kubectl kustomize "deploy/kubernetes/$folder" | (cd "$work" && node typed.mjs) >"$work/$folder.ts"
  if compile "$folder"; then echo "kubernetes/$folder: in order"; else echo "kubernetes/$folder: FAILED"; status=1; fi
done
# The check itself: a misspelt field is found.
sed 's/"livenessProbe"/"livenesProbe"/' "$work/base.ts" >"$work/misspelt.ts"
if compile misspelt >/dev/null; then echo "kubernetes: a misspelt field is not found"; status=1; fi
exit "$status"
