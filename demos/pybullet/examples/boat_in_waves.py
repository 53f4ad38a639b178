#!/usr/bin/python3
"""A boat of 2 m and two buoys in two waves; PyBullet takes the boat's mesh for its convex hull. A picture by TinyRenderer."""

import argparse
from pathlib import Path

import numpy as np
import picture
import pybullet as p

import bullet_ambient
from bullet_ambient.pybullet import Fluid, Wave

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("picture", nargs="?", default="out/pybullet_boat.png", type=Path)
arguments = parser.parse_args()

GRAVITY, SECONDS = 9.81, 20
WAVES = [Wave(0.12, 3.2, (-1, 0.3, 0), 0.5), Wave(0.04, 2.1, (-1, -0.8, 0))]
BOAT = Path(bullet_ambient.Scene("boat_in_waves").file).parents[1] / "meshes/boat.obj"


def height(x, y, time):
    """Height of the surface [m]: sum of waves on deep water."""
    total = 0 * x
    for wave in WAVES:
        (dx, dy, _), omega = np.array(wave.direction) / np.linalg.norm(wave.direction), 2 * np.pi / wave.period
        total += wave.amplitude * np.cos(omega**2 / GRAVITY * (dx * x + dy * y) - omega * time + wave.phase)
    return total


def floating(shape, mass, position, centre, colour, **look):
    """Adds a body whose centre of mass is below that of its shape, without PyBullet's own damping."""
    body = p.createMultiBody(mass, shape, p.createVisualShape(rgbaColor=colour, **look), basePosition=position,
                             baseInertialFramePosition=[0, 0, centre])
    p.changeDynamics(body, -1, linearDamping=0, angularDamping=0)
    return body


p.connect(p.DIRECT)
p.setGravity(0, 0, -GRAVITY)
fluid = Fluid()
fluid.water(level=0, waves=WAVES)
hull = p.createCollisionShape(p.GEOM_MESH, fileName=str(BOAT))
boat = floating(hull, 70, [0, 0, 0.02], -0.02, [0.85, 0.3, 0.2, 1], shapeType=p.GEOM_MESH, fileName=str(BOAT))
ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.2)
for x, y in ((1, 1.2), (-1, -1.2)):
    floating(ball, 14, [x, y, 0.1], -0.08, [0.95, 0.8, 0.2, 1], shapeType=p.GEOM_SPHERE, radius=0.2)

heaves, pitches = [], []
for _ in range(240 * SECONDS):
    p.stepSimulation()
    position, attitude = p.getBasePositionAndOrientation(boat)
    heaves.append(position[2])
    pitches.append(p.getMatrixFromQuaternion(attitude)[6])  # sine of the pitch, bow down
later = slice(240 * 5, None)
print("waves of %.2f m amplitude: the boat heaves by %.2f m and pitches by %.1f degrees"
      % (sum(wave.amplitude for wave in WAVES), np.ptp(heaves[later]) / 2, np.degrees(np.ptp(pitches[later]) / 2)))

x, y, _ = position
picture.save(arguments.picture, [x + 0.6, y - 5.4, 2.1], [x - 0.4, y + 0.4, 0], lambda: picture.add_surface(
    [x - 4, y - 2.5], [x + 4, y + 4], lambda x, y: height(x, y, SECONDS)), share=0.5)
