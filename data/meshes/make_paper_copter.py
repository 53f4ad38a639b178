#!/usr/bin/env python3
"""Writes paper_copter_sheet.obj next to this file and prints its mass properties: a paper copter as one folded strip.

A strip of paper hangs in the x-z plane. Its upper half is slit along the middle; the left wing is folded towards +y and
the right one towards -y, both rising from their fold by the coning angle. The folds fall off from the middle, which gives the
wings a pitch. The copter looks the same after half a turn about z. Below the wings the strip narrows to a stem with a paper
clip at its end. No edge has more than two triangles: the flow solver takes open surfaces of zero thickness that do not
branch. Lengths in metres.
"""

from math import cos, pi, radians, sin, sqrt, tan
from pathlib import Path

WING_WIDTH = 0.025  # of one wing: half the strip
WING_LENGTH = 0.08
STEM_WIDTH = 0.02
STEM_LENGTH = 0.05
SHOULDER = 0.3  # share of the way from fold to end in which the strip narrows
CONING = 40  # [degrees]
FOLD = 40  # below the horizontal [degrees]
PAPER = 0.08  # [kg/m^2]
CLIP = 0.0005  # [kg]
ACROSS = 6  # cells across a wing
ALONG_WING = 16
ALONG_STEM = 10


def graded(cells):
    """Shares from 0 to 1, closer together at both ends, where the flow varies most."""
    return [(1 - cos(pi * i / cells)) / 2 for i in range(cells + 1)]


class Sheet:
    def __init__(self):
        self.points, self.triangles, self.number = [], [], {}

    def vertex(self, point):
        key = tuple(round(x, 9) + 0.0 for x in point)
        if key not in self.number:
            self.number[key] = len(self.points)
            self.points.append(key)
        return self.number[key]

    def patch(self, rows):
        """Two triangles per cell of a grid of points."""
        for low, high in zip(rows, rows[1:]):
            for i in range(len(low) - 1):
                a, b, c, d = (self.vertex(p) for p in (low[i], low[i + 1], high[i + 1], high[i]))
                self.triangles += [(a, b, c), (a, c, d)] if i % 2 else [(a, b, d), (b, c, d)]


def wing(side, across, along):
    """Point of a wing at shares of its width, from the middle, and of its length, from the fold."""
    x, length = WING_WIDTH * across, WING_LENGTH * along
    rise = length * sin(radians(CONING)) - x * tan(radians(FOLD))
    return (side * x, -side * length * cos(radians(CONING)), rise)


def stem(across, down):
    """Point of the strip below the folds at a share of its half width, -1 to 1, and of the way from fold to end."""
    half_width = WING_WIDTH + min(down / SHOULDER, 1) * (STEM_WIDTH / 2 - WING_WIDTH)
    fold = WING_WIDTH * abs(across) * tan(radians(FOLD))
    return (half_width * across, 0, -fold - down * (STEM_LENGTH - fold))


def make_sheet():
    sheet = Sheet()
    across, along = graded(ACROSS), graded(ALONG_WING)
    # One side of the paper is below on the right wing, in front on the stem and above on the left wing.
    sheet.patch([[wing(1, i, s) for i in reversed(across)] for s in along])
    sheet.patch([[wing(-1, i, s) for i in across] for s in along])
    shares = [-share for share in reversed(across)] + across[1:]
    rows = sorted({0.0, SHOULDER / 2, *(SHOULDER + (1 - SHOULDER) * t for t in graded(ALONG_STEM - 2))})
    sheet.patch([[stem(share, t) for share in shares] for t in rows])
    return sheet


def mass_properties(sheet):
    """Mass, centre and inertia about it (xx, yy, zz, xy, xz, yz) of the paper with its clip."""
    parts = []  # points with masses: of a triangle the middles of its edges, which is exact
    for triangle in sheet.triangles:
        a, b, c = (sheet.points[v] for v in triangle)
        u, w = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
        cross = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]]
        third = PAPER * sqrt(sum(x * x for x in cross)) / 6
        for p, q in ((a, b), (b, c), (c, a)):
            parts.append((third, [(p[k] + q[k]) / 2 for k in range(3)]))
    parts.append((CLIP, [0, 0, -STEM_LENGTH]))
    mass = sum(m for m, _ in parts)
    centre = [sum(m * p[k] for m, p in parts) / mass for k in range(3)]
    product = lambda i, j: sum(m * (p[i] - centre[i]) * (p[j] - centre[j]) for m, p in parts)
    xx, yy, zz = (product(k, k) for k in range(3))
    return mass, centre, [yy + zz, xx + zz, xx + yy, -product(0, 1), -product(0, 2), -product(1, 2)]


def main():
    sheet = make_sheet()
    lines = ["# A paper copter as one folded strip, metres; written by make_paper_copter.py"]
    lines += ["v " + " ".join(f"{x:.9f}" for x in point) for point in sheet.points]
    lines += ["f " + " ".join(str(v + 1) for v in triangle) for triangle in sheet.triangles]
    (Path(__file__).resolve().parent / "paper_copter_sheet.obj").write_text("\n".join(lines) + "\n")
    mass, centre, inertia = mass_properties(sheet)
    print(f"mass {mass:.6g} kg, centre {[round(x, 6) for x in centre]}, inertia {[float(f'{x:.4g}') for x in inertia]}")


if __name__ == "__main__":
    main()
