#!/usr/bin/python3
"""Runs scenes for minutes at several rates, as they are and with a ball on a joint at each body that moves freely:
scenes_for_minutes.py [SCENE ...] [--minutes 10] [--rates 30 60 240] [--cache DIR]. PYTHONPATH has the Python module.

A line for each run: what was halted, too long, coarse or guarded in the steps, the largest speeds in the first and in the
last minute over all bodies, energy taken out by the guards, and what was said. A run that ends before says where.
"""

import argparse
import copy
import sys
from pathlib import Path

import numpy as np

import bullet_ambient as ba

COUNTS = ("halted", "too_long", "coarse", "guarded")


def with_balls(document):
    """A copy of the scene where a ball of a hundredth of its mass hangs on each single body, at its middle."""
    changed = copy.deepcopy(document)
    held = {name for joint in document.get("joints", []) for name in joint["bodies"]}
    for body in document.get("bodies", []):
        if body["mass"] <= 0 or body["name"] in held:
            continue
        name, place = f"{body['name']} ball", body.get("position", [0, 0, 0])
        ball = {"name": name, "mass": body["mass"] / 100, "position": place}
        ball["shape"] = {"type": "sphere", "radius": (3 * ball["mass"] / (4 * np.pi * 1000)) ** (1 / 3), "faces": 80}
        ball["linear_velocity"] = body.get("linear_velocity", [0, 0, 0])
        changed["bodies"].append(ball)
        changed.setdefault("joints", []).append({"bodies": [body["name"], name], "point": place})
    return changed


def run(scene, minutes, cache):
    """Counts over all bodies, largest speeds [m/s] of the first and the last minute, energy removed [J], sentences."""
    with ba.World(scene, cache=cache) as world:
        speeds = []
        for _ in range(minutes):
            twist = world.run(60, 0.5).twist
            speeds.append(np.linalg.norm(twist[1:, :, 3:], axis=2).max())
        work = [body.work for body in world.bodies.values()]
        removed = sum(one["energy_removed"] for one in work)
        return [sum(one[name] for one in work) for name in COUNTS], speeds[0], speeds[-1], removed, world.warning


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    parser.add_argument("--minutes", type=int, default=10)
    parser.add_argument("--rates", type=float, nargs="+", default=[30, 60, 240], help="[Hz]")
    parser.add_argument("--cache", type=Path, metavar="DIR", help="folder that keeps the solved flow")
    arguments = parser.parse_args()
    print("scene", "rate", "joints", *COUNTS, "first", "last", "removed", "said", sep="\t")
    failed = 0
    for name in arguments.scenes or ba.scene_names():
        original = ba.Scene(name)
        for document, joints in ((original.document, "its own"), (with_balls(original.document), "balls")):
            for rate in arguments.rates:
                changes = {"time_step": 1 / rate, "duration": 1, "output_step": 0.5}
                try:
                    scene = ba.Scene(document, changes, folder=Path(original.file).parent)
                    counts, first, last, removed, said = run(scene, arguments.minutes, arguments.cache)
                    print(name, f"{rate:g}", joints, *counts, f"{first:.3g}", f"{last:.3g}", f"{removed:.3g}", said.replace("\n", "; "), sep="\t", flush=True)
                except (RuntimeError, ValueError) as error:
                    failed = 1
                    print(name, f"{rate:g}", joints, error, sep="\t", flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main())
