#!/usr/bin/env python3
"""Writes the propeller and the proxy of the paper copter next to this file: two blades in one piece, closed meshes in metres.

Each is a loft from tip to tip along x: sections across x are ellipses whose chord is turned about x by the pitch, one way
on the right and the other way on the left, so that the body looks the same after half a turn about z. The copter's blades
rise towards their tips. Sections end in a point at each tip.
"""

from math import cos, pi, radians, sin, sqrt, tan, tanh
from pathlib import Path

AROUND = 16  # points of a section


class Blades:
    """Shape of a pair of blades; lengths in metres, angles in degrees."""

    def __init__(self, name, span, chord, thickness, pitch, rise, hub, sections):
        self.name, self.span, self.chord, self.thickness = name, span, chord, thickness
        self.pitch, self.rise, self.hub, self.sections = radians(pitch), radians(rise), hub, sections

    def section(self, share):
        """Points of the section at x = share * span / 2, -1 < share < 1."""
        x = share * self.span / 2
        # Round tips: full width but for the last tenths.
        taper = sqrt(1 - share**8)
        pitch = self.pitch * tanh(2 * x / self.hub)
        height = tan(self.rise) * (sqrt(x * x + self.hub**2 / 4) - self.hub / 2)
        points = []
        for i in range(AROUND):
            angle = 2 * pi * i / AROUND
            a, b = self.chord / 2 * taper * cos(angle), self.thickness / 2 * taper * sin(angle)
            points.append((x, a * cos(pitch) - b * sin(pitch), a * sin(pitch) + b * cos(pitch) + height))
        return points

    def tip(self, side):
        x = self.span / 2
        height = tan(self.rise) * (sqrt(x * x + self.hub**2 / 4) - self.hub / 2)
        return (side * x, 0, height)

    def mesh(self):
        """Vertices, and triangles counter-clockwise from outside."""
        # Closer together towards the tips.
        shares = [sin(pi / 2 * (2 * (i + 1) / (self.sections + 1) - 1)) for i in range(self.sections)]
        vertices = [point for share in shares for point in self.section(share)]
        left, right = len(vertices), len(vertices) + 1
        vertices += [self.tip(-1), self.tip(1)]
        triangles = []
        last = (self.sections - 1) * AROUND
        for i in range(AROUND):
            j = (i + 1) % AROUND
            triangles.append((left, j, i))
            triangles.append((right, last + i, last + j))
            for row in range(0, last, AROUND):
                a, b, c, d = row + i, row + j, row + AROUND + i, row + AROUND + j
                triangles += [(a, b, d), (a, d, c)]
        return vertices, triangles


SHAPES = (
    Blades("propeller", span=0.18, chord=0.022, thickness=0.004, pitch=20, rise=0, hub=0.02, sections=31),
    Blades("paper_copter_proxy", span=0.16, chord=0.03, thickness=0.005, pitch=30, rise=45, hub=0.02, sections=31),
)


def write(folder, shape):
    vertices, triangles = shape.mesh()
    lines = [f"# Two blades of {shape.span * 100:g} cm from tip to tip, metres; written by make_blades.py"]
    for point in vertices:
        # Adding zero turns -0.0 into 0.0.
        lines.append("v " + " ".join(f"{round(x, 9) + 0:.9f}" for x in point))
    lines += ["f " + " ".join(str(index + 1) for index in triangle) for triangle in triangles]
    (folder / f"{shape.name}.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    for blades in SHAPES:
        write(Path(__file__).resolve().parent, blades)
