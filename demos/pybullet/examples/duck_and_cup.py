#!/usr/bin/python3
"""A duck and a cup of twelve boxes afloat; then the duck is set into the cup, which stays dry. A picture by TinyRenderer."""

import argparse
from pathlib import Path

import numpy as np
import picture
import pybullet as p

from bullet_ambient.pybullet import Fluid

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("picture", nargs="?", default="out/pybullet_duck.png", type=Path)
arguments = parser.parse_args()

DENSITY, SECONDS = 998, 6  # of the water [kg/m^3]; before and after the duck moves
WIDTH, HEIGHT, WALL = 0.216, 0.14, 0.008  # of the cup, which has eight sides [m]
CUP, DUCK = 1.2, 0.07  # [kg]


def add(mass, colour, position, centre, places, **shapes):
    """Adds a body of boxes or balls at places in its frame, without PyBullet's own damping."""
    shape = p.createCollisionShapeArray(collisionFramePositions=places, **shapes)
    look = {name.replace("collisionFrame", "visualFrame"): value for name, value in shapes.items()}
    look = p.createVisualShapeArray(visualFramePositions=places, rgbaColors=[colour] * len(places), **look)
    body = p.createMultiBody(mass, shape, look, basePosition=position, baseInertialFramePosition=centre)
    p.changeDynamics(body, -1, linearDamping=0, angularDamping=0)
    return body


def add_cup(position):
    """Four boxes crosswise are the floor, eight the walls; its frame is in the middle below."""
    half, side = WIDTH / 2, WIDTH / 2 * np.tan(np.pi / 8)
    turns = np.pi / 4 * np.concatenate([np.arange(4), np.arange(8)])
    floor, wall = ([0, 0, WALL / 2], [half, side, WALL / 2]), (half - WALL / 2, [WALL / 2, side, HEIGHT / 2])
    places = [floor[0]] * 4 + [[wall[0] * np.cos(a), wall[0] * np.sin(a), HEIGHT / 2] for a in turns[4:]]
    return add(CUP, [0.9, 0.9, 0.95, 1], position, [0, 0, 0.05], places, shapeTypes=[p.GEOM_BOX] * 12, halfExtents=[floor[1]] * 4 + [wall[1]] * 8,
               collisionFrameOrientations=[[0, 0, np.sin(a / 2), np.cos(a / 2)] for a in turns])


def add_duck(position):
    return add(DUCK, [0.95, 0.8, 0.15, 1], position, [0, 0, -0.01], [[0, 0, 0], [0.022, 0, 0.036]], shapeTypes=[p.GEOM_SPHERE] * 2, radii=[0.03, 0.018])


def draught_of(cup):
    """Depth of the middle of its floor along its axis [m], and the angle of that to the vertical [degrees]."""
    (_, _, z), attitude = p.getBasePositionAndOrientation(cup)
    upright = p.getMatrixFromQuaternion(attitude)[8]
    return 0.05 - z / upright, np.degrees(np.arccos(min(1, upright)))


p.connect(p.DIRECT)
p.setGravity(0, 0, -9.81)
fluid = Fluid()
fluid.water(level=0)
cup, duck = add_cup([0, 0, -0.03]), add_duck([0.25, 0, 0.01])
area = 2 * WIDTH**2 * np.tan(np.pi / 8)
for load, name in ((CUP, "the cup alone"), (CUP + DUCK, "the duck in the cup")):
    for _ in range(240 * SECONDS):
        p.stepSimulation()
    draught, heel = draught_of(cup)
    print("%s: draught %.2f mm, %.2f mm by its weight, heel %.1f degrees" % (name, 1000 * draught, 1000 * load / DENSITY / area, heel))
    if load == CUP:
        print("the duck swims: its middle is %.1f mm above the water" % (1000 * p.getBasePositionAndOrientation(duck)[0][2]))
        x, y, _ = p.getBasePositionAndOrientation(cup)[0]
        p.resetBasePositionAndOrientation(duck, [x + 0.05, y, 0.05], [0, 0, 0, 1])
print("\n".join(fluid.status()["said"]))
x, y, _ = p.getBasePositionAndOrientation(cup)[0]
picture.save(arguments.picture, [x + 0.15, y - 0.45, 0.5], [x, y, 0.02], lambda: picture.add_surface(
    [x - 0.5, y - 0.4], [x + 0.5, y + 0.6], cells=150, is_dry=lambda u, v: np.hypot(u - x, v - y) < WIDTH / 2 - WALL), share=0.4)
