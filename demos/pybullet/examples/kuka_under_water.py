#!/usr/bin/python3
"""A Kuka arm turns under water with limited torque, beside one in air; needs pybullet_data. A picture by TinyRenderer, which takes minutes."""

import argparse
import importlib.util
import sys
from pathlib import Path

import picture
import pybullet as p

from bullet_ambient.pybullet import Fluid

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("picture", nargs="?", default="out/pybullet_kuka.png", type=Path)
arguments = parser.parse_args()
if importlib.util.find_spec("pybullet_data") is None:
    print("SKIPPED: the robot is in pybullet_data, which PyBullet's wheels bring along; it does not import here")
    sys.exit(77)
import pybullet_data  # noqa: E402

p.connect(p.DIRECT)
p.setAdditionalSearchPath(pybullet_data.getDataPath())
p.setGravity(0, 0, -9.81)
fluid = Fluid()
fluid.water(level=100, bounds=[-5, -5, -5, 0, 5, 5])  # the half x < 0 of the world
arms = [p.loadURDF("kuka_iiwa/model.urdf", [x, 0, 0], useFixedBase=True) for x in (-0.7, 0.7)]
for arm in arms:
    for joint in range(7):
        p.setJointMotorControl2(arm, joint, p.POSITION_CONTROL, targetPosition=0.5, force=300, maxVelocity=1e3)
    p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, targetVelocity=3, force=1)
for second in (0.5, 1.0):
    for _ in range(120):
        p.stepSimulation()
    rates = [p.getJointState(arm, 0)[1] for arm in arms]
    print("after %.1f s: first joint at %.2f rad/s in water, %.2f in air" % (second, *rates))
print("inertia of the first joint [kg m^2]: %.3f in water, %.3f in air" % tuple(fluid.mass_matrix(arm)[6, 6] for arm in arms))

picture.save(arguments.picture, [0.2, -2.2, 1.0], [0, 0, 0.6])
