#!/usr/bin/python3
"""Boxes of a fifth to twice the density of water fall into a pool; a picture by PyBullet's TinyRenderer."""

import argparse
from pathlib import Path

import numpy as np
import picture
import pybullet as p

from bullet_ambient.pybullet import Fluid

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("picture", nargs="?", default="out/pybullet_pool.png", type=Path)
arguments = parser.parse_args()

p.connect(p.DIRECT)
p.setGravity(0, 0, -9.81)
floor = p.createCollisionShape(p.GEOM_BOX, halfExtents=[2, 1, 0.1])
slab = p.createVisualShape(p.GEOM_BOX, halfExtents=[2, 1, 0.1], rgbaColor=[0.55, 0.7, 0.8, 1])
p.createMultiBody(0, floor, slab, basePosition=[0, 0, -1.1])

fluid = Fluid()
fluid.settings(law="form")
fluid.water(level=0)

half = 0.15
shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[half] * 3)
densities = np.array([200, 400, 600, 800, 950, 1100, 2000])
boxes = []
for i, density in enumerate(densities):
    colour = [0.95 - 0.12 * i, 0.35 + 0.05 * i, 0.2 + 0.1 * i, 1]
    look = p.createVisualShape(p.GEOM_BOX, halfExtents=[half] * 3, rgbaColor=colour)
    boxes.append(p.createMultiBody(density * (2 * half) ** 3, shape, look, basePosition=[-1.5 + 0.5 * i, 0, 0.5]))
for _ in range(240 * 10):
    p.stepSimulation()
for box, density in zip(boxes, densities):
    z = p.getBasePositionAndOrientation(box)[0][2]
    print("%5.0f kg/m^3: centre at %6.3f m" % (density, z))

picture.save(arguments.picture, [0, -4.2, 0.7], [0, 0, -0.4], lambda: picture.add_surface([-2, -1], [2, 1]))
