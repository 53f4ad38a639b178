#!/usr/bin/env python3
"""Writes the meshes of the boat and the wedge next to this file: an open sea hull of parabolas with a deck, bow along x,
and a prism whose keel lies along x. Both are closed."""

from math import pi, tan
from pathlib import Path

LENGTH, BEAM, DEPTH, FREEBOARD = 2.0, 0.5, 0.2, 0.15  # of the boat [m]; z = 0 where its sides get upright
STATIONS, WATERLINES = 24, 6
WEDGE = dict(length=1.2, beam=0.6, deadrise=25, side=0.15)  # [m], [degrees]
WEDGE_CELLS, EDGE_CELLS = 12, 3  # along the keel, along each edge of a section


def boat():
    """Rows of points from the keel up, for each station; port and starboard, and a deck."""
    levels = [-DEPTH + DEPTH * i / WATERLINES for i in range(WATERLINES + 1)] + [FREEBOARD / 2, FREEBOARD]

    def half_breadth(x, z):
        return BEAM / 2 * (1 - (2 * x / LENGTH) ** 2) * (1 - (min(z, 0) / DEPTH) ** 2)

    vertices, index = [], {}

    def vertex(i, j, side):
        x, z = LENGTH * (i / STATIONS - 0.5), levels[j]
        y = side * half_breadth(x, z)
        key = (i, j, side if abs(y) > 1e-9 else 0)
        if key not in index:
            index[key] = len(vertices)
            vertices.append((x, y if key[2] else 0.0, z))
        return index[key]

    faces = []

    def quad(a, b, c, d):
        # Along the diagonal that does not join two points of the stem.
        halves = ((a, b, c), (a, c, d)) if i < STATIONS // 2 else ((a, b, d), (b, c, d))
        for triangle in halves:
            if len(set(triangle)) == 3:
                faces.append(triangle)

    top = len(levels) - 1
    for i in range(STATIONS):
        for j in range(top):
            quad(*(vertex(i + k, j + l, -1) for k, l in ((0, 0), (1, 0), (1, 1), (0, 1))))
            quad(*(vertex(i + k, j + l, 1) for k, l in ((0, 1), (1, 1), (1, 0), (0, 0))))
        quad(vertex(i, top, -1), vertex(i + 1, top, -1), vertex(i + 1, top, 1), vertex(i, top, 1))
    return vertices, faces


def wedge():
    """Slices of a pentagon along x, closed by a fan at both ends."""
    half, rise = WEDGE["beam"] / 2, WEDGE["beam"] / 2 * tan(WEDGE["deadrise"] * pi / 180)
    pentagon = [(0, 0), (half, rise), (half, rise + WEDGE["side"]), (-half, rise + WEDGE["side"]), (-half, rise)]
    section = []
    for (y, z), (y_next, z_next) in zip(pentagon, pentagon[1:] + pentagon[:1]):
        for share in (k / EDGE_CELLS for k in range(EDGE_CELLS)):
            section.append((y + share * (y_next - y), z + share * (z_next - z)))
    corners, n = len(section), WEDGE_CELLS
    vertices = [(WEDGE["length"] * (i / n - 0.5), y, z) for i in range(n + 1) for y, z in section]
    vertices += [(side * WEDGE["length"] / 2, 0, rise) for side in (-1, 1)]
    faces = []
    for k in range(corners):
        after = (k + 1) % corners
        for i in range(n):
            a, b = i * corners + k, i * corners + after
            faces += [(a, a + corners, b + corners), (a, b + corners, b)]
        faces += [(len(vertices) - 2, k, after), (len(vertices) - 1, n * corners + after, n * corners + k)]
    return vertices, orient(vertices, faces)


def orient(vertices, faces):
    """Outwards: a positive volume."""
    volume = 0.0
    for a, b, c in ((vertices[i] for i in face) for face in faces):
        volume += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    return faces if volume > 0 else [face[::-1] for face in faces]


def write(name, mesh):
    vertices, faces = mesh
    lines = [f"# {name}, metres; written by make_floating_bodies.py"]
    lines += ["v " + " ".join(f"{c:.6g}" for c in v) for v in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    (Path(__file__).parent / f"{name}.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    hull, sides = boat()
    write("boat", (hull, orient(hull, sides)))
    write("wedge", wedge())
