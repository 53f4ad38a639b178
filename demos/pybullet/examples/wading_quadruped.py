#!/usr/bin/python3
"""A robot on four legs trots through water that reaches to its knees, beside one on dry land. A picture by TinyRenderer."""

import argparse
from pathlib import Path

import numpy as np
import picture
import pybullet as p

import bullet_ambient
from bullet_ambient.pybullet import Fluid

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("picture", nargs="?", default="out/pybullet_wader.png", type=Path)
arguments = parser.parse_args()

LEVEL, PERIOD, SECONDS = 0.25, 2 / 3, 4
ROBOT = Path(bullet_ambient.Scene("wader").file).parents[1] / "robots/wader.urdf"

p.connect(p.DIRECT)
p.setGravity(0, 0, -9.81)
ground = [3, 2, 0.05]
p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=ground),
                  p.createVisualShape(p.GEOM_BOX, halfExtents=ground, rgbaColor=[0.6, 0.55, 0.45, 1]),
                  basePosition=[1, 0, -0.05])
fluid = Fluid()
fluid.settings(law="form")  # the law for flat sides
fluid.water(level=LEVEL, bounds=[-5, -2, -1, 5, 0, 5])  # y < 0
robots = [p.loadURDF(str(ROBOT), [0, y, 0.5], flags=p.URDF_USE_INERTIA_FROM_FILE) for y in (-0.7, 0.7)]
for robot, colour in zip(robots, ([0.85, 0.45, 0.15, 1], [0.5, 0.5, 0.55, 1])):
    for link in range(-1, p.getNumJoints(robot)):
        p.changeVisualShape(robot, link, rgbaColor=colour)
        p.changeDynamics(robot, link, linearDamping=0, angularDamping=0)


def drive(robot, time):
    """Two legs on a diagonal swing together, the others half a period later; each knee a quarter before its hip."""
    for joint in range(p.getNumJoints(robot)):
        name = p.getJointInfo(robot, joint)[1].decode()
        turn = 2 * np.pi * time / PERIOD + (0 if name.startswith(("front_left", "rear_right")) else np.pi)
        target = -0.35 + 0.25 * np.sin(turn) if name.endswith("hip") else 0.7 + 0.35 * np.sin(turn - np.pi / 2)
        p.setJointMotorControl2(robot, joint, p.POSITION_CONTROL, targetPosition=target, force=80)


for step in range(240 * SECONDS):
    for robot in robots:
        drive(robot, step / 240)
    p.stepSimulation()
places = [p.getBasePositionAndOrientation(robot)[0] for robot in robots]
print("%.1f m in %.0f s through water, %.1f m on land" % (places[0][0], SECONDS, places[1][0]))

x = places[0][0]
picture.save(arguments.picture, [x + 0.6, -3.2, 1.3], [x, 0, 0.25],
             lambda: picture.add_surface([-2, -2], [4, 0], lambda x, y: LEVEL + 0 * x))
