#!/usr/bin/python3
"""Variants of the form law that were tried and not taken, by sums over bodies of revolution and plates: form_variants.py

Prints coefficients by eq. (43) of docs/theory.md beside those of each variant; docs/reality.md says what follows.
"""

import numpy as np

WINDWARD, LEE = 1.05, 0.12  # b and e
DRAG = WINDWARD + LEE
ACROSS = 180  # points around a meridian


def sharpness(x):
    """(45), of curvatures over that of the sphere of the same area."""
    return ((1 - x**2) / (1 + x**2)) ** 2


class Revolution:
    """Points (3, N, M) on a body about the x axis with its largest radius 1, from its meridian.

    x, r: places [m]; nx, nr: outward normals; ds: lengths [m]; bend: curvature of the meridian [1/m]; all (N,)."""

    def __init__(self, x, r, nx, nr, ds, bend):
        angle = 2 * np.pi * (np.arange(ACROSS) + 0.5) / ACROSS
        around = np.ones(ACROSS)
        self.place = np.stack([np.outer(x, around), np.outer(r, np.cos(angle)), np.outer(r, np.sin(angle))])
        self.normal = np.stack([np.outer(nx, around), np.outer(nr, np.cos(angle)), np.outer(nr, np.sin(angle))])
        self.area = np.outer(r * ds, around) * 2 * np.pi / ACROSS
        radius = np.sqrt(self.area.sum() / (4 * np.pi))
        self.along, self.around = np.outer(bend, around) * radius, np.outer(nr / r, around) * radius
        self.hoop = np.stack([0 * self.area, np.outer(0 * x, 0 * angle) - np.sin(angle), np.cos(angle) + 0 * self.area])

    def sharpness(self, velocity, follows_slip):
        """Of the largest curvature; where that is above the sphere's, of the curvature along the slip instead."""
        largest = np.maximum(self.along, self.around)
        if not follows_slip:
            return sharpness(largest)
        slip = velocity[:, None, None] - np.tensordot(velocity, self.normal, 1) * self.normal
        share = (slip * self.hoop).sum(0) ** 2 / np.maximum((slip**2).sum(0), 1e-30)
        along_slip = share * self.around + (1 - share) * self.along
        return np.where(largest <= 1, sharpness(largest), np.where(along_slip > 1, sharpness(along_slip), 0))

    def force(self, velocity, follows_slip=False):
        """(44) over the dynamic pressure, for a unit velocity [m^2]."""
        velocity = np.asarray(velocity, float)
        s = self.sharpness(velocity, follows_slip)
        g = (1 - s) / DRAG + s
        u = np.tensordot(velocity, self.normal, 1)
        q = np.where(u > 0, WINDWARD * g * u**2 + 2 * DRAG * s * u * (1 - u), -LEE * g * u**2)
        return -(q * self.area * self.normal).sum((1, 2))


def middles(count):
    return (np.arange(count) + 0.5) / count


def spheroid(ratio, count=1200):
    angle = np.pi * middles(count)
    size = np.hypot(np.cos(angle) / ratio, np.sin(angle))
    stretch = np.hypot(ratio * np.sin(angle), np.cos(angle))
    return Revolution(ratio * np.cos(angle), np.sin(angle), np.cos(angle) / ratio / size, np.sin(angle) / size,
                      stretch * np.pi / count, ratio / stretch**3)  # fmt: skip


def cone(half_angle, count=1200):
    """Apex first."""
    t, one, height = middles(count), np.ones(count), 1 / np.tan(half_angle)
    return Revolution(np.r_[height * (1 - t), 0 * t], np.r_[t, 1 - t], np.r_[np.sin(half_angle) * one, -one],
                      np.r_[np.cos(half_angle) * one, 0 * t], np.r_[np.hypot(1, height) * one, one] / count,
                      np.zeros(2 * count))  # fmt: skip


def cylinder(length, count=1200):
    t, one = middles(count), np.ones(count)
    return Revolution(np.r_[0 * t + length / 2, length * (0.5 - t), 0 * t - length / 2], np.r_[t, one, 1 - t],
                      np.r_[one, 0 * t, -one], np.r_[0 * t, one, 0 * t], np.r_[one, length * one, one] / count,
                      np.zeros(3 * count))  # fmt: skip


def print_slip_variant():
    print("Sharpness by the curvature along the slip: (43), variant")
    incidence = 0.035
    for ratio in (2, 4, 6, 8.57):
        body = spheroid(ratio)
        sides, drags = [], []
        for follows_slip in (False, True):
            ways = [body.force([np.cos(i), np.sin(i), 0], follows_slip)[1] for i in (incidence, -incidence)]
            sides.append((ways[1] - ways[0]) / (2 * incidence * np.pi))
            drags.append(-body.force([1, 0, 0], follows_slip)[0] / np.pi)
        print(f"  spheroid {ratio} : 1, side force per radian {sides[0]:.2f} {sides[1]:.2f}", end="")
        print(f", drag nose first {drags[0]:.2f} {drags[1]:.2f}")
    for degrees, measured in ((15, 0.34), (30, 0.51)):
        drags = [-cone(np.radians(degrees)).force([1, 0, 0], follows)[0] / np.pi for follows in (False, True)]
        print(f"  cone of {degrees} degrees, apex first {drags[0]:.2f} {drags[1]:.2f}, measured {measured}")
    rod = cylinder(40)
    for degrees in (10, 30, 60, 90):
        motion = [np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0]
        normal = [-rod.force(motion, follows)[1] / 80 for follows in (False, True)]
        print(f"  cylinder 20 : 1 at {degrees} degrees, normal force {normal[0]:.2f} {normal[1]:.2f}")


def plate(degrees, hump=0.0):
    """Normal force coefficient of a square plate; the hump is largest where sin^2 of the incidence is 1/3."""
    u = np.sin(np.radians(degrees))
    return DRAG * (2 * u - u**2) + 4 * hump * u**2 * (1 - u**2) ** 2


def print_hump_variant():
    print("Normal force of square plates that peaks before the stall, 4 h u^2 (1 - u^2)^2 more: (43), h = 0.85")
    eiffel = {6: 0.214, 12: 0.471, 20: 0.857, 30: 1.328, 37: 1.553}
    for degrees, measured in eiffel.items():
        print(f"  plate at {degrees} degrees {plate(degrees):.2f} {plate(degrees, 0.85):.2f}, measured {measured}")
    ratios = [[np.log(plate(d, h) / measured) for d, measured in eiffel.items()] for h in (0, 0.85)]
    factors = [np.exp(np.sqrt(np.mean(np.square(r)))) for r in ratios]
    print(f"  factor over these {factors[0]:.2f} {factors[1]:.2f}")
    print(f"  cube edge-on {plate(45):.2f} {plate(45, 0.85):.2f}, measured 0.8")


def print_end_variant():
    print("Cylinders end-on: (43); no suction on the base from one diameter of length on; front 0.75 and base 0.1 there")
    measured = {0.5: 1.1, 1: 0.91, 2: 0.85, 2.25: 0.8, 4: 0.87, 7: 0.99}
    for name, short, long in (("(43)", DRAG, DRAG), ("no suction", DRAG, WINDWARD), ("both", DRAG, 0.85)):
        ratios = [np.log((short if length < 1 else long) / value) for length, value in measured.items()]
        print(f"  factor {np.exp(np.sqrt(np.mean(np.square(ratios)))):.2f} {name}")


if __name__ == "__main__":
    print_slip_variant()
    print_hump_variant()
    print_end_variant()
