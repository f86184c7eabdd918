"""Pictures of the records of bench_evaluators: time against number of points, error asked for and achieved against time.

usage: plot_evaluators.py records.json picture.png
"""

import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STYLES = {1e-3: "-", 1e-6: "--", 1e-9: "-.", 1e-12: ":"}


def records(path):
    with open(path) as lines:
        return [json.loads(line) for line in lines if line.startswith("{")]


def draw_time(axes, kernel, entries):
    distributions = list(dict.fromkeys(e["distribution"] for e in entries))
    for distribution in distributions:
        color = f"C{distributions.index(distribution)}"
        for accuracy, style in STYLES.items():
            line = sorted((e["n"], e["execute_cpu_seconds"]) for e in entries
                          if e["distribution"] == distribution and e["accuracy"] == accuracy)
            if line:
                axes.loglog(*zip(*line), style, color=color, label=distribution if accuracy == min(STYLES) else None)
    axes.set(title=kernel, xlabel="points", ylabel="CPU s of one sum")


def draw_error(axes, entries):
    most = max(e["n"] for e in entries)
    distributions = list(dict.fromkeys(e["distribution"] for e in entries))
    for distribution in distributions:
        color = f"C{distributions.index(distribution)}"
        line = sorted((e["execute_cpu_seconds"], e["error"], e["accuracy"]) for e in entries
                      if e["distribution"] == distribution and e["n"] == most)
        seconds, error, asked = zip(*line)
        axes.loglog(seconds, error, "o-", color=color, label=distribution)
        axes.loglog(seconds, asked, "_", color=color, markersize=12)
    axes.set(xlabel=f"CPU s of one sum of {most} points", ylabel="relative error (bar: asked for)")


def main(source, picture):
    entries = [e for e in records(source) if e["backend"] == "fast"]
    kernels = list(dict.fromkeys(e["kernel"] for e in entries))
    figure, axes = plt.subplots(2, len(kernels), figsize=(4 * len(kernels), 7), squeeze=False, constrained_layout=True)
    for column, kernel in enumerate(kernels):
        of_kernel = [e for e in entries if e["kernel"] == kernel]
        draw_time(axes[0, column], kernel, of_kernel)
        draw_error(axes[1, column], of_kernel)
    axes[1, 0].legend(fontsize=7)
    figure.savefig(picture, dpi=70)


if __name__ == "__main__":
    main(*sys.argv[1:])
