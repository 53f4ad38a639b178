"""Runs of the cases of data/reality/measurements_at_sea.json by the Python module, and numbers taken from their motions."""

import json
import math

import numpy as np

import bullet_ambient as ba


def coordinate(along, motion, gravity):
    """Times [s] and values of a coordinate of the first body: "z" height of the centre of mass [m]; "roll" about the world's
    x axis [rad]; "vx", "vy", "vz" velocity [m/s]; "felt" upward acceleration that a sensor on board feels, over gravity's [1];
    "surface" height of the water inside a tank that is moved [m].
    """
    if along == "surface":
        return motion
    t, velocity = motion.t, motion.linear_velocity[:, 0]
    if along == "felt":
        return t[1:], np.diff(velocity[:, 2]) / np.diff(t) / gravity + 1
    if along == "roll":
        w, x, y, z = motion.orientation[:, 0].T
        return t, np.arctan2(2 * (w * x - y * z), 1 - 2 * (x * x + y * y))
    return t, motion.position[:, 0, 2] if along == "z" else velocity[:, ("vx", "vy", "vz").index(along)]


def extremes(what, t, y, count):
    """Times and values of extremes after the start, of alternating sign about the balance: vertices of parabolas."""
    found, side = [], y[np.argmax(y != 0)]
    for i in range(1, len(y) - 1):
        if (y[i] - y[i - 1]) * (y[i + 1] - y[i]) > 0 or y[i] * side >= 0:
            continue
        bend, rise = y[i - 1] - 2 * y[i] + y[i + 1], (y[i + 1] - y[i - 1]) / 2
        shift = -rise / bend if bend else 0
        found.append((t[i] + shift * (t[i] - t[i - 1]), y[i] + rise * shift / 2))
        side = y[i]
        if len(found) == count:
            return np.array(found)
    raise ValueError("too few extremes")


def extreme(what, t, y):
    return extremes(what, t, y, what["count"])[-1, 1] / what["scale"]


def time_of_extreme(what, t, y):
    return extremes(what, t, y, what["count"])[-1, 0]


def period(what, t, y):
    """Over `count` half periods."""
    at = np.flatnonzero(y[:-1] * y[1:] < 0) + 1
    if len(at) <= what["count"]:
        raise ValueError("too few crossings of the balance")
    crossings = t[at] - y[at] / (y[at] - y[at - 1]) * (t[at] - t[at - 1])
    return 2 * (crossings[what["count"]] - crossings[0]) / what["count"]


def decay(what, t, y):
    """Slope of ln |y| of `count` extremes over time [1/s]."""
    found = extremes(what, t, y, what["count"])
    return -np.polyfit(found[:, 0], np.log(np.abs(found[:, 1])), 1)[0]


def quadratic_decay(what, t, y):
    """kappa in dw/dt = -kappa |w| w, of two extremes a, b: a - b = 4/3 kappa mean^2 [1/rad]."""
    a, b = np.abs(extremes(what, t, y, what["count"] + 1)[-2:, 1])
    return 0.75 * (a - b) / ((a + b) / 2) ** 2 / what["scale"]


def mean(what, t, y):
    return y[t > what["time"]].mean() / what["scale"]


def amplitude(what, t, y):
    """That of a sine of the same variance, over the last `count` periods."""
    return np.sqrt(2) * y[t > t[-1] - what["count"] * what["period"]].std() / what["scale"]


def largest(what, t, y):
    return y.max() / what["scale"]


def value(what, t, y):
    return np.interp(what["time"], t, y) / what["scale"]


NUMBERS = {
    made.__name__.replace("_", " "): made
    for made in (value, mean, largest, extreme, time_of_extreme, period, decay, quadratic_decay, amplitude)
}


def measure(what, t, y):
    """A number of a series y(t): "measure" of a row. y less `balance` is measured in `scale`, but times and decays in time."""
    what = {"count": 1, "balance": 0, "scale": 1, "time": 0, **what}
    return NUMBERS[what["of"]](what, t, y - what["balance"])


def surface_in_tank(scene, moved):
    """Times [s] and heights [m], over the level at rest, of the water in the first hold of a first body that is moved along x.

    The body is at `amplitude` cos(2 pi t / `period`), and from the time `still` on, if that is given, where it is then: times count from there.
    `probe`: x of the place in the body's frame [m], near a wall; the surface is the plane that HoldWater gives.
    """
    still = moved.get("still", math.inf)
    rate, start = 2 * math.pi / moved["period"], 0 if math.isinf(still) else still
    rows = []
    with ba.World(scene) as world:
        body = next(iter(world.bodies.values()))
        while world.time < scene.duration:
            time, moves = min(world.time, still), world.time < still
            body.set_pose([moved["amplitude"] * math.cos(rate * time), 0, 0])
            body.set_twist([0, 0, 0, -moves * moved["amplitude"] * rate * math.sin(rate * time), 0, 0])
            world.step()
            normal = body.holds[0]["normal"]
            if world.time > start:
                rows.append([world.time - start, -normal[0] / normal[2] * moved["probe"]])
    return np.array(rows).T


class SeaRuns:
    """Each case is run once."""

    def __init__(self, file):
        self.data = json.loads(file.read_text(encoding="utf-8"))
        self.folder = file.parent
        self.rows = {row["id"]: row for row in self.data["rows"]}
        self.runs = {}

    def run(self, name):
        """Scene and motion of a case."""
        if name not in self.runs:
            case = self.data["cases"][name]
            scene = ba.Scene(self.data["scenes"][case["scene"]], case.get("set"), folder=self.folder)
            if "moved" in case:
                self.runs[name] = scene, surface_in_tank(scene, case["moved"])
                return self.runs[name]
            with ba.World(scene) as world:
                self.runs[name] = scene, world.run(scene.duration)
        return self.runs[name]

    def series(self, along, case):
        scene, motion = self.run(case)
        return coordinate(along, motion, np.linalg.norm(scene.document.get("gravity", [0, 0, -9.81])))

    def compute(self, row):
        """A row's number by the library."""
        what = row["measure"]
        if what["of"] == "added mass":
            document = self.data["scenes"][self.data["cases"][row["case"]]["scene"]]
            body, axis = ba.FluidBody.from_shape(document["bodies"][0]["shape"], folder=self.folder), 3 + what["axis"]
            return document["medium"]["density"] * body.added_mass[axis, axis]
        return measure(what, *self.series(what["along"], row["case"]))

    def curves(self):
        """For each measured curve (time, (y - balance) / scale) up to the last measured time."""
        for curve in self.data["series"]:
            t, y = self.series(curve["along"], curve["case"])
            used = t <= 1.02 * curve["points"][-1][0]
            yield np.column_stack([t, (y - curve["balance"]) / curve["scale"]])[used]
