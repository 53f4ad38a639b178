#!/usr/bin/python3
"""The picture of docs/wind.md: turbulent wind over the sea at two moments, and the way of the boats that it blows along.

    python3 wind_field.py -o wind.png    # needs matplotlib
"""

import argparse

import numpy as np

import bullet_ambient as ba

LENGTH, MEAN, HEIGHT = 40, 9.0, 0.4  # of the turbulence [m], wind at 10 m [m/s], height of the picture over the sea [m]
WIND = [ba.wind_profile([MEAN, 0, 0], roughness=0.0002),
        ba.turbulence(length=LENGTH, intensity=2, smallest=LENGTH / 40, carried=[MEAN, 0, 0], seed=3)]
TIMES, SIDE, STEP = (40, 160), 120, 1 / 60  # [s], [m], [s]


def scene():
    """Five boats of 3 m abreast."""
    boat = {"shape": {"type": "box", "size": [3, 1, 0.8]}, "mass": 700, "centre_of_mass": [0, 0, -0.1]}
    bodies = [boat | {"name": f"boat_{i}", "position": [10, 20 * (i + 1), 0.15]} for i in range(5)]
    return ba.Scene({"duration": TIMES[-1], "time_step": STEP, "output_step": 1, "bodies": bodies,
                     "water": {"level": 0, "flow_above": WIND}})


def draw(file):
    """Draws the picture to a file."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    motion = ba.World(scene()).run(TIMES[-1], 1)
    axis = np.linspace(0, SIDE, 121)
    x, y = np.meshgrid(axis, axis)
    points = np.stack([x.ravel(), y.ravel(), np.full(x.size, HEIGHT)], axis=1)
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.7), sharey=True, layout="constrained")
    for panel, time in zip(panels, TIMES):
        wind = ba.flow_velocity(WIND, points, time).reshape(*x.shape, 3)
        speed = np.linalg.norm(wind, axis=2)
        colours = panel.pcolormesh(x, y, speed, cmap="viridis", vmin=0, vmax=12, shading="gouraud", rasterized=True)
        few = np.s_[4::10, 4::10]
        panel.quiver(x[few], y[few], wind[few][..., 0], wind[few][..., 1], color="white", scale=260, width=0.0025)
        row = int(np.searchsorted(motion.t, time - 1e-9))
        for boat in range(motion.position.shape[1]):
            way = motion.position[: row + 1, boat]
            panel.plot(way[:, 0], way[:, 1], color="orangered", lw=1.5)
            w, _, _, z = motion.orientation[row, boat]
            bow = 3 * np.array([np.cos(2 * np.arctan2(z, w)), np.sin(2 * np.arctan2(z, w))])
            panel.plot(*(way[-1, :2, None] + np.outer(bow, [-1, 1])), color="black", lw=4, solid_capstyle="butt")
        panel.set(title=f"{time} s", xlabel="x [m]", aspect="equal", xlim=(0, SIDE), ylim=(0, SIDE))
    panels[0].set_ylabel("y [m]")
    figure.colorbar(colours, ax=panels, label=f"wind {HEIGHT} m over the sea [m/s]", shrink=0.9)
    figure.savefig(file, dpi=75)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE")
    draw(parser.parse_args().output)
