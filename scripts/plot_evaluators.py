#!/usr/bin/env python3
"""Pictures of what bench_evaluators measured: time against the number of points, and error against time.

usage: bench_evaluators ... > sums.jsonl; plot_evaluators.py sums.jsonl sums.png
"""

import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def read(path):
    with open(path) as lines:
        return [json.loads(line) for line in lines if line.startswith("{")]


def groups(records, *keys):
    found = {}
    for record in records:
        found.setdefault(tuple(record[key] for key in keys), []).append(record)
    return found


def plot_time(axes, records):
    for (backend, accuracy), group in sorted(groups(records, "backend", "accuracy").items()):
        group.sort(key=lambda record: record["n"])
        axes.loglog(
            [record["n"] for record in group],
            [record["execute_cpu_seconds"] / record["n"] * 1e6 for record in group],
            "o-" if backend == "fast" else "x--",
            label=f"{backend} {accuracy:.0e}",
        )
    axes.set_xlabel("points")
    axes.set_ylabel("CPU microseconds per point")


def plot_error(axes, records):
    largest = max(record["n"] for record in records)
    for (backend,), group in sorted(groups([r for r in records if r["n"] == largest], "backend").items()):
        axes.loglog(
            [record["execute_cpu_seconds"] for record in group],
            [record["error"] for record in group],
            "o" if backend == "fast" else "x",
            label=backend,
        )
    axes.set_xlabel(f"CPU seconds, {largest:.0e} points")
    axes.set_ylabel("relative error")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    cases = groups(read(sys.argv[1]), "kernel", "distribution")
    figure, axes = plt.subplots(len(cases), 2, figsize=(10, 3.6 * len(cases)), squeeze=False)
    for row, ((kernel, distribution), records) in zip(axes, sorted(cases.items())):
        plot_time(row[0], records)
        plot_error(row[1], records)
        row[0].set_title(f"{kernel}, {distribution}")
        row[0].legend(fontsize=6)
        row[1].legend(fontsize=6)
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=120)


if __name__ == "__main__":
    main()
