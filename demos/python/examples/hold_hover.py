#!/usr/bin/python3
"""A quadrotor holds its attitude, or its place, in a turbulent wind: docs/wind.md.

    python3 hold_hover.py -o quadrotor.png    # needs matplotlib
"""

import argparse

import numpy as np

import bullet_ambient as ba

SCENE, PLACE = "quadrotor_in_turbulence", np.array([0, 0, 10.0])  # [m]
DURATION, DRIFT = 20, 12  # where it holds its place, and where it does not [s]
STIFFNESS, DAMPING = np.array([1.2, 1.2, 2.5]), np.array([1.6, 1.6, 2.5])  # of the place over the mass [1/s^2], [1/s]
STIFF, DAMPED = np.array([110, 110, 15]), np.array([16, 16, 6])  # of the attitude over the inertia [1/s^2], [1/s]
STEEPEST = 0.5  # share of the weight that may push sideways


class Pilot:
    """Springs and dampers: from place to thrust and attitude, from attitude to torque, from both to turns of the propellers."""

    def __init__(self, world, holds_place):
        document = world.scene.document
        body, thrusters = document["bodies"][0], document["thrusters"]
        self.world, self.body, self.holds_place = world, world.bodies["quadrotor"], holds_place
        self.mass, self.inertia = body["mass"], np.array(body["inertia"][:3])
        propeller, air = thrusters[0]["propeller"], document["regions"][0]["medium"]["density"]
        _, thrust, power = propeller["ct_cp"][0]  # at rest
        self.per_square = air * propeller["diameter"] ** 4 * thrust  # thrust over the square of the turns
        self.fastest = thrusters[0]["curve"][-1][1]
        x, y, _ = np.array([of["position"] for of in thrusters]).T
        arm = propeller["diameter"] * power / (2 * np.pi * thrust)  # torque over thrust [m]
        spins = np.array([1 if of["propeller"].get("hand") == "left" else -1 for of in thrusters])
        self.shares = np.linalg.inv([np.ones(4), y, -x, spins * arm])

    def fly(self):
        """Call before each step."""
        w, x, y, z = self.body.orientation
        axes = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
        spin, velocity = axes.T @ self.body.twist[:3], self.body.twist[3:]
        wanted = STIFFNESS * (PLACE - self.body.position) - DAMPING * velocity
        steepest = STEEPEST * 9.81 * self.holds_place
        wanted[:2] *= min(1, steepest / max(np.hypot(*wanted[:2]), 1e-9))
        force = self.mass * (wanted + [0, 0, 9.81])
        error = axes.T @ np.cross(axes[:, 2], force / np.linalg.norm(force)) + [0, 0, -axes[1, 0]]
        torque = self.inertia * (STIFF * error - DAMPED * spin)
        thrusts = self.shares @ [axes[:, 2] @ force, *torque]
        self.world.commands = np.sqrt(np.clip(thrusts, 0, None) / self.per_square) / self.fastest


def run(holds_place, duration=DURATION, cache=None):
    """Times (T,), positions (T, 3), cosines of the tilt (T,) and turns per second (T, 4)."""
    with ba.World(ba.Scene(SCENE), cache=cache) as world:
        pilot, rows = Pilot(world, holds_place), []
        for _ in range(round(duration / world.scene.time_step)):
            pilot.fly()
            world.step()
            _, x, y, _ = pilot.body.orientation
            rows.append([world.time, *pilot.body.position, 1 - 2 * (x * x + y * y), *world.turns])
    rows = np.array(rows)
    return rows[:, 0], rows[:, 1:4], rows[:, 4], rows[:, 5:]


def draw(file):
    """Draws the picture to a file."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    attitude, place = run(False, DRIFT), run(True)
    figure, (field, way, turning) = plt.subplots(1, 3, figsize=(14, 3.6), layout="constrained", width_ratios=[2.2, 1, 1])
    x, y = np.meshgrid(np.linspace(-4, 36, 201), np.linspace(-8, 8, 81))
    points = np.stack([x.ravel(), y.ravel(), np.full(x.size, PLACE[2])], axis=1)
    flow = ba.Scene(SCENE).document["regions"][0]["flow"]
    wind = ba.flow_velocity(flow, points, DRIFT).reshape(*x.shape, 3)
    colours = field.pcolormesh(x, y, wind[..., 2], cmap="RdBu_r", vmin=-3, vmax=3, shading="gouraud", rasterized=True)
    few = np.s_[3::8, 3::8]
    field.quiver(x[few], y[few], wind[few][..., 0], wind[few][..., 1], color="black", alpha=0.5, scale=200, width=0.0018)
    for (_, position, _, _), colour, label in ((attitude, "black", f"holds attitude and height, {DRIFT} s"), (place, "darkorange", f"holds its place, {DURATION} s")):
        field.plot(*position[:, :2].T, color=colour, lw=2, label=label)
        field.plot(*position[-1, :2], "x", color=colour, markersize=9, markeredgewidth=2.5)
    field.set(xlabel="x [m]", ylabel="y [m]", title=f"wind 10 m over the ground after {DRIFT} s", aspect="equal", xlim=(-4, 36), ylim=(-8, 8))
    field.legend(fontsize=8, loc="upper right")
    figure.colorbar(colours, ax=field, label="updraught [m/s]", shrink=0.8)
    time, position, _, turns = place
    way.plot(time, position - PLACE, label=["x", "y", "z"])
    way.set(xlabel="t [s]", ylabel="from its place [m]", title="holds its place")
    way.legend(fontsize=8)
    turning.plot(time, turns, lw=0.8, label=["front left", "rear left", "rear right", "front right"])
    turning.set(xlabel="t [s]", ylabel="turns per second", title="propellers", ylim=(60, 85))
    turning.legend(fontsize=7, ncols=2)
    figure.savefig(file, dpi=75)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE")
    draw(parser.parse_args().output)
