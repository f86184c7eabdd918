#!/usr/bin/env bash
# Installs everything asterflow is built with from the distribution (Debian 12+, Ubuntu 24.04+).
# Safe to call again: when nothing is missing it only looks. Needs root or sudo, and only when
# something is missing.
#
#   usage: Kokkos_ROOT=$(cmake/bootstrap.sh)
#
# Progress goes to stderr. The only line on stdout is the folder of Kokkos, empty where CMake finds it
# by itself. Kokkos is, in this order: the one Kokkos_ROOT points at, the distribution's libkokkos-dev,
# one built from the distribution's trilinos source package (cmake/build_kokkos.sh).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

packages=(g++ cmake ninja-build pkg-config libeigen3-dev libfftw3-dev libhdf5-dev libtomlplusplus-dev
          libcli11-dev libfmt-dev libspdlog-dev libgtest-dev libbenchmark-dev
          python3 python3-numpy python3-h5py python3-matplotlib)

say() { echo "bootstrap: $*" >&2; }
fail() { say "$*"; exit 1; }

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif command -v sudo >/dev/null; then sudo --non-interactive "$@" || sudo "$@"
  else fail "missing packages and neither root nor sudo; ask an administrator for: ${missing[*]}"
  fi
}

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }
is_offered() { [ -n "$(apt-cache madison "$1" 2>/dev/null)" ]; }

update_package_lists() {
  [ -z "${lists_are_fresh:-}" ] || return 0
  say "updating package lists"
  # A third party's source may be out of order; what matters is whether our packages install.
  as_root apt-get -qq update >&2 || say "apt-get update reported errors, going on"
  lists_are_fresh=yes
}

install() {
  update_package_lists
  say "installing: $*"
  local log
  log=$(mktemp)
  as_root env DEBIAN_FRONTEND=noninteractive NEEDRESTART_SUSPEND=1 \
    apt-get -qq -y -o DPkg::Lock::Timeout=600 install --no-install-recommends "$@" </dev/null >"$log" 2>&1 ||
    { cat "$log" >&2; fail "installation failed"; }
  rm "$log"
}

install_missing() {
  missing=()
  local package
  for package in "$@"; do is_installed "$package" || missing+=("$package"); done
  [ ${#missing[@]} = 0 ] || install "${missing[@]}"
}

has_kokkos() { compgen -G "$1/lib*/cmake/Kokkos/KokkosConfig.cmake" >/dev/null ||
               compgen -G "$1/lib/*/cmake/Kokkos/KokkosConfig.cmake" >/dev/null; }

find_kokkos() {
  if [ -n "${Kokkos_ROOT:-}" ]; then
    has_kokkos "$Kokkos_ROOT" || fail "Kokkos_ROOT=$Kokkos_ROOT holds no KokkosConfig.cmake"
    echo "$Kokkos_ROOT"
    return
  fi
  is_installed libkokkos-dev && { echo; return; }
  "$here/build_kokkos.sh" --cached && return
  update_package_lists
  if is_offered libkokkos-dev; then
    install libkokkos-dev
    echo
  else
    install_missing dpkg-dev
    "$here/build_kokkos.sh"
  fi
}

if ! command -v apt-get >/dev/null; then
  say "no apt-get here. Install by hand what these Debian packages hold, and Kokkos: ${packages[*]}"
  echo "${Kokkos_ROOT:-}"
  exit 0
fi
install_missing "${packages[@]}"
kokkos=$(find_kokkos)
say "everything is there; Kokkos: ${kokkos:-of the system}"
echo "$kokkos"
