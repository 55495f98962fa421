#!/bin/sh
# Builds Homing, records a journey through a running server, comes home along it, and shows how well it
# was recognised. Everything it makes is in quickstart/, afresh each time.
set -eu
usage() {
  cat <<'TEXT'
usage: sh deploy/quickstart.sh
       sh deploy/quickstart.sh --left DIR [--right DIR] --home-left DIR [--home-right DIR]
                               [--home-travel same|return] [--keep]
Without folders a simulated robot drives 150 m of street out and home. --left and --right are the images
of the outbound journey in order, --home-left and --home-right those of the way home; the default of
--home-travel is return (the robot heads the other way, and its cameras have changed sides).
--keep leaves the server running and prints the address of its console.
TEXT
}

left=''
right=''
home_left=''
home_right=''
travel='return'
keep=''
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --keep) keep=1; shift; continue ;;
    --left | --right | --home-left | --home-right | --home-travel)
      [ $# -ge 2 ] || { usage >&2; exit 2; } ;;
    *) echo "quickstart.sh: unknown argument '$1'" >&2; usage >&2; exit 2 ;;
  esac
  value=$2
  case $1 in
    --home-travel) ;;
    *) value=$(cd "$2" 2>/dev/null && pwd) || { echo "quickstart.sh: $1: no folder '$2'" >&2; exit 2; } ;;
  esac
  case $1 in
    --left) left=$value ;;
    --right) right=$value ;;
    --home-left) home_left=$value ;;
    --home-right) home_right=$value ;;
    --home-travel) travel=$value ;;
  esac
  shift 2
done
case $travel in same | return) ;; *) echo "quickstart.sh: --home-travel is same or return, not '$travel'" >&2; exit 2 ;; esac

out_drive=''
home_drive=''
if [ -z "$left$right$home_left$home_right" ]; then
  # The way home is one metre further from the facade that the outbound robot had on its left.
  out_drive=street,length=150,seed=1,speed=4
  home_drive=street,length=150,seed=1,speed=5,offset=-1,travel=return
  left=sim:$out_drive
  right=sim:$out_drive
  home_left=sim:$home_drive
  home_right=sim:$home_drive
elif [ -z "$left$right" ] || [ -z "$home_left$home_right" ]; then
  echo "quickstart.sh: both ways need a camera: --left or --right, and --home-left or --home-right" >&2
  exit 2
fi

cd "$(dirname "$0")/.."
start=$(date +%s)
sh deploy/install.sh build client
mkdir -p build
quietly() {
  log=build/dev-$1.log
  shift
  "$@" >"$log" 2>&1 </dev/null || { tail -n 100 "$log" >&2; exit 1; }
}
# The tests continue from this build.
[ -f build/dev/build.ninja ] || quietly configure cmake --preset dev -DHOMING_TESTS=OFF
echo "Building (log: build/dev-build.log)"
quietly build cmake --build --preset dev --target homing-server homing -j "$(nproc)"

out=quickstart
rm -rf "$out"
mkdir "$out"
server=
# shellcheck disable=SC2317 # called by the trap
finish() {
  [ -n "$server" ] || return 0
  kill "$server" 2>/dev/null || true
  wait "$server" || true
}
trap finish EXIT
trap 'exit 130' INT TERM
# shellcheck disable=SC2086 # no argument without --keep
build/dev/server/homing-server --listen 127.0.0.1:0 ${keep:+--http 127.0.0.1:0} --database "sqlite:$out/homing.db" \
  >"$out/server.log" 2>&1 </dev/null &
server=$!
address=
while [ -z "$address" ]; do
  kill -0 "$server" 2>/dev/null || { cat "$out/server.log" >&2; exit 1; }
  address=$(sed -n 's/.*listening on \([^ ]*\).*/\1/p' "$out/server.log" | head -n 1)
  [ -n "$address" ] || sleep 0.1
done
echo "Set-up took $(($(date +%s) - start)) s; homing-server listens on $address"

homing() { build/dev/client/homing --server "$address" "$@"; }
journey=robots/quickstart/journeys/out

echo "Recording the way out as $journey"
homing --json record --journey "$journey" ${left:+--left "$left"} ${right:+--right "$right"} \
  >"$out/record.json"
echo "Localising on the way home"
homing --json localize --journey "$journey" --travel "$travel" \
  ${home_left:+--left "$home_left"} ${home_right:+--right "$home_right"} >"$out/home.json"

# Two frames in the middle of the way out, for the picture of their flow.
frames=${left:-$right}
if [ -n "$out_drive" ]; then
  homing --quiet simulate --scene "$out_drive" --truth-only --out "$out/way_out" >/dev/null
  homing --quiet simulate --scene "$home_drive" --truth-only --out "$out/way_home" >/dev/null
  homing --quiet simulate --scene street,length=1,seed=1 --out "$out/glimpse" >/dev/null
  frames=$out/glimpse/left
fi
count=$(find "$frames" -maxdepth 1 -type f | wc -l)
pair=$(find "$frames" -maxdepth 1 -type f | sort -V | sed -n "$((count / 2)),$((count / 2 + 1))p" | paste -sd ,)

homing draw --journey "$journey" --out "$out/journey.png"
if [ -n "$out_drive" ]; then
  # Another street, and a robot that steers by the answers.
  homing drive --scene street,length=60,fps=10,seed=7 --journey robots/quickstart/journeys/driven --out "$out"
fi
homing draw --left "$pair" --histogram --out "$out/flow.png"
if [ -n "$out_drive" ]; then
  homing evaluate --answers "$out/home.json" --out "$out" --require 0.95 \
    --truth-out "$out/way_out/truth.csv" --truth-home "$out/way_home/truth.csv" || status=$?
else
  homing evaluate --answers "$out/home.json" --out "$out" || status=$?
fi
echo "pictures: $out/way_home.png (believed place), ${out_drive:+$out/drive.png (driven home by the answers), }$out/journey.png (the map), $out/flow.png (flow vectors and landmarks)"
if [ -n "$keep" ]; then
  console=$(sed -n 's/^console: //p' "$out/server.log" | head -n 1)
  echo "The server stays: $console shows it in a browser; \`build/dev/client/homing --server $address top\` in a terminal."
  echo "Stop it by: kill $server"
  server=
fi
exit "${status:-0}"
