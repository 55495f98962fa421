#!/bin/sh
# Dependencies between folders, forbidden contents, the length of files and functions, the sources in a folder. Debian keeps the
# headers of gRPC, SQLite and OpenCV in /usr/include, so that a wrong include compiles: this test forbids it.
#   layering_test.sh [ROOT]        checks the tree
#   layering_test.sh --self-test   plants one violation of each rule in a scratch tree and expects it to be found
set -u

max_lines=300
max_function=60
max_median=10
max_sources=25

# The includes allowed to one folder's files, without its subfolders: "FOLDER ALLOWED...". An allowed name that ends in a slash is
# the beginning of an include, another one a folder without its subfolders. Each folder has a rule.
below_landmark='homing/flow homing/image homing/base'
below_journey="homing/similarity homing/landmark $below_landmark"
below_matching="homing/journey $below_journey"
messages='proto/wire homing/v1'
gates='server/fleet server/access server/admission server/metrics'
kept="server/base storage homing/"
rules="
homing/base         homing/base
homing/image        homing/image homing/base
homing/flow         homing/flow homing/image homing/base
homing/landmark     homing/landmark $below_landmark
homing/similarity   homing/similarity homing/landmark $below_landmark
homing/journey      homing/journey $below_journey
homing/matching     homing/matching $below_matching
homing/profile      homing/profile $below_matching
homing/localization homing/localization homing/matching homing/profile $below_matching
cli                 cli
storage             storage homing/
storage/postgres    storage/postgres storage homing/
proto/wire          $messages homing/
server/process      server/process
server/base         server/base homing/base
server/catalog      server/catalog $kept
server/access       server/access server/catalog $kept
server/admission    server/admission server/catalog $kept
server/metrics      server/metrics server/access $kept
server/fleet        server/fleet homing/base homing/v1
server/session      server/session server/catalog $kept
server/rpc          server/rpc server/session $gates server/catalog $kept $messages google/rpc
server/service      server/service server/rpc server/session $gates server/catalog $kept $messages google/rpc
server/http         server/http server/rpc server/session $gates server/catalog $kept $messages
server/config       server/config cli server/access server/admission $kept grpc/health/
server              server/ storage homing/ $messages google/rpc grpc/health/
client/simulator    client/simulator homing/flow homing/image homing/base
client/file         client/file
client/pilot        client/pilot
client/drive        client/drive client/pilot client/simulator homing/flow homing/image homing/base
client/picture      client/picture client/file $below_journey homing/
client/source       client/source client/bag client/simulator homing/flow homing/image homing/base
client/opencv       client/opencv client/source homing/image homing/base
client/bag          client/bag client/source homing/flow homing/image homing/base
client              client cli client/source client/pilot client/bag client/file client/simulator client/command homing/ $messages google/rpc grpc/health/
client/command      client/command cli client/drive client/pilot client/bag client/file client/picture client/simulator client/source client server/process homing/ $messages
client/robot        client/robot client homing/client homing/base homing/v1
client/robot/include/homing/client homing/client
client/bench        client/bench cli client/command client/simulator client/source client server/process homing/ $messages
"
# Folders where generated code, gRPC and Protobuf may not be seen.
no_network='homing storage cli client/simulator client/source server/base server/catalog server/access server/admission server/session
  server/process'

fail() { echo "layering: $*"; failed=1; }

sources() { find "$@" -name build -prune -o \( -name '*.h' -o -name '*.cc' \) -print 2>/dev/null; }

# Lines "FILE:INCLUDED" of the project's own includes; those of one folder, not of its subfolders.
includes_of() {
  find "$1" -maxdepth 1 \( -name '*.h' -o -name '*.cc' \) -exec \
    sed -n 's|^ *# *include *"\([^"]*\)".*|\1|p;' {} + 2>/dev/null | sort -u
}

check_directions() {
  echo "$rules" | while read -r folder allowed; do
    [ -d "${folder:-/nowhere}" ] || continue
    includes_of "$folder" | while read -r included; do
      ok=
      for name in $allowed; do
        case $name in
          homing/) case $included in homing/v1/*) ;; homing/*/*) ok=1 ;; esac ;;
          */) case $included in "$name"*) ok=1 ;; esac ;;
          *) [ "${included%/*}" != "$name" ] || ok=1 ;;
        esac
      done
      # Third-party headers in quotes: absl and the like.
      case $included in absl/* | fmt/* | spdlog/*) ok=1 ;; esac
      [ -n "$ok" ] || echo "$folder may not include $included"
    done
  done
  sources homing storage proto cli server client | sed 's|/[^/]*$||' | sort -u | while read -r folder; do
    echo "$rules" | grep -q "^$folder " || echo "$folder has no rule"
  done
}

# forbid WHAT PATTERN FILES...: no line of the files, comments apart, may match.
forbid() {
  what=$1 pattern=$2
  shift 2
  [ $# -gt 0 ] || return 0
  what=$what pattern=$pattern awk '
    { sub(/\/\/.*/, "") }
    $0 ~ ENVIRON["pattern"] { print FILENAME ":" FNR ":" $0 "   [" ENVIRON["what"] "]" }' "$@"
}

check_contents() {
  # shellcheck disable=SC2046,SC2086
  {
    forbid 'cv:: in a header outside image, flow and client' '(^|[^_[:alnum:]])cv::|opencv2/' \
      $(sources homing storage server proto | grep '\.h$' | grep -vE '^homing/(image|flow)/')
    forbid 'OpenCV in a folder that does not use images' 'opencv2/' $(sources storage proto)
    forbid 'gRPC or Protobuf where no network may be' 'grpc|google/protobuf|\.pb\.h' $(sources $no_network)
    forbid 'SQLite outside storage' 'include *[<"](sqlite3|SQLiteCpp)' \
      $(sources homing server proto cli client tests | grep -vE '^(tests/(storage|benchmark)|client/(bag|robot))/')
    forbid 'PostgreSQL outside storage' 'include *[<"]libpq' \
      $(sources homing server proto cli client tests storage | grep -vE '^(storage/postgres|tests/storage)/')
    forbid '.value() outside tests' '\.value\(\)' $(sources homing storage server proto cli client)
    forbid 'CHECK outside tests and main' '(^|[^_[:alnum:]])D?CHECK(_[A-Z]+)?\(|(^|[^_[:alnum:]])(abort|assert)\(' \
      $(sources homing storage server proto cli client | grep -v '/main\.cc$')
    # Shared with storage, server and client, and closed to the method.
    pure=$(sources homing | grep -vE '^homing/base/(mutex|file_text)\.h$')
    # Robots of several threads share a map, and what was measured on it.
    threadless=$(echo "$pure" | grep -v '^homing/journey/measured_route\.h$')
    forbid 'a clock, chance, a file or a log in homing' \
      'std::chrono|random_device|(^|[^_[:alnum:]])rand\(|fstream|fopen|std::(cout|cerr)|spdlog' $pure
    forbid 'a lock or a file in the method' 'homing/base/(mutex|file_text)\.h' $(sources homing)
    # ThreadSanitizer's suite goes by this: see tests/CMakeLists.txt.
    forbid 'a thread or a lock in what knows none' \
      'std::(j?thread|async|(shared_|recursive_)?mutex|atomic|condition_variable|call_once|latch|barrier)|absl::Mutex|parallel_for_' \
      $threadless $(sources client/simulator tests/homing tests/client/simulator)
  }
}

check_names() {
  sources homing storage server proto cli client | grep -E '/[a-z_]*(util|common|helper|manager|misc|impl)[a-z_]*\.(h|cc)$' |
    sed 's/$/   [a name that says nothing]/'
}

check_lengths() {
  sources homing storage server proto cli client tests | xargs awk -v most="$max_lines" '
    FNR == most + 1 { print FILENAME " has more than " most " lines" }'
}

# Functions at the left edge of sources, as clang-format puts them: from the name to the brace that ends them.
function_lengths() {
  sources homing storage server proto cli client | grep '\.cc$' | xargs -r awk '
    FNR == 1 { start = inside = 0 }
    !inside && /^[A-Za-z_]/ { start = FNR; head = $0 }
    !inside && start && /[{}]$/ && head ~ /\(/ && head !~ /^(class|struct|enum|union|namespace|using) / { inside = 1 }
    inside && /(^}|^[A-Za-z_].*})$/ { print FNR - start + 1, FILENAME ":" start; inside = start = 0 }' | sort -n
}

check_functions() {
  function_lengths | awk -v most="$max_function" -v most_median="$max_median" '
    $1 > most { print $2 " begins a function of " $1 " lines" }
    { length_of[NR] = $1 }
    END { if (NR > 1 && length_of[int((NR + 1) / 2)] > most_median) print "the median function is too long" }'
}

# Sources in one folder, without its subfolders.
check_sizes() {
  sources homing storage server proto cli client tests | sed -n 's|/[^/]*\.cc$||p' | sort | uniq -c |
    awk -v most="$max_sources" '$1 > most { print $2 " has more than " most " sources" }'
}

check_tree() {
  cd "$1" || exit 2
  failed=0
  [ -n "$(sources homing)" ] || fail "no sources in $1"
  found=$(check_directions; check_contents; check_names; check_lengths; check_functions; check_sizes)
  [ -z "$found" ] || { echo "$found" | sed 's/^/layering: /'; failed=1; }
  return $failed
}

# A scratch tree in which nothing is wrong.
clean_tree() {
  rm -rf "$scratch/tree" && mkdir -p "$scratch/tree/homing/image"
  echo '#include "homing/base/status_macros.h"' >"$scratch/tree/homing/image/frame.h"
}

# plant FILE TEXT: a clean scratch tree with this one file added must fail the check.
plant() {
  clean_tree
  mkdir -p "$scratch/tree/$(dirname "$1")"
  printf '%b\n' "$2" >"$scratch/tree/$1"
  if (check_tree "$scratch/tree") >/dev/null; then
    echo "self-test: not found: $1: $2"
    planted_bad=1
  fi
}

self_test() {
  scratch=$(mktemp -d) || exit 2
  trap 'rm -rf "$scratch"' EXIT
  planted_bad=0
  clean_tree
  (check_tree "$scratch/tree") >/dev/null || { echo "self-test: the clean tree fails"; planted_bad=1; }
  plant homing/image/a.cc '#include "homing/flow/camera.h"'
  plant homing/flow/a.h '#include "homing/journey/journey_map.h"'
  plant homing/base/a.h '#include "homing/image/frame.h"'
  plant homing/journey/a.cc '#include "homing/matching/matcher.h"'
  plant homing/matching/a.h '#include "homing/profile/profile_distance.h"'
  plant homing/matching/a.h '#include "homing/localization/localizer.h"'
  plant homing/profile/a.h '#include "homing/matching/matcher.h"'
  plant homing/profile/a.cc '#include "homing/localization/route_belief.h"'
  plant homing/elsewhere/a.cc 'int x;'
  plant homing/journey/a.cc '#include "storage/journey_store.h"'
  plant homing/journey/a.cc '#include "homing/v1/types.pb.h"'
  plant homing/journey/a.cc '#include <grpcpp/grpcpp.h>'
  plant homing/landmark/a.h '#include <opencv2/core.hpp>'
  plant homing/landmark/a.h 'void Draw(const cv::Mat& image);'
  plant homing/flow/a.cc 'auto now = std::chrono::steady_clock::now();'
  plant homing/journey/a.cc 'std::atomic<int> count;'
  plant homing/journey/a.cc '#include "homing/base/mutex.h"'
  plant tests/homing/a.cc 'std::jthread other([] {});'
  plant homing/flow/a.cc 'cv::parallel_for_(range, body);'
  plant storage/a.cc '#include "server/service/journey_archive.h"'
  plant storage/a.cc '#include <google/protobuf/message.h>'
  plant storage/a.cc 'int x = *result.value();'
  plant storage/a.cc 'CHECK(ok);'
  plant storage/a.cc '#include <opencv2/core.hpp>'
  plant server/a.cc '#include <sqlite3.h>'
  plant server/a.cc '#include <libpq-fe.h>'
  plant storage/a.cc '#include <libpq-fe.h>'
  plant storage/a.cc '#include "storage/postgres/pg_connection.h"'
  plant server/a.cc '#include "client/source/frame_source.h"'
  plant server/base/a.h '#include "homing/journey/journey_map.h"'
  plant server/base/a.cc '#include "server/rpc/status_conversion.h"'
  plant server/process/a.h '#include "server/base/worker_pool.h"'
  plant server/catalog/a.h '#include "server/session/recording_session.h"'
  plant server/catalog/a.cc '#include "server/access/role.h"'
  plant server/metrics/a.cc '#include "server/rpc/service_core.h"'
  plant server/session/a.h '#include "server/metrics/metrics.h"'
  plant server/rpc/a.h '#include "server/service/message_conversion.h"'
  plant server/rpc/a.h '#include "server/config/server_options.h"'
  plant server/service/a.h '#include "server/config/server_options.h"'
  plant server/config/a.cc '#include "server/rpc/unary_call.h"'
  plant server/config/a.cc '#include "server/homing_server.h"'
  plant server/session/a.cc '#include "homing/v1/types.pb.h"'
  plant server/session/a.h '#include "server/service/journey_archive.h"'
  plant server/access/a.cc '#include "server/rpc/unary_call.h"'
  plant server/access/a.cc '#include <grpcpp/grpcpp.h>'
  plant server/admission/a.h '#include "server/access/role.h"'
  plant client/a.cc '#include "server/service/journey_archive.h"'
  plant client/a.cc '#include "storage/journey_store.h"'
  plant client/a.cc '#include "client/bench/load_run.h"'
  plant client/command/a.cc '#include "client/bench/load_run.h"'
  plant client/command/a.cc '#include "server/base/worker_pool.h"'
  plant client/picture/a.cc '#include "client/connection.h"'
  plant client/source/a.cc '#include "client/connection.h"'
  plant client/simulator/a.cc '#include "homing/journey/journey_map.h"'
  plant proto/wire/a.cc '#include "server/service/journey_archive.h"'
  plant cli/a.cc '#include "client/connection.h"'
  plant homing/flow/string_util.cc 'int x;'
  plant tests/a.cc "$(yes 'int x;\n' | head -400 | tr -d '\n')"
  plant homing/flow/a.cc "void Long() {\n$(yes '  Work();\n' | head -60 | tr -d '\n')}"
  plant homing/flow/a.cc "$(printf 'void Work%s() {\\n\\n\\n\\n\\n\\n\\n\\n\\n\\n}\\n' 1 2 3)"
  max_sources=0
  plant homing/flow/a.cc 'int x;'
  [ $planted_bad = 0 ] && echo "self-test: every planted violation is found"
  return $planted_bad
}

if [ "${1:-}" = --self-test ]; then
  self_test
else
  check_tree "${1:-$(dirname "$0")/..}" && echo "layering: in order"
fi
