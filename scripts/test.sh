#!/usr/bin/env bash
# From a fresh machine to green tests: dependencies, build with warnings as errors, every test.
set -euo pipefail
cd "$(dirname "$0")/.."

Kokkos_ROOT=$(cmake/bootstrap.sh)
export Kokkos_ROOT
cmake --preset ci
cmake --build --preset ci
ctest --preset ci
