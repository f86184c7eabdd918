#!/usr/bin/env bash
# From a fresh machine to a result: dependencies, build, and a shortened version of the paper's Figure 2. A sphere with
# microtubule asters moves through a cell (pictures of its flow); then it is pulled and turned at three levels of
# interaction, with more and more microtubules (its drag).
#   usage: scripts/demo.sh [new folder for the results]
set -euo pipefail
cd "$(dirname "$0")/.."
results=${1:-demo-$(date +%Y%m%d-%H%M%S)}
scene=scenes/figure2_demo.toml

Kokkos_ROOT=$(cmake/bootstrap.sh)
export Kokkos_ROOT
cmake --preset release
cmake --build --preset release --target asterflow

echo "One run of $scene"
build/release/asterflow run "$scene" -o "$results/run"
echo "The drag study of $scene"
build/release/asterflow drag "$scene" -o "$results/drag"

cat <<END

Done. Open
  $results/drag/drag.png   drag against the number of microtubules (numbers: drag.csv)
  $results/run/final.png   the flow at the end of the run (numbers: final.h5, trajectory.h5)
  README.md                for the other commands and for writing a scene
END
