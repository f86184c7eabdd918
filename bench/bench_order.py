#!/usr/bin/env python3
"""Order in time: runs a scene with equal steps, halved again and again, with the same chance, and says how much the places of
bodies and plus ends at the end change from one halving to the next: root mean square over bodies, fibers and seeds, um.

  bench/bench_order.py scenes/cortical_pulling.toml --step 0.1 --halvings 4 --end-time 3 --seeds 1 2 3 \\
      --set aster.0.count=8 aster.1.count=8 'run.interactions="local"'

Prints JSON: the changes and the order log2(change / next change). What is asked of solves is tightened to 1e-11."""

import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path

import h5py
import numpy as np

ASTERFLOW = os.environ.get("ASTERFLOW", "build/release/asterflow")
NAMES = {"bodies": "body/position", "plus ends": "fiber/plus_end"}


def last_places(scene, step, seed, options):
    """Of bodies and plus ends at the end, um, [n, 3] each."""
    settings = ["run.adaptive=false", f"run.time_step={step}", f"run.end_time={options.end_time}", f"run.seed={seed}",
                "run.gmres_tolerance=1e-11", f"output.interval={options.end_time}", "output.picture=false", *options.overrides]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([ASTERFLOW, "run", scene, "-o", folder + "/run"] + [f"--set={one}" for one in settings],
                       check=True, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        with h5py.File(Path(folder) / "run" / "trajectory.h5") as file:
            frame = file["frames"][sorted(file["frames"])[-1]]
            return {name: frame[path][:] for name, path in NAMES.items() if path in frame}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--step", type=float, default=0.1, help="the longest, s")
    parser.add_argument("--halvings", type=int, default=4)
    parser.add_argument("--end-time", type=float, default=3.0, help="s")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--set", action="extend", nargs="+", default=[], dest="overrides", metavar="KEY=VALUE")
    options = parser.parse_args()
    steps = [options.step / 2**k for k in range(options.halvings + 1)]
    squares = {}
    for seed in options.seeds:
        places = [last_places(options.scene, step, seed, options) for step in steps]
        for name in places[0]:
            changes = [np.square(a[name] - b[name]).sum(axis=1).mean() for a, b in zip(places, places[1:])]
            squares.setdefault(name, []).append(changes)
    records = {}
    for name, one in squares.items():
        change = np.sqrt(np.mean(one, axis=0))
        records[name] = {"change_um": [float(f"{c:.3g}") for c in change],
                         "order": [round(float(np.log2(a / b)), 2) for a, b in zip(change, change[1:])]}
    print(json.dumps({"scene": options.scene, "overrides": options.overrides, "seeds": options.seeds, "steps_s": steps} | records))


if __name__ == "__main__":
    main()
