#!/usr/bin/python3
"""Draws runs of ambient_demo: plot_runs.py -o PICTURE.png DIR...

If all of them are falling plates, their outlines along each path, side by side; else one panel of paths per run.
"""

from pathlib import Path

from falling_plates import PlanarFall, draw_falls
from paths import draw_paths
from picture import draw_picture
from runs import Run


def draw(folders):
    runs = [Run(folder) for folder in folders]
    if all(run.falling_plate() for run in runs):
        return draw_falls([PlanarFall(run) for run in runs])
    return draw_paths(runs)


if __name__ == "__main__":
    picture = draw_picture(__doc__, draw, 100, nargs="+", metavar="DIR")
    print(f"\nPicture: {Path(picture).resolve()}")
