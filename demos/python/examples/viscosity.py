#!/usr/bin/python3
"""Glycerine, sand and golf balls: the picture of docs/viscosity.md."""

import argparse
import warnings
from pathlib import Path

import matplotlib
import numpy as np

import bullet_ambient as ba

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

GLYCERINE = ba.Medium(density=1260, viscosity=1.41)


def in_glycerine(axes):
    """Paths of the scene's bodies, two of which are bubbles and meant to rise."""
    warnings.filterwarnings("ignore", message=".*so that it rises")
    scene = ba.Scene("glycerine")
    motion = ba.World(scene).run(scene.duration)
    fallen = 1e3 * (motion.position[:, :, 2] - motion.position[0, :, 2])
    for body, name in enumerate(scene.bodies):
        speed = 1e3 * motion.twist[-1, body, 5]
        axes.plot(motion.t, fallen[:, body], label=f"{name}: {speed:+.3g} mm/s")
    axes.set(xlabel="time [s]", ylabel="rise [mm]", title="the scene glycerine, at 60 Hz")
    axes.legend(fontsize=7)


def settling_speeds(diameters, medium, density=2650):
    """Speeds of balls after they have settled [m/s]."""
    gravity, radii = 9.81, np.asarray(diameters) / 2
    surplus = 4 / 3 * np.pi * radii**3 * (density - medium.density) * gravity
    # Stokes' law and Newton's, C_D = 0.4: the slower one is above the true speed.
    creeping = surplus / (6 * np.pi * medium.viscosity * radii)
    rapid = np.sqrt(surplus / (0.2 * np.pi * radii**2 * medium.density))
    time = 20 * np.minimum(creeping, rapid).max() / gravity * (1 + medium.density / density)
    ball = {"shape": {"type": "sphere", "radius": 1}, "mass": 1}
    scene = ba.Scene({"duration": time, "time_step": time / 400, "bodies": [ball],
                      "medium": {"density": medium.density, "viscosity": medium.viscosity}})
    out = ba.rollout(scene, {"bodies.0.shape.radius": radii, "bodies.0.mass": 4 / 3 * np.pi * radii**3 * density})
    return -out.motion.twist[:, -1, 0, 5]


def sand(axes):
    """Settling speeds of quartz over the size of the grain."""
    diameters = np.geomspace(1e-5, 1e-2, 61)
    for name, medium in (("air", ba.air()), ("water", ba.water()), ("glycerine", GLYCERINE)):
        (line,) = axes.loglog(1e3 * diameters, settling_speeds(diameters, medium), label=name)
        stokes = (2650 - medium.density) * 9.81 * diameters**2 / (18 * medium.viscosity)
        axes.loglog(1e3 * diameters, stokes, ":", color=line.get_color())
    axes.set(xlabel="diameter [mm]", ylabel="speed [m/s]", ylim=(1e-8, 100), title="grains of sand; dotted: Stokes' law")
    axes.legend(fontsize=7)


def golf(axes):
    """Flights of the scenes golf_*."""
    for name in ("golf_smooth", "golf_dimpled", "golf_smooth_spin", "golf_dimpled_spin"):
        scene = ba.Scene(name)
        flight = ba.World(scene).run(scene.duration).position[:, 0]
        above = np.count_nonzero(flight[:, 2] >= 0)
        carry = np.interp(0, flight[above:above - 2:-1, 2], flight[above:above - 2:-1, 0])
        axes.plot([*flight[:above, 0], carry], [*flight[:above, 2], 0], label=f"{name}: {carry:.1f} m")
    axes.set(xlabel="distance [m]", ylabel="height [m]", title="golf balls, 53 m/s")
    axes.legend(fontsize=7)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path, nargs="?", default=Path("out/viscosity.png"), metavar="FILE.png", help="the picture; default: %(default)s")
    file = parser.parse_args().file
    file.parent.mkdir(parents=True, exist_ok=True)
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    in_glycerine(axes[0])
    sand(axes[1])
    golf(axes[2])
    figure.savefig(file, dpi=90)


if __name__ == "__main__":
    main()
