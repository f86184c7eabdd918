#!/usr/bin/env python3
"""Pictures of bench_evaluators: time against number of points, error against time.

usage: plot_evaluators.py RECORDS.jsonl PICTURE.png
"""
import collections
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main(records_file, picture):
    with open(records_file) as lines:
        records = [json.loads(line) for line in lines if line.startswith("{")]
    figure, (by_count, by_time) = plt.subplots(1, 2, figsize=(11, 4.5))
    curves = collections.defaultdict(list)
    clouds = collections.defaultdict(list)
    for r in records:
        name = f'{r["backend"]} {r["kernel"]} {r["distribution"]}'
        curves[f'{name} {r["accuracy"]:.0e}'].append((r["n"], r["execute_cpu_seconds"]))
        clouds[f'{name} n = {r["n"]}'].append((r["execute_cpu_seconds"], r["error"]))
    for label, curve in curves.items():
        by_count.loglog(*zip(*sorted(curve)), "o-", label=label)
    for label, cloud in clouds.items():
        by_time.loglog(*zip(*sorted(cloud)), "o-", label=label)
    by_count.set(xlabel="points", ylabel="CPU seconds per sum")
    by_time.set(xlabel="CPU seconds per sum", ylabel="relative L2 error")
    for axes in (by_count, by_time):
        axes.legend(fontsize=6)
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(picture, dpi=150)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
