#!/usr/bin/python3
"""Errors of a fluid by forces alone: bodies that fall freely, by pybullet_forces.py in stock Bullet beside bullet_ambient.

The numbers of docs/python.md. PyBullet itself is not needed: a World in a vacuum is stock Bullet, and DryBullet gives it
the five functions of PyBullet that the forces use.
"""

import argparse

import numpy as np
from pybullet_forces import FluidForces

import bullet_ambient as ba

STEPS = (1 / 60, 1 / 240, 1 / 960)  # [s]
FINEST = 1 / 7680


class DryBullet:
    """Bodies of a scene in stock Bullet, with functions named as in PyBullet."""

    WORLD_FRAME = 2

    def __init__(self, scene):
        self.world = ba.World(scene.replace({"model": "vacuum"}))
        self.bodies = list(self.world.bodies.values())

    def getBasePositionAndOrientation(self, body):
        w, x, y, z = self.bodies[body].orientation
        return self.bodies[body].position, (x, y, z, w)

    def getBaseVelocity(self, body):
        twist = self.bodies[body].twist
        return twist[3:], twist[:3]

    def applyExternalForce(self, body, link, force, position, frame):
        self.bodies[body].apply_force(force, at=position)

    def applyExternalTorque(self, body, link, torque, frame):
        self.bodies[body].apply_torque(torque)

    def stepSimulation(self):
        self.world.step()


def forces_for(scene, client, body=0):
    """FluidForces for a body of a scene."""
    definition = scene.document["bodies"][body]
    fluid_body = ba.FluidBody.from_shape(definition["shape"], folder=scene.file.rpartition("/")[0])
    per_mass = fluid_body.surface_mass if definition.get("mass_distribution") == "surface" else fluid_body.uniform_mass
    angle = definition.get("separation_angle", np.pi / 2)
    flow = ba.FlowSettings(law=scene.document.get("law", "published"), separation_angle=angle)
    mass = definition["mass"]
    gravity = scene.document.get("gravity", (0, 0, -9.81))
    return FluidForces(client, body, fluid_body, mass, mass * per_mass[1], scene.medium, flow, gravity)


def fall_by_forces(scene):
    """Positions after each step, (steps, 3) [m]; NaN from where a state is not finite."""
    client = DryBullet(scene)
    forces = forces_for(scene, client)
    path = np.full((round(scene.duration / scene.time_step), 3), np.nan)
    for place in path:
        try:
            forces.apply()
            client.stepSimulation()
        except (FloatingPointError, ValueError):
            break
        place[:] = client.getBasePositionAndOrientation(0)[0]
    return path


def distances(name, duration, step):
    """Distances at the end from the motion with the finest step, by forces and by the library; and length of the motion [m]."""
    make = lambda step: ba.Scene(name, {"duration": duration, "time_step": step, "output_step": step})  # noqa: E731
    finest = ba.World(make(FINEST)).run(duration, duration).position[-1, 0]
    ours = ba.World(make(step)).run(duration).position[-1, 0]
    forces = fall_by_forces(make(step))[-1]
    return tuple(np.linalg.norm(path) for path in (forces - finest, ours - finest, finest))


def collision():
    """Velocities [m/s] of a ball that is hit in water by a lighter one at 1 m/s: by forces, and by the library."""
    ball = {"shape": {"type": "sphere", "radius": 0.1}, "restitution": 1}
    light = {**ball, "name": "light", "mass": 0.4189, "linear_velocity": [1, 0, 0]}  # carries five times its own mass
    heavy = {**ball, "name": "heavy", "mass": 4.189, "position": [0.201, 0, 0]}
    scene = ba.Scene({"duration": 1, "time_step": 1 / 960, "gravity": [0, 0, 0], "medium": {"density": 1000}, "bodies": [light, heavy]})
    client, world = DryBullet(scene), ba.World(scene)
    forces = [forces_for(scene, client, body) for body in (0, 1)]
    for _ in range(5):
        for force in forces:
            force.apply()
        client.stepSimulation()
        world.step()
    return client.world.twist[1, 3], world.twist[1, 3]


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    print("| scene | fell [m] | step [1/s] | forces alone [m] | bullet_ambient [m] |\n|---|---|---|---|---|")
    for name, duration in (("sphere_fall", 1.0), ("sphere_rise", 1.0), ("plate_8cm", 0.5), ("underwater_ellipsoid", 1.0)):
        for step in STEPS:
            forces, ours, fallen = distances(name, duration, step)
            print(f"| `{name}`, {duration} s | {fallen:.3g} | {1 / step:.0f} | {forces:.2g} | {ours:.2g} |")
    print("a ball in water that is hit by a lighter one at 1 m/s leaves at {:.2f} m/s, by bullet_ambient at {:.2f}".format(*collision()))
