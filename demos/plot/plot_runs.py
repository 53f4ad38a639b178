#!/usr/bin/python3
"""Draws runs of ambient_demo: plot_runs.py -o PICTURE.png DIR...

If all of them are falling plates, their outlines along each path, side by side; else one panel of paths per run.
"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from falling_plates import PlanarFall, draw_falls
from files import writing
from paths import draw_paths
from runs import Run


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", metavar="DIR")
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE")
    arguments = parser.parse_args()
    runs = [Run(folder) for folder in arguments.folders]
    if all(run.falling_plate() for run in runs):
        figure = draw_falls([PlanarFall(run) for run in runs])
    else:
        figure = draw_paths(runs)
    with writing(arguments.output):
        figure.savefig(arguments.output, dpi=100)
    print(f"\nPicture: {Path(arguments.output).resolve()}")


if __name__ == "__main__":
    main()
