#!/usr/bin/python3
"""The moving picture of water in the README: a hundred boxes fall into a pool, seen from the side, in real time.

Light boxes are bright, boxes denser than water dark. Needs python3-pil.
"""

import argparse

import numpy as np
from PIL import Image, ImageDraw

import bullet_ambient as ba

SCENE, DURATION, FRAMES_PER_SECOND = "pool", 8, 12.5
WIDTH, HEIGHT, VIEW, MIDDLE = 690, 400, 4.4, 0.1  # size of the picture [pixels], its width and the height of its middle [m]
FINER = 2  # factor by which pictures are drawn larger and then scaled down, for smooth edges
WATER_DENSITY = 998.0
AIR, WATER, STONE, EDGE = (246, 249, 252), (70, 130, 180, 110), (150, 150, 150), (60, 50, 40)
LIGHT, HEAVY = np.array((245, 200, 120)), np.array((110, 60, 40))
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2


def turned(q, points):
    """Points (N, 3) turned by a unit quaternion (w, x, y, z)."""
    w, u = q[0], q[1:]
    t = 2 * np.cross(u, points)
    return points + w * t + np.cross(u, t)


def outline(points):
    """The convex hull of points (N, 2), counter-clockwise."""
    points = sorted(map(tuple, points))
    hull = []
    for way in (points, points[::-1]):
        chain = []
        for p in way:
            while len(chain) > 1 and np.cross(np.subtract(chain[-1], chain[-2]), np.subtract(p, chain[-2])) <= 0:
                chain.pop()
            chain.append(p)
        hull += chain[:-1]
    return hull


def colour_of(body):
    density = body["mass"] / np.prod(body["shape"]["size"])
    share = np.clip(density / WATER_DENSITY - 0.3, 0, 1)
    return tuple((LIGHT + share * (HEAVY - LIGHT)).astype(int))


def draw(definition, motion, now):
    size = np.array([WIDTH, HEIGHT]) * FINER
    scale = size[0] / VIEW
    image = Image.new("RGB", tuple(size), AIR)
    pen = ImageDraw.Draw(image, "RGBA")
    place = lambda p: tuple((np.asarray(p) - (0, MIDDLE)) * (scale, -scale) + size / 2)  # noqa: E731
    bodies = definition["bodies"]
    far_to_near = np.argsort(-motion.position[now, :, 1])
    for i in far_to_near:
        if bodies[i]["mass"] == 0:
            continue
        corners = turned(motion.orientation[now, i], CORNERS * bodies[i]["shape"]["size"])
        hull = motion.position[now, i, ::2] + outline(corners[:, ::2])
        pen.polygon([place(p) for p in hull], fill=colour_of(bodies[i]), outline=EDGE)
    level = place((0, definition["water"]["level"]))[1]
    pen.rectangle([0, level, size[0], size[1]], fill=WATER)
    for body in bodies[:3]:  # the floor, and the walls on both sides
        half = np.array(body["shape"]["size"]) / 2
        low, high = body["position"] - half, body["position"] + half
        pen.rectangle([*place((low[0], high[2])), *place((high[0], low[2]))], fill=STONE)
    return image.resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)


def main(file):
    scene = ba.Scene(SCENE)
    motion = ba.World(scene).run(DURATION, 1 / FRAMES_PER_SECOND)
    frames = [draw(scene.document, motion, now).quantize(24, dither=Image.Dither.NONE) for now in range(len(motion.t))]
    frames[0].save(file, save_all=True, append_images=frames[1:], duration=round(1000 / FRAMES_PER_SECOND), loop=0,
                   optimize=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", metavar="FILE.gif")
    main(parser.parse_args().file)
