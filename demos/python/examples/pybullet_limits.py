#!/usr/bin/env python3
"""What forces alone lose: bodies that fall freely, by pybullet_forces.py in stock Bullet beside bullet_ambient.

The numbers of docs/python.md. PyBullet itself is not needed: a World in a vacuum is stock Bullet, and DryBullet gives it
the five functions of PyBullet that the forces use.
"""

import numpy as np
from pybullet_forces import FluidForces

import bullet_ambient as ba

STEPS = (1 / 60, 1 / 240, 1 / 960)


class DryBullet:
    """The bodies of a scene in stock Bullet, by PyBullet's names."""

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


def forces_for(scene, client):
    """FluidForces for the one body of a scene."""
    (definition,) = scene.document["bodies"]
    fluid_body = ba.FluidBody.from_shape(definition["shape"], folder=scene.file.rpartition("/")[0])
    per_mass = fluid_body.surface_mass if definition.get("mass_distribution") == "surface" else fluid_body.uniform_mass
    angle = definition.get("separation_angle", np.pi / 2)
    flow = ba.FlowSettings(law=scene.document.get("law", "published"), separation_angle=angle)
    mass = definition["mass"]
    return FluidForces(client, 0, fluid_body, mass, mass * per_mass[1], scene.medium, flow)


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


def compare(name, duration):
    """Distance at the end from the motion at the finest step [m], by forces and by the library, for each step."""
    make = lambda step: ba.Scene(name, {"duration": duration, "time_step": step, "output_step": step})  # noqa: E731
    finest = ba.World(make(1 / 7680)).run(duration, duration).position[-1, 0]
    for step in STEPS:
        ours = ba.World(make(step)).run(duration).position[-1, 0]
        theirs = fall_by_forces(make(step))[-1]
        yield step, np.linalg.norm(theirs - finest), np.linalg.norm(ours - finest), np.linalg.norm(finest)


if __name__ == "__main__":
    print("| scene | fell [m] | step [1/s] | forces alone [m] | bullet_ambient [m] |\n|---|---|---|---|---|")
    for name, duration in (("sphere_fall", 1.0), ("sphere_rise", 1.0), ("plate_8cm", 0.5), ("underwater_ellipsoid", 1.0)):
        for step, forces, ours, fallen in compare(name, duration):
            print(f"| `{name}`, {duration} s | {fallen:.3g} | {1 / step:.0f} | {forces:.2g} | {ours:.2g} |")
