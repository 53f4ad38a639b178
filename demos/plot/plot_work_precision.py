#!/usr/bin/python3
"""Error against processor time: plot_work_precision.py -o PICTURE.png TABLE.csv

One panel per case, one line per method over the steps of the world. Motions that broke down are left out.
"""

import argparse
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from files import read_table, writing

COLUMNS = 5
# Line, marker and colour per method; a family has one colour.
STYLES = {
    "fast": ("--", "v", "tab:blue"),
    "leapfrog 1e-2": (":", "o", "tab:blue"),
    "leapfrog 1e-3": ("-", "o", "tab:blue"),
    "leapfrog 1e-4": ("-.", "o", "tab:blue"),
    "pair 1e-3": (":", "s", "tab:green"),
    "pair 1e-5": ("-", "s", "tab:green"),
    "pair 1e-7": ("-.", "s", "tab:green"),
    "rk4": ("-", "D", "tab:red"),
    "symplectic euler": ("-", "x", "tab:orange"),
}


def draw(axes, runs, case):
    for method, (line, marker, colour) in STYLES.items():
        chosen = [run for run in runs if run["case"] == case and run["method"] == method]
        points = [(float(run["microseconds_per_second"]), float(run["position_error"])) for run in chosen]
        points = [(cost, error) for cost, error in points if math.isfinite(error) and error > 0]
        if points:
            axes.loglog(*zip(*points), line, marker=marker, color=colour, markersize=3.5, linewidth=1, label=method)
    axes.set_title(case, fontsize=9)
    axes.grid(True, which="major", linewidth=0.3)
    axes.tick_params(labelsize=7)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", metavar="TABLE.csv")
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE")
    arguments = parser.parse_args()
    columns = ("case", "method", "microseconds_per_second", "position_error")
    runs = read_table(arguments.table, "a table of work_precision", columns)
    cases = list(dict.fromkeys(run["case"] for run in runs))
    rows = math.ceil(len(cases) / COLUMNS)
    figure, panels = plt.subplots(rows, COLUMNS, figsize=(13, 2.9 * rows + 0.4), squeeze=False)
    for axes, case in zip(panels.flat, cases):
        draw(axes, runs, case)
    for axes in panels.flat[len(cases):]:
        axes.axis("off")
    for row in panels:
        row[0].set_ylabel("largest position error [m]", fontsize=8)
    for axes in panels[-1]:
        axes.set_xlabel("processor time [µs per simulated s]", fontsize=8)
    handles, labels = max((axes.get_legend_handles_labels() for axes in panels.flat), key=lambda pair: len(pair[1]))
    figure.tight_layout(rect=(0, 0.05, 1, 1))
    figure.legend(handles, labels, loc="lower center", ncol=len(STYLES), fontsize=8)
    with writing(arguments.output):
        figure.savefig(arguments.output, dpi=80)


if __name__ == "__main__":
    main()
