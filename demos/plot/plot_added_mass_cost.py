#!/usr/bin/python3
"""Error of the added mass against processor time: plot_added_mass_cost.py -o PICTURE.png TABLE.csv

One panel per body, one line per method over the faces of the mesh.
"""

import argparse
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from files import read_table, writing

COLUMNS = 3
# Line, marker and colour per method; a family has one colour.
STYLES = {
    "build": ("-", "o", "tab:blue"),
    "build, 1000 panels": ("--", "v", "tab:blue"),
    "panels alone": (":", "s", "tab:green"),
    "point sources": ("-", "x", "tab:orange"),
    "point sources, exact flux": ("-", "D", "tab:red"),
}


def draw(axes, runs, case):
    for method, (line, marker, colour) in STYLES.items():
        chosen = [run for run in runs if run["case"] == case and run["method"] == method]
        points = [(float(run["processor_seconds"]), float(run["error"])) for run in chosen]
        axes.loglog(*zip(*points), line, marker=marker, color=colour, markersize=4, linewidth=1, label=method)
    # Off by more than that is off.
    axes.set_ylim(top=min(axes.get_ylim()[1], 10))
    axes.set_title(case, fontsize=9)
    axes.grid(True, which="major", linewidth=0.3)
    axes.tick_params(labelsize=7)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", metavar="TABLE.csv")
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE")
    arguments = parser.parse_args()
    columns = ("case", "method", "processor_seconds", "error")
    runs = read_table(arguments.table, "a table of potential_flow_study", columns)
    cases = list(dict.fromkeys(run["case"] for run in runs))
    rows = math.ceil(len(cases) / COLUMNS)
    figure, panels = plt.subplots(rows, COLUMNS, figsize=(12, 3.2 * rows + 0.4), squeeze=False, sharex=True)
    for axes, case in zip(panels.flat, cases):
        draw(axes, runs, case)
    for axes in panels.flat[len(cases):]:
        axes.axis("off")
    for row in panels:
        row[0].set_ylabel("error over the largest entry of the block", fontsize=8)
    for axes in panels[-1]:
        axes.set_xlabel("processor time [s]", fontsize=8)
    handles, labels = panels.flat[0].get_legend_handles_labels()
    figure.tight_layout(rect=(0, 0.05, 1, 1))
    figure.legend(handles, labels, loc="lower center", ncol=len(STYLES), fontsize=8)
    with writing(arguments.output):
        figure.savefig(arguments.output, dpi=80)


if __name__ == "__main__":
    main()
