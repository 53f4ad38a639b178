#!/usr/bin/python3
"""Heat maps of a stability atlas: plot_atlas.py -o PICTURE.png ATLAS.csv

Each cell is the worst of the runs that fall into it: the largest relative rise of the energy.
"""

import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

sys.path.append(str(Path(__file__).resolve().parents[3] / "demos/plot"))

from files import read_table
from picture import draw_picture

SETTINGS = ("free", "falling", "on a plane", "on a joint")
# Column, label, text of a value.
STEP = ("step", "step [s]", lambda v: f"1/{round(1 / v)}")
SPIN = ("spin", "spin at the start [rad/s]", "{:g}".format)
SIZE = ("size", "size [m]", lambda v: power_of_ten(v))
RATIO = ("density_ratio", "density over the fluid's", lambda v: power_of_ten(v))
MAPS = ((STEP, SPIN), (RATIO, SIZE))
ROUNDING = 1e-16


def power_of_ten(value):
    exponent = math.log10(value)
    return f"$10^{{{exponent:.0f}}}$" if abs(exponent - round(exponent)) < 1e-9 else f"{value:g}"


def worst_rises(runs, horizontal, vertical):
    columns = sorted({float(run[horizontal]) for run in runs})
    rows = sorted({float(run[vertical]) for run in runs})
    worst = np.full((len(rows), len(columns)), math.nan)
    for run in runs:
        i, j = rows.index(float(run[vertical])), columns.index(float(run[horizontal]))
        worst[i, j] = np.nanmax([worst[i, j], float(run["energy_rise"]), ROUNDING])
    return columns, rows, worst


def draw_map(axes, runs, horizontal, vertical):
    columns, rows, worst = worst_rises(runs, horizontal[0], vertical[0])
    image = axes.imshow(worst, origin="lower", aspect="auto", cmap="viridis", norm=LogNorm(ROUNDING, 10))
    axes.set_xticks(range(len(columns)), [horizontal[2](v) for v in columns], rotation=45, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(rows)), [vertical[2](v) for v in rows])
    axes.set_xlabel(horizontal[1])
    return image


def draw(atlas):
    columns = ["setting", "energy_rise", *(column for pair in MAPS for column, _, _ in pair)]
    runs = read_table(atlas, "a table of stability_atlas", columns)
    figure, panels = plt.subplots(len(MAPS), len(SETTINGS), figsize=(11, 7), layout="constrained")
    for row, (horizontal, vertical) in zip(panels, MAPS):
        for axes, setting in zip(row, SETTINGS):
            chosen = [run for run in runs if run["setting"] == setting]
            image = draw_map(axes, chosen, horizontal, vertical)
            axes.set_title(f"{setting}: {len(chosen)} runs", fontsize=9)
        row[0].set_ylabel(vertical[1])
    figure.colorbar(image, ax=panels, label="worst relative rise of the energy in 2 s", shrink=0.7)
    return figure


if __name__ == "__main__":
    draw_picture(__doc__, draw, 80, metavar="ATLAS.csv")
