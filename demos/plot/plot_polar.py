#!/usr/bin/python3
"""Coefficients of a shape in the wind: plot_polar.py -o PICTURE.png POLAR.csv

POLAR.csv is what `ambient_preprocess polar` prints. Against the angle of attack, one line per angle of side-slip; or the
other way round, if that has more values. The last panel is the drag polar. With --reynolds the drag over the Reynolds
number, beside that of a smooth ball.
"""

import matplotlib.pyplot as plt
from files import read_table, reading
from picture import draw_picture

ANGLES = {"attack": "angle of attack α [°]", "side_slip": "side-slip β [°]"}
LABELS = {"C_L": "lift $C_L$", "C_D": "drag $C_D$", "C_Y": "side force $C_Y$", "C_l": "roll $C_l$",
          "C_m": "pitch $C_m$", "C_n": "yaw $C_n$"}
DRAGS = {"C_D": "body", "C_D_of_ball": "smooth ball"}
MOST_LINES = 12


def read(file):
    kind = "a table of ambient_preprocess polar"
    rows = read_table(file, kind, ["C_D"])
    rows = read_table(file, kind, ["Re", *DRAGS] if "Re" in rows[0] else [*ANGLES, *LABELS])
    with reading(file, kind):
        return [{key: float(value) for key, value in row.items()} for row in rows]


def values(rows, key):
    return sorted({row[key] for row in rows})


def draw(figure, rows, along, across):
    panels = figure.subplot_mosaic([["C_L", "C_D", "C_m", "polar"], ["C_Y", "C_l", "C_n", "legend"]])
    lines = values(rows, across)
    lines = lines[::-(-len(lines) // MOST_LINES)]
    colours = plt.cm.viridis([i / max(1, len(lines) - 1) * 0.9 for i in range(len(lines))])
    for value, colour in zip(lines, colours):
        chosen = sorted((row for row in rows if row[across] == value), key=lambda row: row[along])
        style = {"color": colour, "linewidth": 1, "marker": "." if len(chosen) < 60 else None, "markersize": 3}
        for key in LABELS:
            panels[key].plot([row[along] for row in chosen], [row[key] for row in chosen], **style)
        label = f"{'β' if across == 'side_slip' else 'α'} = {value:g}°"
        panels["polar"].plot([row["C_D"] for row in chosen], [row["C_L"] for row in chosen], label=label, **style)
    # Coefficients that are rounding shall look like nothing.
    largest = max(abs(row[key]) for row in rows for key in LABELS)
    for key, label in LABELS.items():
        panels[key].set_title(label, fontsize=9)
        panels[key].set_xlabel(ANGLES[along], fontsize=8)
        if max(abs(row[key]) for row in rows) < 1e-3 * largest:
            panels[key].set_ylim(-0.1 * largest, 0.1 * largest)
    panels["polar"].set_title("drag polar", fontsize=9)
    panels["polar"].set_xlabel("$C_D$", fontsize=8)
    panels["polar"].set_ylabel("$C_L$", fontsize=8)
    for axes in panels.values():
        axes.grid(True, linewidth=0.3)
        axes.tick_params(labelsize=7)
    panels["legend"].axis("off")
    panels["legend"].legend(*panels["polar"].get_legend_handles_labels(), loc="center", fontsize=8, frameon=False)


def draw_drag(rows):
    figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
    for key, label in DRAGS.items():
        axes.loglog([row["Re"] for row in rows], [row[key] for row in rows], label=label)
    axes.set_xlabel(r"Reynolds number on $D_A = \sqrt{area/\pi}$")
    axes.set_ylabel(LABELS["C_D"])
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend()
    return figure


def draw_table(file):
    rows = read(file)
    if "Re" in rows[0]:
        return draw_drag(rows)
    along, across = "attack", "side_slip"
    if len(values(rows, across)) > len(values(rows, along)):
        along, across = across, along
    figure = plt.figure(figsize=(12, 5.6), layout="constrained")
    draw(figure, rows, along, across)
    return figure


if __name__ == "__main__":
    draw_picture(__doc__, draw_table, 120, metavar="POLAR.csv")
