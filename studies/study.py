"""What the studies share: their options, runs of asterflow that are resumed when interrupted, tables of observables, and
the record of results beside the paper's.

A study is one script, one figure. Runs are named by what they model, so that figures share them:

    study = Study("figure06", __doc__)
    run = study.run("cytoplasmic_pulling", "cytoplasmic_pulling.toml", end_time=600)
    x = study.observe(run)["pnc_x"]                       # [n_state]
    study.record("time to the centre", paper="about 5 min", ours="6.1 min")
"""

import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import numpy as np
from PIL import Image

REPOSITORY = Path(__file__).resolve().parents[1]
SCENES = REPOSITORY / "scenes"


def number(least, of=int):
    """For argparse: a finite number, not below `least`."""
    def read(word):
        value = of(word)
        if not least <= value < float("inf"):
            raise argparse.ArgumentTypeError(f"{word} is not a number from {least:g} on")
        return value
    read.__name__ = "number"
    return read


def setting(word):
    """For argparse: KEY=VALUE."""
    if "=" not in word:
        raise argparse.ArgumentTypeError(f"{word} is not KEY=VALUE")
    return word


def parse_options(description):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("study-results"), help="folder of runs, pictures, records")
    parser.add_argument("--program", default=str(REPOSITORY / "build/release/asterflow"), help="the asterflow to run")
    parser.add_argument("--quick", action="store_true", help="few fibers, short, one seed: does it all work?")
    parser.add_argument("--fibers", type=number(2), help="microtubules, instead of the paper's 600")
    parser.add_argument("--end-time", type=number(0.1, float), help="s, at most, of every run")
    parser.add_argument("--seeds", type=number(0), nargs="+", help="instead of 1 2 3")
    parser.add_argument("--set", action="append", type=setting, default=[], metavar="KEY=VALUE",
                        help="a scene key of all runs; part of their names")
    parser.add_argument("--drawing-only", action="store_true", help="draw what has been run so far, run nothing")
    options = parser.parse_args()
    options.fibers = options.fibers or (24 if options.quick else 600)
    options.seeds = options.seeds or ([1] if options.quick else [1, 2, 3])
    options.end_time = options.end_time or (20.0 if options.quick else 1e9)
    try:
        (options.output / "runs").mkdir(parents=True, exist_ok=True)
    except OSError as error:
        parser.error(f"--output: {error.strerror}: {error.filename}")
    if not options.drawing_only and not shutil.which(options.program):
        parser.error(f"--program: {options.program} is not a program; build it (README) or say where it is")
    return options


class Failed(SystemExit):
    """What asterflow says when it fails. Ends a study with that line."""


class Study:
    def __init__(self, figure, description):
        self.figure = figure
        self.options = parse_options(description)
        self.folder = self.options.output
        self.records = []

    def asterflow(self, *words):
        environment = os.environ | {"ASTERFLOW_PYTHON": "none"}  # the studies draw
        try:
            done = subprocess.run([self.options.program, *map(str, words)], env=environment, text=True, capture_output=True)
        except OSError as error:
            sys.exit(f"--program {self.options.program}: {error.strerror}")
        if done.returncode != 0:
            said = done.stderr.strip().splitlines() or [f"ended with {done.returncode}"]
            raise Failed(f"{said[-1]} (asterflow {' '.join(map(str, words))})")
        return done.stdout

    def folder_of(self, name, seed):
        chosen = "".join("-" + word.removeprefix("run.") for word in self.options.set)
        quick = "-quick" if self.options.quick else ""
        return self.folder / "runs" / f"{name}{chosen}{quick}-n{self.options.fibers}-seed{seed}"

    def run(self, name, scene, end_time, seed=1, **changes):
        """Folder of the run of a scene to end_time (s), started or resumed as needed. `changes`: scene keys with __ for
        the dot, e.g. pushing__minimal_catastrophe_rate=0.1. What stops a run early is said and kept with it."""
        fibers, folder = self.options.fibers, self.folder_of(name, seed)
        end_time = min(end_time, self.options.end_time)
        if self.options.drawing_only:
            if not (folder / "trajectory.h5").exists():
                sys.exit(f"{self.figure}: {folder} has not been run: leave out --drawing-only")
            return folder
        settings = {"aster.0.count": fibers // 2, "aster.1.count": fibers - fibers // 2, "run.seed": seed,
                    "output.picture": "false"}
        settings |= {key.replace("__", "."): json.dumps(value) for key, value in changes.items()}
        if self.options.quick:
            settings["run.accuracy"] = 1e-2
        settings |= dict(setting.split("=", 1) for setting in self.options.set)
        print(f"{self.figure}: {folder.name} to {end_time:g} s", flush=True)
        try:
            if not (folder / "trajectory.h5").exists():
                words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
                self.asterflow("run", SCENES / scene, "-o", folder, *words, "--set", f"run.end_time={end_time}")
            elif self.times(folder)[-1] < end_time:
                self.asterflow("resume", folder, "--set", f"run.end_time={end_time}")
            (folder / "stopped.txt").unlink(missing_ok=True)
        except Failed as error:
            if not (folder / "trajectory.h5").exists():
                raise
            print(error, file=sys.stderr)
            (folder / "stopped.txt").write_text(f"{error}\n")
        return folder

    def runs(self, name, scene, end_time, **changes):
        """The same with every seed; with --drawing-only those that have been run."""
        seeds = self.options.seeds
        if self.options.drawing_only:
            seeds = [seed for seed in seeds if (self.folder_of(name, seed) / "trajectory.h5").exists()] or seeds[:1]
        return [self.run(name, scene, end_time, seed, **changes) for seed in seeds]

    @staticmethod
    def times(run):
        """[n_state] s"""
        with h5py.File(run / "trajectory.h5") as file:
            return file["time"][:]

    def observe(self, run):
        """Observables of a run by name (docs/observables.md), each [n_state]."""
        table, trajectory = run / "observables.csv", run / "trajectory.h5"
        if not table.exists() or table.stat().st_mtime < trajectory.stat().st_mtime:
            self.asterflow("observe", run)
        with open(table, newline="") as file:
            rows = list(csv.reader(file))
        return dict(zip(rows[0], np.array(rows[1:], dtype=float).T))

    def flow(self, run, time, grid="120x76"):
        """Open HDF5 file of the flow in the plane z = 0 at the stored state next to `time` (command/plane_flow.hpp)."""
        states = self.times(run)[1:]
        time = float(states[np.argmin(np.abs(states - time))])
        prefix = run / f"plane_{time:g}"
        file, trajectory = prefix.with_name(prefix.name + ".h5"), run / "trajectory.h5"
        if not file.exists() or file.stat().st_size == 0:
            self.asterflow("flow", run, "--time", time, "--grid", grid, "-o", prefix)
            prefix.with_name(prefix.name + ".vts").unlink(missing_ok=True)
        return h5py.File(file)

    def record(self, quantity, paper, ours, note=""):
        """A line of the table paper / asterflow; numbers are compared, words are shown. Not a number: the run is too short."""
        ours, note = ("not measured" if str(word) == "nan" else word for word in (ours, note))
        self.records.append({"figure": self.figure, "quantity": quantity, "paper": paper, "asterflow": ours, "note": note})

    def finish(self, picture):
        """Saves the picture and the records."""
        path = self.folder / f"{self.figure}.png"
        picture.savefig(path, dpi=90)
        with Image.open(path) as drawn:
            few_colours = drawn.convert("RGB").quantize(256, dither=Image.Dither.NONE)  # half the size
        few_colours.save(path, optimize=True)
        settings = {"fibers": self.options.fibers, "seeds": self.options.seeds, "quick": self.options.quick,
                    "set": self.options.set}
        (self.folder / f"{self.figure}.json").write_text(
            json.dumps({"figure": self.figure, "settings": settings, "records": self.records}, indent=1))
        print(path)


def seed_labels(runs):
    """'seed 1' ... of runs of Study.runs."""
    return [run.name.rpartition("-")[2].replace("seed", "seed ") for run in runs]


def first_time(times, condition):
    """First time (s) at which a condition [n_time] holds; nan when it never does."""
    hits = np.flatnonzero(condition)
    return float(times[hits[0]]) if len(hits) else float("nan")


def centring_time(table, distance=1.0):
    """s until the PNC is within `distance` (um) of the centre. The paper takes the first time that it passes the centre,
    which a position that decays towards it does only by chance."""
    return first_time(table["time"], np.abs(table["pnc_x"]) <= distance)


def rotation_time(table, angle=10.0):
    """s until the intercentrosomal axis is within `angle` (degrees) of the anterior-posterior axis."""
    return first_time(table["time"], table["pnc_angle"] <= angle)


def minutes(seconds, table=None):
    """'8.1 min'; what is not reached within a table says where that ends."""
    if np.isfinite(seconds):
        return f"{seconds / 60:.1f} min"
    return f"not within {table['time'][-1] / 60:.1f} min" if table else "not reached"


def drift_speed(table, seconds, start=0.0):
    """Mean speed of the PNC (um/s) from its displacements in so many seconds, from `start` (s) on."""
    place = np.stack([table["pnc_x"], table["pnc_y"], table["pnc_z"]], axis=1)
    first = np.flatnonzero((table["time"] >= start) & (table["time"] + seconds <= table["time"][-1]))
    last = np.searchsorted(table["time"], table["time"][first] + seconds)
    moved = np.linalg.norm(place[last] - place[first], axis=1) / (table["time"][last] - table["time"][first])
    return float(moved.mean()) if len(moved) else float("nan")


def mean_over(table, column, start=0.0, end=np.inf):
    """Mean of a column over the states from `start` to `end` (s), without those where it is not a number."""
    chosen = table[column][(table["time"] >= start) & (table["time"] <= end)]
    chosen = chosen[np.isfinite(chosen)]
    return float(chosen.mean()) if len(chosen) else float("nan")
