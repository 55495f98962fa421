#!/bin/sh
# Prints the parts of a program as a bill of materials (CycloneDX 1.5, JSON): the Debian packages of the
# libraries that it links and of the headers that its build read, and the packages of the console's bundle.
# usage: sh deploy/sbom.sh PROGRAM BUILD      BUILD: the program's build folder, by Ninja.
set -eu
program=$1
build=$2
cd "$(dirname "$0")/.."
files=$(mktemp)
trap 'rm -f "$files"' EXIT

{ ldd "$program"; ninja -C "$build" -t deps; } | grep -o '/[^ ]*' | sort -u >"$files"
# Of alternatives (LAPACK), the file that the link leads to belongs to a package.
ldd "$program" | grep -o '/[^ ]*' | xargs readlink -f >>"$files"
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:[A-Z]*=//p' "$build/CMakeCache.txt")
{
  # Packages list some files below /usr and some below its links in the root.
  awk 'NR == FNR { want[$0]; sub("^/usr", ""); want[$0]; want["/usr" $0]; next }
    $0 in want { name = FILENAME; gsub(".*/|[.]list$", "", name); print name; nextfile }' \
    "$files" /var/lib/dpkg/info/*.list | sort -u |
    xargs dpkg-query -W -f '${Package} ${Version} deb/debian ?arch=${Architecture}&distro=debian-12\n'
  sed -n '/"dependencies"/s/["{},:]/ /gp' console/package.json |
    awk '{ for (i = 2; i < NF; i += 2) print $i, $(i + 1), "npm" }'
} | awk -v name="$(basename "$program")" -v version="$version" '
  BEGIN {
    printf "{\"bomFormat\": \"CycloneDX\", \"specVersion\": \"1.5\", \"version\": 1,\n\"metadata\": {\"component\":"
    printf " {\"type\": \"application\", \"bom-ref\": \"%s\", \"name\": \"%s\", \"version\": \"%s\"}},\n\"components\": [", name, name, version
  }
  {
    purl = $1 "@" $2
    gsub("[+]", "%2B", purl)
    gsub(":", "%3A", purl)
    purl = "pkg:" $3 "/" purl $4
    printf "%s\n{\"type\": \"library\", \"bom-ref\": \"%s\", \"name\": \"%s\", \"version\": \"%s\", \"purl\": \"%s\"}", (NR > 1 ? "," : ""), purl, $1, $2, purl
  }
  END { print "\n]}" }'
