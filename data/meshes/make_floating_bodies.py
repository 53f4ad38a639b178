#!/usr/bin/env python3
"""Writes the meshes of floating bodies next to this file: the boat, an open sea hull of parabolas with a deck, bow along x;
the wedge, a prism whose keel lies along x; and bodies of docs/reality_at_sea.md: a section of a ship and a wedge, ten
breadths long, keel along x, and cylinders with a cone below. All are closed."""

from math import cos, pi, sin, tan
from pathlib import Path

LENGTH, BEAM, DEPTH, FREEBOARD = 2.0, 0.5, 0.2, 0.15  # of the boat [m]; z = 0 where its sides get upright
STATIONS, WATERLINES = 24, 6
WEDGE = dict(length=1.2, beam=0.6, deadrise=25, side=0.15)  # [m], [degrees]
WEDGE_CELLS, EDGE_CELLS = 12, 3  # along the keel, along each edge of a section
MEASURED_WEDGE = dict(length=12.0, beam=1.2, deadrise=25, side=0.3)  # Yettou et al. 2006
SHIP_SECTION = dict(length=4.0, beam=0.4, depth=0.256, bilge=0.0512)  # Sundsdal et al. 2025
CONE_BODY = dict(radius=0.026, height=0.265)  # Boom et al. 2024


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


def wedge(length, beam, deadrise, side):
    half, rise = beam / 2, beam / 2 * tan(deadrise * pi / 180)
    pentagon = [(0, 0), (half, rise), (half, rise + side), (-half, rise + side), (-half, rise)]
    return prism(divided(pentagon, EDGE_CELLS), rise, length)


def ship_section(length, beam, depth, bilge):
    """Upright sides, a flat bottom at z = 0, and round bilges of this radius."""
    arc = [(beam / 2 - bilge * (1 - sin(i * pi / 8)), bilge * (1 - cos(i * pi / 8))) for i in range(5)]
    half = arc + [(beam / 2, depth)]
    return prism(divided(half + [(-y, z) for y, z in half[::-1]], 2), depth / 2, length)


def cone_body(half_angle, radius, height):
    """Cylinder along z with a cone below, its apex at the origin."""
    tip, turns = radius / tan(half_angle * pi / 180), 24
    profile = [(radius * i / 6, tip * i / 6) for i in range(1, 7)]
    profile += [(radius, tip + height * i / 8) for i in range(1, 9)]
    profile += [(radius * i / 4, tip + height) for i in (3, 2, 1)]
    rings = [[(r * cos(2 * pi * k / turns), r * sin(2 * pi * k / turns), z) for k in range(turns)] for r, z in profile]
    vertices = [(0, 0, 0)] + [point for ring in rings for point in ring] + [(0, 0, tip + height)]
    faces = []
    for k in range(turns):
        after = (k + 1) % turns
        for i in range(len(rings) - 1):
            below, above = 1 + i * turns, 1 + (i + 1) * turns
            faces += [(below + k, below + after, above + after), (below + k, above + after, above + k)]
        faces += [(0, 1 + after, 1 + k), (len(vertices) - 1, len(vertices) - 1 - turns + k, len(vertices) - 1 - turns + after)]
    return vertices, orient(vertices, faces)


def divided(corners, cells):
    """A closed line with each edge in equal cells."""
    line = []
    for (y, z), (y_next, z_next) in zip(corners, corners[1:] + corners[:1]):
        line += [(y + k / cells * (y_next - y), z + k / cells * (z_next - z)) for k in range(cells)]
    return line


def prism(section, middle, length):
    """Slices of a section along x, closed at both ends by a fan about the height `middle`."""
    corners, n = len(section), WEDGE_CELLS
    vertices = [(length * (i / n - 0.5), y, z) for i in range(n + 1) for y, z in section]
    vertices += [(side * length / 2, 0, middle) for side in (-1, 1)]
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
    write("wedge", wedge(**WEDGE))
    write("measured_wedge", wedge(**MEASURED_WEDGE))
    write("ship_section", ship_section(**SHIP_SECTION))
    for half_angle in (45, 60):
        write(f"cone_{half_angle}", cone_body(half_angle, **CONE_BODY))
