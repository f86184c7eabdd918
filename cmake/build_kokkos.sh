#!/usr/bin/env bash
# Builds Kokkos (OpenMP and Serial) from the distribution's own trilinos source package, for
# distributions without libkokkos-dev. Prints the folder it is installed in; one folder for each
# distribution, compiler and architecture, below ${XDG_CACHE_HOME:-~/.cache}/asterflow.
#
#   usage: cmake/build_kokkos.sh             build unless it is there
#          cmake/build_kokkos.sh --cached    only look: exit 1 if it is not there
#
# The machine's package sources are read, never changed: their deb-src form lives in a temporary
# folder with package lists of its own.
set -euo pipefail

say() { echo "build_kokkos: $*" >&2; }
fail() { say "$*"; exit 1; }

cache=${XDG_CACHE_HOME:-${HOME:-$(getent passwd "$(id -u)" | cut -d: -f6)}/.cache}/asterflow
distribution=$(. /etc/os-release && echo "$ID${VERSION_ID:-}")
prefix=$cache/kokkos-$distribution-g++$(g++ -dumpfullversion)-$(g++ -dumpmachine)
link=$cache/kokkos   # cmake/Dependencies.cmake looks here too

is_complete() { [ -e "$prefix/complete" ]; }

publish() {
  ln -sfn "$prefix" "$link"
  echo "$prefix"
}

# The sources of this machine as deb-src, both formats; the folder stands for /etc/apt.
write_source_entries() {
  local folder=$1 file
  mkdir -p "$folder/sources.list.d"
  shopt -s nullglob
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ -f "$file" ] || continue
    sed -nE 's/^[[:space:]]*deb([[:space:]]+)/deb-src\1/p' "$file" | { grep -v 'cdrom:' || true; } \
      > "$folder/sources.list.d/$(basename "$file" .list).list"
  done
  for file in /etc/apt/sources.list.d/*.sources; do
    sed -E 's/^[Tt]ypes:.*/Types: deb-src/' "$file" > "$folder/sources.list.d/$(basename "$file")"
  done
}

# apt-get with the entries and lists of folder $1 in place of the machine's.
private_apt() {
  local folder=$1
  shift
  apt-get -qq -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$folder/sources.list.d" \
    -o Dir::State::Lists="$folder/lists" -o Dir::Cache="$folder/cache" \
    -o Acquire::Languages=none -o APT::Sandbox::User="$(id -un)" "$@" >&2
}

download_sources() {
  local folder=$1
  write_source_entries "$folder"
  mkdir -p "$folder/lists/partial" "$folder/cache/archives/partial"
  say "reading the lists of source packages"
  private_apt "$folder" update || say "apt-get update reported errors, going on"
  say "downloading the source package trilinos"
  (cd "$folder" && private_apt "$folder" source --download-only trilinos) ||
    fail "this distribution offers neither libkokkos-dev nor a trilinos source package; set Kokkos_ROOT"
  say "extracting packages/kokkos"
  mkdir "$folder/trilinos"
  tar -xf "$folder"/trilinos_*.orig.tar.* -C "$folder/trilinos" --strip-components=1 --wildcards '*/packages/kokkos'
}

# (g++ 13 and later no longer include <cstdint> by the way, as Kokkos 3.4 expects.)
build() {
  local folder=$1 source=$1/trilinos/packages/kokkos
  say "building Kokkos into $prefix"
  cmake -G Ninja -S "$source" -B "$folder/build" -DCMAKE_INSTALL_PREFIX="$prefix" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_STANDARD=17 -DCMAKE_CXX_FLAGS="-include cstdint" \
    -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
    -DKokkos_ENABLE_OPENMP=ON -DKokkos_ENABLE_SERIAL=ON > "$folder/log" 2>&1 &&
  cmake --build "$folder/build" >> "$folder/log" 2>&1 &&
  cmake --install "$folder/build" >> "$folder/log" 2>&1 || { cat "$folder/log" >&2; fail "Kokkos did not build"; }
  touch "$prefix/complete"   # last: a build cut short is built again
}

if is_complete; then publish; exit; fi
[ "${1:-}" != --cached ] || exit 1

mkdir -p "$cache"
exec 9> "$cache/lock"
flock 9   # whoever came first builds, the others find it complete
is_complete && { publish; exit; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
download_sources "$scratch"
build "$scratch"
publish
