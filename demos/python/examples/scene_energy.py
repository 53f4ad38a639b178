#!/usr/bin/python3
"""Energy of bodies and fluid with weight and buoyancy, over a scene of bodies that begin and end at rest.

Over that at the end: at the start and every second; and the largest rise above any earlier value. By both pressure laws.
For bodies of uniform density that have their origin in the middle.
"""

import argparse
from pathlib import Path

import numpy as np

import bullet_ambient as ba

SCENES = Path(ba.Scene("leaves").file).parent


def in_body_axes(orientation, vectors):
    """Vectors (T, 3) in world axes, by unit quaternions w, x, y, z."""
    w, axis = orientation[:, :1], -orientation[:, 1:]
    return vectors + 2 * np.cross(axis, np.cross(axis, vectors) + w * vectors)


def energy(scene, motion):
    """Energy (T,) [J]."""
    fluid = scene.medium.density
    total = np.zeros(len(motion.t))
    known = {}
    for i, body in enumerate(scene.document["bodies"]):
        if body["mass"] == 0:
            continue
        shape = str(body["shape"])
        if shape not in known:
            known[shape] = ba.FluidBody.from_shape(body["shape"], folder=SCENES)
        fluid_body, mass = known[shape], body["mass"]
        inertia = fluid * fluid_body.added_mass
        inertia[:3, :3] += mass * fluid_body.uniform_mass[1]
        inertia[3:, 3:] += mass * np.eye(3)
        parts = (motion.angular_velocity[:, i], motion.linear_velocity[:, i])
        twist = np.hstack([in_body_axes(motion.orientation[:, i], part) for part in parts])
        weight = (mass - fluid * fluid_body.volume) * np.array(scene.document["gravity"])
        total += 0.5 * np.einsum("ti,ij,tj->t", twist, inertia, twist) - motion.position[:, i] @ weight
    return total


def rise(values):
    """Largest rise of a value above the lowest value before it."""
    return np.max(values - np.minimum.accumulate(values))


def main(name):
    for law in ("published", "form"):
        scene = ba.Scene(name).replace({"law": law})
        motion = ba.World(scene).run(scene.duration, scene.output_step)
        values = energy(scene, motion)
        seconds = [values[np.searchsorted(motion.t, t - 1e-9)] for t in range(int(scene.duration) + 1)]
        over = " ".join(f"{value:.2g}" for value in np.array(seconds) - values[-1])
        print(f"{name}, {law}: {over} J; rises by {rise(values):.2g} J")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", metavar="SCENE", help="a name of data/scenes")
    main(parser.parse_args().scene)
