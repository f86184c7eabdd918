#!/usr/bin/env python3
"""Error against seconds: runs a scene at several accuracies and compares each last state with that of the tightest.

  bench/bench_accuracy.py scenes/figure2_demo.toml --accuracy 1e-2 1e-3 1e-4 1e-5 --reference 1e-6 -o results

Writes results/accuracy.json (one record an accuracy: asked, error in um of bodies and fiber ends, seconds, steps) and
results/accuracy.png. --dry-run takes two loose accuracies."""

import argparse
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

ASTERFLOW = os.environ.get("ASTERFLOW", "build/release/asterflow")


def last_state(folder):
    """Positions of bodies and fiber ends, um, [n, 3]; number of stored frames; no-slip residual, relative."""
    with h5py.File(Path(folder) / "trajectory.h5") as file:
        frame = file["frames"][sorted(file["frames"])[-1]]
        places = [frame[name][:] for name in ("body/position", "fiber/minus_end", "fiber/plus_end") if name in frame]
        slip = frame["flow/no_slip_residual"][:] if "flow/no_slip_residual" in frame else [0.0, 0.0, 1.0]
        return np.concatenate(places), float(max(slip[0], slip[1]) / max(slip[2], 1e-300))


def run(scene, accuracy, overrides):
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        settings = [f"run.accuracy={accuracy}", "output.picture=false", *overrides]
        subprocess.run([ASTERFLOW, "run", scene, "-o", folder + "/run"] + [f"--set={one}" for one in settings],
                       check=True, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        seconds = time.perf_counter() - start
        places, slip = last_state(folder + "/run")
        return places, slip, seconds


def draw(records, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(5, 4), layout="constrained")
    axes.loglog([r["seconds"] for r in records], [r["error_um"] for r in records], "o-")
    for r in records:
        axes.annotate(f"{r['accuracy']:g}", (r["seconds"], r["error_um"]), textcoords="offset points", xytext=(6, 4))
    axes.set_xlabel("seconds")
    axes.set_ylabel("largest error of a position at the end (um)")
    axes.grid(True, which="both", alpha=0.3)
    figure.savefig(path, dpi=150)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--accuracy", type=float, nargs="+", default=[1e-2, 1e-3, 1e-4, 1e-5])
    parser.add_argument("--reference", type=float, default=1e-6)
    parser.add_argument("--set", action="append", default=[], dest="overrides", metavar="KEY=VALUE")
    parser.add_argument("-o", "--output", default=".")
    parser.add_argument("--dry-run", action="store_true")
    options = parser.parse_args()
    if options.dry_run:
        options.accuracy, options.reference = [1e-1], 3e-2
    exact, slip, seconds = run(options.scene, options.reference, options.overrides)
    records = []
    for accuracy in options.accuracy:
        places, own_slip, own_seconds = run(options.scene, accuracy, options.overrides)
        records.append({"accuracy": accuracy, "error_um": float(np.abs(places - exact).max()), "seconds": own_seconds,
                        "no_slip": own_slip})
    folder = Path(options.output)
    folder.mkdir(parents=True, exist_ok=True)
    reference = {"accuracy": options.reference, "seconds": seconds, "no_slip": slip}
    text = json.dumps({"scene": options.scene, "overrides": options.overrides, "reference": reference, "runs": records}, indent=1)
    (folder / "accuracy.json").write_text(text + "\n")
    draw(records, folder / "accuracy.png")
    print(text)


if __name__ == "__main__":
    main()
