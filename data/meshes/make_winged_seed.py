#!/usr/bin/env python3
"""Writes winged_seed.obj next to this file and prints its mass properties: the samara of a maple, one closed thin mesh.

The nut lies at the low end of x, the wing extends along +x, its leading edge towards +y, its upper side towards +z.
Sections across x are ellipses, thick at the nut and thin on the wing. The nut is heavy, the wing light, with a vein along
its leading edge. Lengths in metres.
"""

from math import cos, pi, radians, sin, sqrt, tan
from pathlib import Path

AROUND = 12  # points of a section
SECTIONS = 38
LENGTH = 0.040
# Share of the length; leading edge, trailing edge, thickness [mm]. The nut ends at NUT_END, the wing begins at WING_START.
NUT_ROWS = ((0.00, 2.8, -2.8, 3.6), (0.12, 3.0, -3.0, 4.0), (0.22, 2.6, -2.6, 2.4))
WING_ROWS = (
    (0.32, 3.0, -3.4, 0.9),
    (0.45, 3.2, -4.8, 0.5),
    (0.65, 3.2, -7.6, 0.5),
    (0.85, 2.6, -8.2, 0.5),
    (1.00, 1.0, -7.2, 0.5),
)
NUT_Y, NUT_Z = -6.8, -1.15  # of the nut's middle [mm]
PITCH = -5.6  # of the wing, leading edge up [degrees]
RISE = -3.7  # of the wing towards its tip [degrees]
MASS = 1.0e-4  # [kg]
NUT_SHARE = 0.55  # of the mass
VEIN_SHARE = 0.75  # of the wing's mass, along its leading edge
NUT_SEMI_AXES = (0.005, 0.003, 0.002)
ROOT = 0.2  # share of the length where the wing grows out of the nut


def rows():
    nut = tuple((share, leading + NUT_Y, trailing + NUT_Y, thickness) for share, leading, trailing, thickness in NUT_ROWS)
    return nut + WING_ROWS


def outline(share):
    """Leading edge, trailing edge and thickness [m] on straight lines between the rows, rounded at both ends."""
    for low, high in zip(rows(), rows()[1:]):
        if share <= high[0]:
            t = (share - low[0]) / (high[0] - low[0])
            leading, trailing, thickness = (1e-3 * (a + t * (b - a)) for a, b in zip(low[1:], high[1:]))
            break
    # Quarter ellipses.
    beyond = max(0, 1 - share / 0.1, (share - 0.85) / 0.15)
    end = sqrt(1 - min(beyond, 1) ** 2)
    middle, half = (leading + trailing) / 2, (leading - trailing) / 2
    return middle + end * half, middle - end * half, end * thickness


def place(share, y, z):
    """A point of the flat seed in its pitched and rising shape; the nut keeps its place."""
    wing = min(max((share - ROOT) / 0.15, 0), 1)
    pitch = wing * radians(PITCH)
    height = (1 - wing) * 1e-3 * NUT_Z + max(0, share - ROOT) * LENGTH * tan(radians(RISE))
    return (share * LENGTH, y * cos(pitch) - z * sin(pitch), y * sin(pitch) + z * cos(pitch) + height)


def section(share):
    leading, trailing, thickness = outline(share)
    middle, half = (leading + trailing) / 2, (leading - trailing) / 2
    angles = [2 * pi * i / AROUND for i in range(AROUND)]
    return [place(share, middle + half * cos(angle), thickness / 2 * sin(angle)) for angle in angles]


def make_mesh():
    shares = [(1 - cos(pi * (i + 1) / (SECTIONS + 1))) / 2 for i in range(SECTIONS)]
    points = [point for share in shares for point in section(share)]
    ends = [len(points), len(points) + 1]
    for share in (0, 1):
        corner = [sum(p[k] for p in section(share)) / AROUND for k in range(3)]
        points.append(tuple(corner))
    triangles, last = [], (SECTIONS - 1) * AROUND
    for i in range(AROUND):
        j = (i + 1) % AROUND
        triangles += [(ends[0], j, i), (ends[1], last + i, last + j)]
        for row in range(0, last, AROUND):
            a, b, c, d = row + i, row + j, row + AROUND + i, row + AROUND + j
            triangles += [(a, b, d), (a, d, c)]
    return points, triangles


def wing_parts():
    """Masses and points of the wing: a vein along the leading edge and a membrane of even weight per area."""
    cells, vein, membrane = 60, [], []
    for i in range(cells):
        share = ROOT + (1 - ROOT) * (i + 0.5) / cells
        leading, trailing, _ = outline(share)
        vein.append((1, place(share, leading, 0)))
        for j in range(10):
            y = trailing + (leading - trailing) * (j + 0.5) / 10
            membrane.append((leading - trailing, place(share, y, 0)))
    for parts, share in ((vein, VEIN_SHARE), (membrane, 1 - VEIN_SHARE)):
        total = sum(weight for weight, _ in parts)
        yield from ((MASS * (1 - NUT_SHARE) * share * weight / total, point) for weight, point in parts)


def mass_properties():
    """Mass, centre and inertia about it: xx, yy, zz, xy, xz, yz."""
    parts = list(wing_parts())
    nut = MASS * NUT_SHARE
    middle = (NUT_SEMI_AXES[0], 1e-3 * NUT_Y, 1e-3 * NUT_Z)
    # Six points with the moments of a uniform ellipsoid.
    for k in range(3):
        for side in (-1, 1):
            offset = [side * NUT_SEMI_AXES[k] * sqrt(0.6) if i == k else 0 for i in range(3)]
            parts.append((nut / 6, [middle[i] + offset[i] for i in range(3)]))
    mass = sum(m for m, _ in parts)
    centre = [sum(m * p[k] for m, p in parts) / mass for k in range(3)]
    product = lambda i, j: sum(m * (p[i] - centre[i]) * (p[j] - centre[j]) for m, p in parts)
    xx, yy, zz = (product(k, k) for k in range(3))
    return mass, centre, [yy + zz, xx + zz, xx + yy, -product(0, 1), -product(0, 2), -product(1, 2)]


def main():
    points, triangles = make_mesh()
    lines = ["# The winged seed of a maple, metres; written by make_winged_seed.py"]
    lines += ["v " + " ".join(f"{round(x, 9) + 0.0:.9f}" for x in point) for point in points]
    lines += ["f " + " ".join(str(v + 1) for v in triangle) for triangle in triangles]
    (Path(__file__).resolve().parent / "winged_seed.obj").write_text("\n".join(lines) + "\n")
    mass, centre, inertia = mass_properties()
    print(f"mass {mass:.6g} kg, centre {[round(x, 7) for x in centre]}, inertia {[float(f'{x:.4g}') for x in inertia]}")


if __name__ == "__main__":
    main()
