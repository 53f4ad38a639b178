#!/usr/bin/env python3
"""Writes the meshes of the dart and the airship next to this file: a shaft and a hull along x, each with four fins at the
tail, closed and in one piece.

The dart is a union of boxes, cut along the planes of all their sides. The airship is a 4:1 spheroid whose radius jumps
over the fins.
"""

from itertools import product
from math import ceil, cos, pi, sin, sqrt
from pathlib import Path

LENGTH, HALF_WIDTH = 0.3, 0.005  # of the dart's shaft [m]
FIN = dict(chord=0.06, reach=0.045, half_thickness=0.001)
CELL = (0.02, 0.01, 0.01)

SEMI_AXES = 4, 1  # of the hull [m]
HULL_FIN = dict(start=-3.6, end=-2.4, reach=1.3, half_thickness=0.03, slope=0.05)
STATIONS, MERIDIANS = 20, 16


def dart_boxes():
    tail, w, t, reach = -LENGTH / 2, HALF_WIDTH, FIN["half_thickness"], FIN["reach"]
    end = tail + FIN["chord"]
    return [
        ((tail, -w, -w), (-tail, w, w)),
        ((tail, -reach, -t), (end, reach, t)),
        ((tail, -t, -reach), (end, t, reach)),
    ]


def cuts(boxes, axis):
    """Coordinates of all sides, and between them so that no cell is longer than CELL."""
    sides = sorted({corner[axis] for box in boxes for corner in box})
    points = sides[:1]
    for low, high in zip(sides, sides[1:]):
        count = ceil((high - low) / CELL[axis] - 1e-9)
        points += [low + (high - low) * i / count for i in range(1, count + 1)]
    return points


def union_of(boxes):
    """Vertices and triangles of the surface between cells inside and outside."""
    grid = [cuts(boxes, axis) for axis in range(3)]
    index_of, triangles = {}, []

    def is_inside(cell):
        if not all(0 <= cell[axis] < len(grid[axis]) - 1 for axis in range(3)):
            return False
        middle = [(grid[axis][cell[axis]] + grid[axis][cell[axis] + 1]) / 2 for axis in range(3)]
        return any(all(low[a] < middle[a] < high[a] for a in range(3)) for low, high in boxes)

    for cell in product(*(range(len(points) - 1) for points in grid)):
        for axis, step in product(range(3), (-1, 1)):
            beside = [i + step * (a == axis) for a, i in enumerate(cell)]
            if not is_inside(cell) or is_inside(beside):
                continue
            corners = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))[::step]:
                place = list(cell)
                place[axis] += step > 0
                place[(axis + 1) % 3] += u
                place[(axis + 2) % 3] += v
                corners.append(index_of.setdefault(tuple(place), len(index_of)))
            triangles += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
    return [tuple(grid[a][i] for a, i in enumerate(place)) for place in index_of], triangles


def stations():
    """Places along the hull: closer towards its ends, and at the ends of the fins."""
    start, end, slope = (HULL_FIN[key] for key in ("start", "end", "slope"))
    fin_ends = [start - slope, start, end, end + slope]
    smooth = [-SEMI_AXES[0] * cos(pi * i / STATIONS) for i in range(1, STATIONS)]
    return sorted(fin_ends + [x for x in smooth if min(abs(x - end) for end in fin_ends) > 0.03])


def ring(x):
    """Vertices around the hull, five at each fin."""
    radius = SEMI_AXES[1] * sqrt(1 - (x / SEMI_AXES[0]) ** 2)
    top = HULL_FIN["reach"] if HULL_FIN["start"] <= x <= HULL_FIN["end"] else radius
    root = min(HULL_FIN["half_thickness"] / radius, 0.08)
    tip = 0.5 * root * radius / top
    points = []
    for i in range(MERIDIANS):
        fin = ((-root, radius), (-tip, top), (0, top), (tip, top), (root, radius))
        for offset, r in fin if i % 4 == 0 else ((0, radius),):
            angle = 2 * pi * i / MERIDIANS + offset
            points.append((x, r * cos(angle), r * sin(angle)))
    return points


def airship():
    rings = [ring(x) for x in stations()]
    count = len(rings[0])
    vertices = [point for points in rings for point in points] + [(-SEMI_AXES[0], 0, 0), (SEMI_AXES[0], 0, 0)]
    tail, nose = len(vertices) - 2, len(vertices) - 1
    triangles = []
    for i in range(count):
        after = (i + 1) % count
        for first in range(0, tail - count, count):
            p, q, r, s = first + i, first + after, first + count + after, first + count + i
            triangles += [(p, q, r), (p, r, s)]
        triangles += [(tail, after, i), (nose, tail - count + i, tail - count + after)]
    return vertices, triangles


def write(name, what, vertices, triangles):
    lines = [f"# {what}, metres; written by {Path(__file__).name}"]
    lines += ["v %.9g %.9g %.9g" % vertex for vertex in vertices]
    lines += ["f %d %d %d" % tuple(index + 1 for index in triangle) for triangle in triangles]
    (Path(__file__).parent / name).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    write("dart.obj", "A shaft of 30 cm with four fins", *union_of(dart_boxes()))
    write("airship.obj", "A hull of 8 m with four fins", *airship())
