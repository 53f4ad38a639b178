#!/usr/bin/python3
"""Seven first trials with vessels, docs/vessels.md: what floats, heels, floods, is pumped, poured out and sinks."""

import argparse
from pathlib import Path

import matplotlib
import numpy as np

import bullet_ambient as ba

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

STEP = 1 / 120  # [s]


def box(size, position):
    return {"shape": {"type": "box", "size": list(size)}, "position": list(position)}


def open_box(length, width, height, wall, bulkheads=()):
    """A box without a lid, its middle in the origin, with bulkheads across at the x given."""
    inside, middle = height - wall, wall / 2
    ends = [box([wall, width - 2 * wall, inside], [x, 0, middle]) for x in (-(length - wall) / 2, (length - wall) / 2, *bulkheads)]
    sides = [box([length, wall, inside], [0, y, middle]) for y in (-(width - wall) / 2, (width - wall) / 2)]
    return {"type": "compound", "parts": [box([length, width, wall], [0, 0, (wall - height) / 2]), *sides, *ends]}


def world_of(shape, cache, mass, waves=(), **body):
    """A world of one vessel in fresh water; its centre of mass is the middle of its box unless it is given."""
    scene = {"time_step": STEP, "duration": 1, "output_step": STEP, "water": {"level": 0, "waves": list(waves)}}
    return ba.World(ba.Scene({**scene, "bodies": [{"name": "vessel", "shape": shape, "mass": mass, "centre_of_mass": [0, 0, 0], **body}]}), cache=cache)


def follow(world, duration, numbers, before=lambda time, body: None, every=6):
    """Rows (T, n): the time and what `numbers` says of the vessel, which `before` may handle in each step."""
    body, rows = world.bodies["vessel"], []
    for step in range(round(duration / STEP)):
        before(world.time, body)
        world.step()
        if step % every == 0:
            rows.append([world.time, *numbers(body)])
    return np.array(rows)


def turned(angle):
    """Quaternion of a turn about x."""
    return [np.cos(angle / 2), np.sin(angle / 2), 0, 0]


def swamped(cache=None):
    """A boat with walls of steel, 271 kg, and 579 kg of cargo in two waves of like period, whose group has one wave too many: height, water inside [m^3]."""
    hull = open_box(2.4, 1, 0.5, 0.006)
    waves = [{"amplitude": 0.1, "period": period, "direction": [0, 1, 0], "phase": phase} for period, phase in ((1.8, 0), (1.9, np.pi))]
    with world_of(hull, cache, 850, waves, centre_of_mass=[0, 0, -0.12], inertia=[110, 430, 480, 0, 0, 0], position=[0, 0, -0.22]) as world:
        return follow(world, 32, lambda body: (body.position[2], body.holds[0]["volume"]))


def bowl_pushed_under(cache=None):
    """A bowl of wood is held 0.15 m under and let go after a second: height, water inside [m^3]."""
    with world_of(open_box(0.4, 0.4, 0.15, 0.015), cache, 3, position=[0, 0, 0.056]) as world:

        def hold(time, body):
            if 1 <= time < 2:
                body.set_pose([0, 0, -0.15], turned(0))
                body.set_twist(np.zeros(6))

        return follow(world, 6, lambda body: (body.position[2], body.holds[0]["volume"]), hold, every=1)


def bucket(cache=None):
    """A bucket is dipped, lifted and poured out by its tilt, all by hand: height, tilt [rad], water inside [m^3]."""
    times = [0, 2, 4, 6, 8, 12, 14]
    heights, tilts = [0.5, 0.5, -0.25, -0.25, 0.6, 0.6, 0.6], [0, 0, 0, 0, 0, 2, 2]
    with world_of(open_box(0.3, 0.3, 0.3, 0.01), cache, 2, position=[0, 0, 0.5]) as world:
        state = [0, 0]

        def move(time, body):
            state[:] = np.interp(time, times, heights), np.interp(time, times, tilts)
            body.set_pose([0, 0, state[0]], turned(state[1]))
            body.set_twist(np.zeros(6))

        return follow(world, 14, lambda body: (*state, body.holds[0]["volume"]), move)


def diving_bell(cache=None):
    """A bell goes down to 10 m and up again, by hand: depth of its rim, share of air in it."""
    bell = {"type": "compound", "parts": [dict(part, position=[*part["position"][:2], -part["position"][2]]) for part in open_box(0.6, 0.6, 0.6, 0.02)["parts"]]}
    with world_of(bell, cache, 300, position=[0, 0, 0.5]) as world:
        state = [0]

        def move(time, body):
            state[0] = np.interp(time, [0, 20, 40], [0, 10, 0])
            body.set_pose([0, 0, 0.3 - state[0]], turned(0))
            body.set_twist(np.zeros(6))

        return follow(world, 40, lambda body: (state[0], 1 - body.holds[0]["volume"] / body.holds[0]["capacity"]), move)


def compartments(holed, cache=None):
    """A ship of four compartments, of which some from the bow on get a hole in the floor: height, trim [rad], water inside [m^3]."""
    ship = open_box(4, 1, 0.8, 0.02, bulkheads=(-1, 0, 1))
    with world_of(ship, cache, 350, centre_of_mass=[0, 0, -0.1], inertia=[90, 700, 725, 0, 0, 0], position=[0, 0, 0.2]) as world:
        body = world.bodies["vessel"]
        order = np.argsort([hold["centre"][0] for hold in body.holds])[::-1]  # from the bow on
        for hold in order[:holed]:
            body.add_opening(int(hold), [body.holds[hold]["centre"][0], 0, -0.39], [0, 0, -1], 0.012)

        def numbers(body):
            w, x, y, z = body.orientation
            return body.position[2], np.arcsin(2 * (w * y - z * x)), sum(hold["volume"] for hold in body.holds)

        return follow(world, 150, numbers)


def bilge_pump(cache=None):
    """A barge with a leak of 4 cm^2; after 60 s a pump takes 1.5 l/s out: draught of the floor, water inside [m^3]."""
    with world_of(open_box(2, 1, 0.5, 0.02), cache, 200, centre_of_mass=[0, 0, -0.12], inertia=[26, 84, 100, 0, 0, 0], position=[0, 0, 0.03]) as world:
        world.bodies["vessel"].add_opening(0, [0, 0, -0.24], [0, 0, -1], 4e-4)

        def pump(time, body):
            body.pump(0, -1.5e-3 if time > 60 else 0)

        return follow(world, 240, lambda body: (0.13 - body.position[2], body.holds[0]["volume"]), pump)


def loose_ball(cache=None):
    """A tray with a loose ball of lead, 10.3 kg, near its middle: slope of its long and of its short side, place of the ball on them [m]."""
    ball = {"name": "ball", "shape": {"type": "sphere", "radius": 0.06}, "mass": 10.26, "position": [0, 0.01, -0.035]}
    tray = {"name": "vessel", "shape": open_box(1, 0.6, 0.4, 0.02), "mass": 60, "centre_of_mass": [0, 0, -0.05], "position": [0, 0, 0.083]}
    scene = {"time_step": STEP, "duration": 1, "output_step": STEP, "water": {"level": 0}, "bodies": [tray, ball]}
    with ba.World(ba.Scene(scene), cache=cache) as world:

        def numbers(body):
            w, x, y, z = body.orientation
            along = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])
            across = np.array([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)])
            way = world.bodies["ball"].position - body.position
            return along[2], across[2], along @ way, across @ way

        return follow(world, 40, numbers)


def draw(file, cache):
    figure, axes = plt.subplots(2, 4, figsize=(17, 7), layout="constrained")
    (above, bowl, pail, tray), (bell, ship, leak, empty) = axes
    empty.set_axis_off()

    def plot(axis, rows, columns, labels, title):
        for column, label in zip(columns, labels):
            axis.plot(rows[:, 0], rows[:, column], label=label)
        axis.set(xlabel="t [s]", title=title)
        axis.legend(fontsize=8)

    plot(above, swamped(cache), (1, 2), ("height [m]", "water inside [m³]"), "laden boat, one wave too many")
    above.set_ylim(-1, 1.3)
    rows = bowl_pushed_under(cache) * [1, 1, 10]
    plot(bowl, rows, (1, 2), ("height [m]", "water inside [10 l]"), "bowl pushed under, let go")
    rows = bucket(cache) * [1, 1, 1, 100]
    plot(pail, rows, (1, 2, 3), ("height [m]", "tilt [rad]", "water inside [10 l]"), "bucket dipped, lifted, poured out")
    rows = diving_bell(cache)
    bell.plot(rows[:, 1], rows[:, 2])
    bell.plot(rows[:, 1], 10.33 / (10.33 + rows[:, 1]), "k:", label="Boyle, pressure at the rim")
    bell.set(xlabel="depth of the rim [m]", ylabel="air in the bell [1]", title="diving bell")
    bell.legend(fontsize=8)
    for holed in (1, 2, 3):
        rows = compartments(holed, cache)
        (line,) = ship.plot(rows[:, 0], rows[:, 1], label=f"{holed} of 4 holed: height [m]")
        afloat = rows[:, 1] > -1
        ship.plot(rows[afloat, 0], rows[afloat, 2], ":", color=line.get_color(), label="trim [rad]")
    ship.set(xlabel="t [s]", ylim=(-1, 0.6), title="ship of four compartments")
    ship.legend(fontsize=8)
    plot(leak, bilge_pump(cache), (1, 2), ("draught [m]", "water inside [m³]"), "leak, and a pump from 60 s on")
    plot(tray, loose_ball(cache), (1, 2, 3, 4), ("trim", "heel", "ball along [m]", "ball across [m]"), "tray with a loose ball of lead")
    figure.savefig(file, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path, nargs="?", default=Path("out/vessels.png"), metavar="FILE.png", help="the picture; default: %(default)s")
    parser.add_argument("--cache", type=Path, metavar="DIR", help="folder that keeps the solved flow")
    arguments = parser.parse_args()
    arguments.file.parent.mkdir(parents=True, exist_ok=True)
    draw(arguments.file, arguments.cache)


if __name__ == "__main__":
    main()
