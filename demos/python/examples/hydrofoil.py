#!/usr/bin/python3
"""A boat rises on its foils, beside what they lift by hand: docs/wings.md.

    hydrofoil.py [-o PICTURE.png]    # the picture needs matplotlib
"""

import argparse

import numpy as np

import bullet_ambient as ba

DENSITY, GRAVITY = 998.0, 9.81


def lift_slope(aspect):
    """Of the lift over the incidence, Helmbold [1/rad]."""
    return 2 * np.pi * aspect / (2 + np.sqrt(4 + aspect**2))


def lift_by_hand(scene, place, speed, attack):
    """Vertical force of each foil [N] at a height of the centre of mass [m], a speed [m/s] and a small attack of the boat [rad]."""
    ahead, above = np.array(scene["bodies"][0]["centre_of_mass"])[[0, 2]]
    lifts = []
    for foil in scene["foils"]:
        span = np.array(foil.get("span_axis", [0, 1, 0]))
        level = place + attack * (foil["position"][0] - ahead) + foil["position"][2] - above  # of its middle
        half = abs(span[2]) * foil["span"] / 2
        wet = np.clip(0.5 - level / (2 * half), 0, 1) if half > 0 else 1.0
        incidence = (foil["chord_axis"][2] + attack) * span[1]
        slope = lift_slope(foil.get("aspect", foil["span"] / foil["chord"]))
        area = wet * foil["span"] * foil["chord"]
        lifts.append(DENSITY / 2 * speed**2 * area * slope * (incidence + 2 * foil["camber"]) * span[1])
    return np.array(lifts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output")
    arguments = parser.parse_args()
    scene = ba.Scene("hydrofoil_boat")
    with ba.World(scene) as world:
        record = world.run(scene.duration, 0.1)
        thrust = sum(world.thrusts)
    place, speed = record.position[:, 0], np.linalg.norm(record.twist[:, 0, 3:5], axis=1)
    w, x, y, z = np.moveaxis(record.orientation[:, 0], -1, 0)
    attack = -np.arcsin(2 * (w * y - z * x))
    lifts = lift_by_hand(scene.document, place[-1, 2], speed[-1], attack[-1])
    weight = scene.document["bodies"][0]["mass"] * GRAVITY
    print(f"{speed[-1]:.2f} m/s, centre of mass {place[-1, 2]:.3f} m high, bow {np.degrees(attack[-1]):.2f} degrees up, thrust {thrust:.0f} N")
    print(f"foils lift {lifts.round()} N by hand, {lifts.sum() / weight:.3f} of the weight")
    if arguments.output:
        draw(scene.document, record.t, place, speed, attack, arguments.output)


def draw(scene, time, place, speed, attack, file):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (side, curves) = plt.subplots(2, 1, figsize=(9, 5.4), height_ratios=(1, 1.5))
    ahead, above = np.array(scene["bodies"][0]["centre_of_mass"])[[0, 2]]
    for shift, moment in ((0, 0), (5.5, 30), (11, 150)):
        turn = np.array([[np.cos(attack[moment]), -np.sin(attack[moment])], [np.sin(attack[moment]), np.cos(attack[moment])]])

        def seen(points):
            return (np.array(points) - [ahead, above]) @ turn.T + [shift, place[moment, 2]]

        for part in scene["bodies"][0]["shape"]["parts"]:
            (x, _, z), (a, _, c) = part["position"], np.array(part["shape"]["size"]) / 2
            side.fill(*seen([[x - a, z - c], [x + a, z - c], [x + a, z + c], [x - a, z + c]]).T, color="0.55")
        for foil in scene["foils"]:
            x, _, z = foil["position"]
            a, rise = foil["chord"] / 2, foil["span"] / 2 * abs(foil.get("span_axis", [0, 1, 0])[2])
            side.fill(*seen([[x - a, z - rise - 0.02], [x + a, z - rise - 0.02], [x + a, z + rise + 0.02], [x - a, z + rise + 0.02]]).T, color="tab:red")
        side.text(shift, 1.25, f"{time[moment]:.0f} s, {speed[moment]:.1f} m/s", ha="center")
    side.axhspan(-1, 0, color="tab:blue", alpha=0.3, zorder=3)
    side.set(aspect="equal", xlim=(-2.7, 13.7), ylim=(-1, 1.7), ylabel="height [m]")
    side.set_xticks([])
    curves.plot(time, speed, color="tab:blue")
    curves.set(xlabel="time [s]", xlim=(0, time[-1]), ylim=(0, None))
    curves.set_ylabel("speed [m/s]", color="tab:blue")
    heights = curves.twinx()
    heights.plot(time, place[:, 2] - above, color="tab:red")
    heights.set_ylabel("bottom of the hull above the water [m]", color="tab:red")
    figure.tight_layout()
    figure.savefig(file, dpi=90)


if __name__ == "__main__":
    main()
