#!/usr/bin/python3
"""Time of a step of PyBullet with 100 boxes that rest apart, in stock PyBullet and under water, by turns in one run."""

import argparse
import time

import pybullet as p

from bullet_ambient.pybullet import Fluid

argparse.ArgumentParser(description=__doc__).parse_args()


def scene(with_fluid):
    client = p.connect(p.DIRECT)
    fluid = Fluid(client)
    if with_fluid:
        fluid.water(level=100)
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1], physicsClientId=client)
    for i in range(100):
        p.createMultiBody(7.9, shape, basePosition=[i % 10, i // 10, 0], physicsClientId=client)
    return client


def cost(client, steps=40):
    begin = time.process_time()
    for _ in range(steps):
        p.stepSimulation(physicsClientId=client)
    return (time.process_time() - begin) / steps * 1e6


stock, wet = scene(False), scene(True)
times = [(cost(stock), cost(wet)) for _ in range(25)]
print("us per step: stock %.0f, in water %.0f" % tuple(min(column) for column in zip(*times)))
