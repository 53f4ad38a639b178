#!/usr/bin/python3
"""A vehicle with six thrusters holds its place in a current under waves: docs/thrusters.md."""

import argparse
from pathlib import Path

import matplotlib
import numpy as np

import bullet_ambient as ba

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

LARGEST = 40  # thrust at the command 1 [N]
STIFFNESS = np.diag([10, 0, 8, 800, 800, 800])  # about x, y, z [N m/rad], along them [N/m]
DAMPING = np.diag([3, 0, 3, 250, 250, 250])  # [N m s], [N s/m]


class Controller:
    """Springs and dampers to a pose, distributed to the thrusters, in the axes of the vehicle.

    Pitch is not controlled: weight and buoyancy right the vehicle.
    """

    def __init__(self, world, position):
        self.world, self.robot, self.frame, self.position = world, world.robots["rov"], world.bodies["rov/frame"], np.array(position)
        centre = (np.linalg.inv(self.robot.pose("frame")) @ [*self.frame.position, 1])[:3]
        places = [np.linalg.inv(self.robot.pose("frame")) @ self.robot.pose(name) for name in world.thrusters]
        columns = np.array([[*np.cross(p[:3, 3] - centre, p[:3, 0]), *p[:3, 0]] for p in places]).T  # wrench of 1 N each
        self.shares = np.linalg.pinv(columns)

    def wanted(self, axes):
        """Wrench of springs and dampers; the error of the attitude is taken for small angles."""
        error = np.array([-axes[2, 1], axes[2, 0], -axes[1, 0], *axes.T @ (self.position - self.frame.position)])
        twist = self.frame.twist.reshape(2, 3) @ axes
        return STIFFNESS @ error - DAMPING @ twist.ravel()

    def push(self):
        """Call before each step: asks the thrusters for what springs and dampers want."""
        self.world.commands = self.shares @ self.wanted(self.robot.pose("frame")[:3, :3]) / LARGEST


def run(duration, controlled=True, cache=None):
    """Times (T,), positions (T, 3) and thrusts (T, 6) of the vehicle, which begins half a metre from its place."""
    scene = ba.Scene("rov", {"robots.0.position": [0.4, -0.3, -2]})
    with ba.World(scene, cache=cache) as world:
        controller, rows = Controller(world, [0, 0, -2]), []
        while world.time < duration:
            if controlled:
                controller.push()
            world.step()
            rows.append([world.time, *world.position[0], *world.thrusts])
    rows = np.array(rows)
    return rows[:, 0], rows[:, 1:4], rows[:, 4:]


def draw(file, held, free):
    figure, (above, over_time, thrusts) = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    for (_, position, _), label in ((held, "with thrusters"), (free, "without")):
        above.plot(position[:, 0], position[:, 1], label=label)
    above.plot(0, 0, "k+", markersize=12, label="the place")
    above.set(xlabel="x [m]", ylabel="y [m]", title="track from above", aspect="equal", xlim=(-0.3, 2.2), ylim=(-0.5, 1.5))
    above.legend(fontsize=8)
    time, position, thrust = held
    over_time.plot(time, 100 * (position - [0, 0, -2]), label=["x", "y", "z"])
    over_time.set(xlabel="t [s]", ylabel="from its place [cm]", title="deviation", ylim=(-10, 10))
    over_time.legend(fontsize=8)
    thrusts.plot(time, thrust, label=[of["name"] for of in ba.Scene("rov").document["thrusters"]])
    thrusts.set(xlabel="t [s]", ylabel="thrust [N]", title="thrusters")
    thrusts.legend(fontsize=7)
    figure.savefig(file, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path, nargs="?", default=Path("out/hold_place.png"), metavar="FILE.png", help="the picture; default: %(default)s")
    parser.add_argument("--cache", type=Path, metavar="DIR", help="folder that keeps the solved flow")
    parser.add_argument("--duration", type=float, default=20, help="[s]; default: %(default)s")
    arguments = parser.parse_args()
    arguments.file.parent.mkdir(parents=True, exist_ok=True)
    held, free = (run(arguments.duration, controlled, arguments.cache) for controlled in (True, False))
    time, position, _ = held
    later = time > arguments.duration / 2
    distance = np.linalg.norm(position - [0, 0, -2], axis=1)[later]
    print(f"from its place in the second half: {100 * distance.mean():.1f} cm in the mean, {100 * distance.max():.1f} cm at most")
    draw(arguments.file, held, free)


if __name__ == "__main__":
    main()
