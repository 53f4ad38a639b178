#!/usr/bin/env python3
"""Writes the plate meshes of the falling-plate scenes next to this file: oblate spheroids, five times as wide as thick.

Each is an icosahedron with its edges divided in seven (980 faces, 492 vertices), projected from its centre onto the
unit sphere and stretched. The icosahedron's mirror planes are the coordinate planes, so a plate released without spin
has nothing that drives it out of its plane.
"""

from math import sqrt
from pathlib import Path

DIVISIONS = 7
DIAMETERS_CM = (8, 9, 10)
SLENDERNESS = 5

GOLDEN = (1 + sqrt(5)) / 2
CORNERS = [
    corner
    for a in (-1, 1)
    for b in (-GOLDEN, GOLDEN)
    for corner in ((0, a, b), (a, b, 0), (b, 0, a))
]


def distance_squared(p, q):
    return sum((a - b) ** 2 for a, b in zip(p, q))


def icosahedron_faces():
    """Corner indices of the 20 faces, counter-clockwise from outside. Edges have length 2."""
    near = lambda i, j: abs(distance_squared(CORNERS[i], CORNERS[j]) - 4) < 1e-9
    count = len(CORNERS)
    faces = []
    for i in range(count):
        for j in range(i + 1, count):
            for k in range(j + 1, count):
                if near(i, j) and near(j, k) and near(i, k):
                    p, q, r = (CORNERS[index] for index in (i, j, k))
                    volume = (
                        p[0] * (q[1] * r[2] - q[2] * r[1])
                        - p[1] * (q[0] * r[2] - q[2] * r[0])
                        + p[2] * (q[0] * r[1] - q[1] * r[0])
                    )
                    faces.append((i, j, k) if volume > 0 else (i, k, j))
    return faces


def unit_sphere():
    """Vertices on the unit sphere and triangles."""
    vertices, index_of, triangles = [], {}, []

    def vertex(face, i, j):
        weights = (DIVISIONS - i - j, i, j)
        # The same sum in the same order for every face that shares the point.
        corners = sorted(zip(face, weights))
        key = tuple((corner, weight) for corner, weight in corners if weight)
        if key not in index_of:
            point = [sum(weight * CORNERS[corner][axis] for corner, weight in key) for axis in range(3)]
            length = sqrt(sum(x * x for x in point))
            index_of[key] = len(vertices)
            vertices.append([x / length for x in point])
        return index_of[key]

    for face in icosahedron_faces():
        for i in range(DIVISIONS):
            for j in range(DIVISIONS - i):
                triangles.append((vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1)))
                if i + j < DIVISIONS - 1:
                    triangles.append(
                        (vertex(face, i + 1, j), vertex(face, i + 1, j + 1), vertex(face, i, j + 1))
                    )
    return vertices, triangles


def write_plate(folder, diameter_cm):
    radius = diameter_cm / 200
    axes = (radius, radius, radius / SLENDERNESS)
    vertices, triangles = unit_sphere()
    lines = [f"# Oblate spheroid, {diameter_cm} cm x {diameter_cm / SLENDERNESS:g} cm, metres; written by make_plates.py"]
    for point in vertices:
        # Adding zero turns -0.0 into 0.0.
        lines.append("v " + " ".join(f"{round(x * a, 9) + 0:.9f}" for x, a in zip(point, axes)))
    lines += ["f " + " ".join(str(index + 1) for index in triangle) for triangle in triangles]
    (folder / f"plate_{diameter_cm}cm.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    for diameter in DIAMETERS_CM:
        write_plate(Path(__file__).resolve().parent, diameter)
