#!/bin/sh
# Builds the site of the documents in build/site; fails on a link or an anchor that is broken.
# usage: sh tests/documents/site.sh
set -eu
cd "$(dirname "$0")/../.."
command -v mkdocs >/dev/null || { echo "site.sh: sh deploy/install.sh documents" >&2; exit 2; }
mkdocs build --quiet --strict
# It runs as another user, for whom the folder need not be readable.
site=$(mktemp -d)
trap 'rm -rf "$site"' EXIT
chmod 755 "$site"
cp -R build/site/. "$site"
cat >"$site/linkchecker.ini" <<'INI'
[filtering]
ignorewarnings=file-missing-slash
[AnchorCheck]
INI
linkchecker -f "$site/linkchecker.ini" --no-status "$site/index.html"
