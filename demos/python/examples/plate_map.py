#!/usr/bin/python3
"""How 10 000 plates fall or rise in water: steady, fluttering, tumbling or both, over thickness and mass, as a map.

plate_map.py [--side N] [--out DIR] [--picture FILE.png]: N x N plates (100), whose cases and results go to the folder
(out/plate_map). Killed and started again, it goes on. docs/sweeps.md shows the map and says how long it took.
"""

import argparse
import time
from pathlib import Path

import matplotlib
import numpy as np

import bullet_ambient as ba

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

WIDTH, LENGTH = 0.04, 0.12  # [m]
THICKNESS = (0.0004, 0.012)  # [m]
MASS = (0.002, 0.6)  # [kg]
RELEASE = 60  # angle at release from horizontal, about the long axis [degrees]


def scene(duration):
    half = np.radians(RELEASE) / 2
    plate = {
        "name": "plate",
        "shape": {"type": "box", "size": [WIDTH, LENGTH, THICKNESS[0]], "faces": 600},
        "mass": MASS[0],
        "orientation": [np.cos(half), 0, np.sin(half), 0],
    }
    water = {"density": ba.water().density, "viscosity": ba.water().viscosity}
    return {"duration": duration, "time_step": 1 / 240, "output_step": 1 / 120, "law": "form", "medium": water, "bodies": [plate]}


class Countdown:
    """Prints how much of a part of the work is done and how long the rest will take."""

    def __init__(self, what):
        self.what, self.begin, self.before = what, time.monotonic(), None

    def __call__(self, done, all_of_them):
        """Prints progress. Work that is done at the first call was done before, and is left out of the speed."""
        if self.before is None:
            self.before = done
        fresh = done - self.before
        left = ""
        if fresh > 0 and done < all_of_them:
            seconds = (time.monotonic() - self.begin) / fresh * (all_of_them - done)
            left = f", {seconds:.0f} s left" if seconds < 120 else f", {seconds / 60:.0f} min left"
        print(f"\r{self.what}: {done} of {all_of_them}{left}\033[K", end="" if done < all_of_them else "\n", flush=True)


def prepare(sizes, of_plate, cache):
    """Builds the fluid body of each size into the cache of the runs."""
    tell = Countdown("shapes")
    for done, size in enumerate(sizes):
        tell(done, len(sizes))
        ba.World(ba.Scene(of_plate, {"bodies.0.shape.size": size}), cache=cache)
    tell(len(sizes), len(sizes))


def run(side, duration, out):
    """The table of all plates."""
    thickness, mass = np.meshgrid(np.geomspace(*THICKNESS, side), np.geomspace(*MASS, side))
    sizes = [[WIDTH, LENGTH, t] for t in thickness.ravel()]
    out.mkdir(parents=True, exist_ok=True)
    prepare(sizes[:side], scene(duration), out / "fluid_bodies")
    cases = out / "cases.jsonl"
    ba.write_cases(cases, scene(duration), {"bodies.0.shape.size": sizes, "bodies.0.mass": mass.ravel()})
    begin, used = time.time(), time.process_time()
    counts = ba.run_cases(cases, out, motion=False, progress=Countdown("runs"))
    print(f"{counts.cases} cases, {counts.done_before} done before, {len(counts.failures)} failed: ", end="")
    print(f"{time.time() - begin:.0f} s, of processors {time.process_time() - used:.0f} s")
    return thickness, mass, ba.collect(cases, out)


def draw(thickness, mass, table, file):
    side = len(thickness)
    swings, overturns = (table[name].reshape(side, side) for name in ("swings", "overturns"))
    with np.errstate(invalid="ignore"):
        share = np.where(swings + overturns > 0, overturns / (swings + overturns), np.nan)
    figure, axes = plt.subplots(figsize=(7.5, 6), layout="constrained")
    axes.set_facecolor("0.85")
    mesh = axes.pcolormesh(1e3 * thickness, 1e3 * mass, share, cmap="coolwarm", vmin=0, vmax=1, shading="nearest")
    bar = figure.colorbar(mesh, label="share of overturns: 0 flutters, 1 tumbles; grey: neither swings nor overturns")
    bar.set_ticks([0, 0.25, 0.5, 0.75, 1])
    for density, name in ((998, "water"), (2700, "aluminium"), (11340, "lead")):
        grams = 1e3 * density * WIDTH * LENGTH * thickness[0]
        axes.plot(1e3 * thickness[0], grams, "k--", linewidth=0.8)
        inside = np.flatnonzero((grams > 1e3 * MASS[0]) & (grams < 1e3 * MASS[1]))
        place = inside[len(inside) // 4]
        axes.annotate(name, (1e3 * thickness[0][place], grams[place]), textcoords="offset points", xytext=(4, -10), fontsize=8)
    axes.set(xscale="log", yscale="log", xlabel="thickness [mm]", ylabel="mass [g]")
    axes.set_ylim(1e3 * MASS[0], 1e3 * MASS[1])
    axes.set_title(f"{side * side} plates of {100 * WIDTH:.0f} x {100 * LENGTH:.0f} cm in water, released {RELEASE}° from horizontal")
    figure.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=int, default=100)
    parser.add_argument("--duration", type=float, default=10, help="of each fall [s]")
    parser.add_argument("--out", type=Path, default=Path("out/plate_map"))
    parser.add_argument("--picture", type=Path, default=Path("out/plate_map.png"))
    arguments = parser.parse_args()
    thickness, mass, table = run(arguments.side, arguments.duration, arguments.out)
    modes, counts = np.unique(table["mode"], return_counts=True)
    print(", ".join(f"{mode}: {count}" for mode, count in zip(modes, counts)))
    draw(thickness, mass, table, arguments.picture)


if __name__ == "__main__":
    main()
