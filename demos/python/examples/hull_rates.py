#!/usr/bin/python3
"""Stability of the course of hulls by both pressure laws, linearized about steady flight nose first: docs/reality_runs.md.

hull_rates.py [--faces N]: one row for each hull: side force per radian over dynamic pressure and frontal area; yawing moment
of loads and potential flow over Munk's; rates of drift and turning in speeds per length, of a hull as heavy as the fluid.
"""

import argparse
from pathlib import Path

import numpy as np

import bullet_ambient as ba

FLUID = ba.Medium(density=1, viscosity=4e-7)  # hulls of 4 to 17 m at 1 m/s: Reynolds numbers of 10^7 on their length
AIRSHIP = Path(ba.Scene("airship").file).parents[1] / "meshes/airship.obj"  # 4 : 1, with fins
DRIFT, TURN = 0.035, 0.01  # [m/s] at a speed of 1, [rad/s]


def derivatives(body, law):
    """Side force and yawing moment by drift and by turning (2, 2), at a speed of 1 m/s along x."""
    if law is None:
        return np.zeros((2, 2))
    flow = ba.FlowSettings(law=law)
    ahead = np.array([0, 0, 0, 1, 0, 0.0])
    columns = []
    for way in (np.array([0, 0, 0, 0, DRIFT, 0]), np.array([0, 0, TURN, 0, 0, 0])):
        left, right = body.loads([ahead + way, ahead - way], FLUID, flow)
        columns.append((left - right)[[4, 2]] / (2 * way.sum()))
    return np.stack(columns, axis=1)


def rates(body, load):
    """Growth rates [1/s] of Kirchhoff's equations with the loads, linear in drift v and turning r at a speed of 1 m/s:
    B v' = -A r + Y, J r' = (A - B) v + N."""
    mass, inertia = body.volume, body.volume * body.uniform_mass[1]
    added = np.diag(body.added_mass)
    along, across, turning = mass + added[3], mass + added[4], inertia[2, 2] + added[2]
    motion = np.array([[0, -along / across], [(along - across) / turning, 0]])
    return np.linalg.eigvals(motion + load / [[across], [turning]])


def row(name, shape, length, frontal_area):
    body = ba.FluidBody.from_shape(shape)
    added = np.diag(body.added_mass)
    munk = added[3] - added[4]  # yawing moment over drift
    cells = [name]
    found = {law: derivatives(body, law) for law in ("published", "form", None)}
    for law in ("published", "form"):
        cells.append(f"{-found[law][0, 0] / (0.5 * frontal_area):.2f}")
    for law in ("published", "form"):
        cells.append(f"{1 + found[law][1, 0] / munk:.2f}")
    for law in (None, "published", "form"):
        values = sorted(rates(body, found[law]) * length, key=lambda z: -z.real)
        cells.append(", ".join(f"{z.real:.1f}" + (f"{z.imag:+.1f}i" if abs(z.imag) > 1e-9 else "") for z in values))
    print("| " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faces", type=int, default=3000)
    faces = parser.parse_args().faces
    print("| hull | side force, published | form | moment over Munk's, published | form | rates, potential flow | published | form |")
    print("|---|---|---|---|---|---|---|---|")
    for ratio in (2, 4, 6, 8.57):
        hull = {"type": "ellipsoid", "semi_axes": [ratio, 1, 1], "faces": faces}
        row(f"{ratio} : 1", hull, 2 * ratio, np.pi)
    row("4 : 1 with fins", {"type": "mesh", "file": str(AIRSHIP)}, 8, np.pi)


if __name__ == "__main__":
    main()
