#!/usr/bin/python3
"""From a mesh to a polar, a falling plate and a sweep: the tutorial of docs/python.md."""

import argparse
from pathlib import Path

import matplotlib
import numpy as np

import bullet_ambient as ba

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def wing_mesh(chord=0.2, span=0.6, thickness=0.03, around=96, along=12):
    """Vertices and faces of a wing: an ellipse along x, drawn out along y to rounded ends."""
    angles = np.linspace(0, 2 * np.pi, around, endpoint=False)
    heights = -np.cos(np.linspace(0, np.pi, along + 1)[1:-1])  # stations from tip to tip, without the tips
    widths = np.sqrt(1 - heights**6)
    rings = [
        np.c_[w * chord / 2 * np.cos(angles), np.full(around, h * span / 2), w * thickness / 2 * np.sin(angles)]
        for h, w in zip(heights, widths)
    ]
    vertices = np.vstack([*rings, [[0, -span / 2, 0], [0, span / 2, 0]]])
    first, last = len(vertices) - 2, len(vertices) - 1
    faces = []
    for i in range(around):
        j = (i + 1) % around
        for ring in range(0, (len(rings) - 1) * around, around):
            a, b, c, d = ring + i, ring + j, ring + around + i, ring + around + j
            faces += [(a, c, b), (b, c, d)]
        end = (len(rings) - 1) * around
        faces += [(first, i, j), (last, end + j, end + i)]
    return vertices, np.array(faces)


def polar_of_a_wing(axes):
    """1. A mesh becomes a fluid body; its coefficients over the angle of attack."""
    vertices, faces = wing_mesh()
    wing = ba.FluidBody.from_mesh(vertices, faces, name="wing")
    print(f"{wing}: displaces {1e3 * wing.volume:.2f} l, carries {wing.added_mass[5, 5] / wing.volume:.1f} times as much upwards")
    attack = np.radians(np.arange(0, 91))
    for law in ("published", "form"):
        polar = wing.polar(attack, flow=ba.FlowSettings(law=law))
        (line,) = axes.plot(np.degrees(attack), polar["C_L"], label=f"lift, {law}")
        axes.plot(np.degrees(attack), polar["C_D"], "--", color=line.get_color(), label=f"drag, {law}")
    axes.set(xlabel="angle of attack [°]", ylabel="coefficient", title="a wing: coefficients by both laws")
    axes.legend(fontsize=7)


def fall_of_a_plate(axes):
    """2. A scene, run for 4 s; pushed aside by a gust on the way."""
    scene = ba.Scene("plate_10cm")
    with ba.World(scene) as world:
        start = world.run(2)
        world.bodies["plate"].set_medium(ba.Medium(density=1.204, viscosity=1.82e-5, velocity=(0.5, 0, 0)))
        gust = world.run(2)
    for motion, label in ((start, "still air"), (gust, "wind of 0.5 m/s")):
        axes.plot(motion.position[:, 0, 0], motion.position[:, 0, 2], label=label)
    axes.set(xlabel="x [m]", ylabel="z [m]", title="a plate of 10 cm and 0.2 g", aspect="equal")
    axes.legend(fontsize=7)


def sweep_of_masses(axes):
    """3. The same plate in 200 masses at once, on all cores."""
    masses = np.geomspace(0.05e-3, 2e-3, 200)
    out = ba.rollout(ba.Scene("plate_10cm"), {"bodies.0.mass": masses}, duration=4)
    for mode in np.unique(out.summary["mode"]):
        of_mode = out.summary["mode"][:, 0] == mode
        axes.semilogx(1e3 * masses[of_mode], out.summary["descent_speed"][of_mode, 0], ".", label=mode)
    axes.set(xlabel="mass [g]", ylabel="descent [m/s]", title="200 masses")
    axes.legend(fontsize=7)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path, nargs="?", default=Path("out/tutorial.png"), metavar="FILE.png", help="the picture; default: %(default)s")
    file = parser.parse_args().file
    file.parent.mkdir(parents=True, exist_ok=True)
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    polar_of_a_wing(axes[0])
    fall_of_a_plate(axes[1])
    sweep_of_masses(axes[2])
    figure.savefig(file, dpi=90)


if __name__ == "__main__":
    main()
