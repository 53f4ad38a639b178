#!/usr/bin/python3
"""Blades of a mesh against three measured propellers of data/reality/propellers.json: docs/wings.md.

    measured_propellers.py build/release/bin/ambient_preprocess

Blades have the measured chords and angles and sections NACA 4408, at a hub of 0.16 of the radius.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np

DATA = Path(__file__).resolve().parents[2] / "data/reality/propellers.json"
AIR = {"--density": "1.2", "--viscosity": "1.8e-5"}
CAMBER, THICKNESS = 0.04, 0.08


def section(points=12):
    """Outline of NACA 4408: x ahead, z up, nose at x = 0.5."""
    angles = np.linspace(0, 2 * np.pi, 2 * points, endpoint=False)
    s, side = (1 + np.cos(angles)) / 2, np.where(angles < np.pi, 1, -1)
    thick = 5 * THICKNESS * (0.2969 * np.sqrt(s) - 0.126 * s - 0.3516 * s**2 + 0.2843 * s**3 - 0.1036 * s**4)
    ahead, start = np.where(s < 0.4, 0.4, 0.6), np.where(s < 0.4, 0, 0.2)
    return np.c_[0.5 - s, CAMBER / ahead**2 * (start + 0.8 * s - s**2) + side * thick]


def prism(rings):
    """Vertices and triangles between rings of the same number of points, closed at both ends."""
    points, last = len(rings[0]), (len(rings) - 1) * len(rings[0])
    triangles = []
    for ring in range(0, last, points):
        for i in range(points):
            a, b = ring + i, ring + (i + 1) % points
            triangles += [(a, a + points, b + points), (a, b + points, b)]
    for i in range(points // 2):
        a, b, c, d = i, i + 1, (points - i - 1) % points, (points - i) % points
        ends = [t for t in ((a, b, c), (a, c, d)) if len(set(t)) == 3]
        triangles += ends + [(last + p, last + r, last + q) for p, q, r in ends]
    return np.vstack(rings), np.array(triangles)


def blade(geometry, radius, turn):
    """One blade; the propeller turns about z, thrust along z, stations along x before it is turned."""
    outline, rings = section(), []
    for r, c, beta in geometry:
        angle = np.radians(beta)
        ahead, up = radius * c * outline.T
        rings.append(np.c_[np.full(len(outline), radius * r), np.cos(angle) * ahead - np.sin(angle) * up,
                           np.sin(angle) * ahead + np.cos(angle) * up])
    vertices, triangles = prism(rings)
    vertices[:, :2] = vertices[:, :2] @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return vertices, triangles


def hub(radius, half_height, around=48):
    angles = 2 * np.pi * np.arange(around) / around
    circle = np.c_[radius * np.cos(angles), radius * np.sin(angles)]
    vertices, triangles = prism([np.c_[circle, np.full(around, z)] for z in np.linspace(half_height, -half_height, 3)])
    return vertices, triangles


def write(file, parts):
    first, lines = 1, []
    for name, (vertices, triangles) in parts:
        lines += [f"o {name}"] + ["v %.9g %.9g %.9g" % tuple(v) for v in vertices]
        lines += ["f %d %d %d" % tuple(t + first) for t in triangles]
        first += len(vertices)
    file.write_text("\n".join(lines) + "\n")


def curve(tool, body, propeller, advances):
    """C_T and C_P at advances."""
    n, d = propeller["turns"], propeller["diameter"]
    found = []
    for advance in advances:
        twist = [0, 0, 2 * np.pi * n, 0, 0, advance * n * d]
        air = [word for pair in AIR.items() for word in pair]
        load = json.loads(subprocess.run([tool, "loads", body, "--json", *air, "--twist", *map(str, twist)],
                                         check=True, capture_output=True, text=True).stdout)
        scale = float(AIR["--density"]) * n**2 * d**4
        torque, thrust = load["total"][2], load["total"][5]
        found.append((thrust / scale, -2 * np.pi * torque / (scale * d)))
    return np.array(found)


def zero(advances, thrusts):
    """The first advance without thrust, between points on a line."""
    for (j, t), (k, u) in zip(zip(advances, thrusts), zip(advances[1:], thrusts[1:])):
        if t > 0 >= u:
            return j + (k - j) * t / (t - u)
    return float("nan")


def at_rest(advances, found):
    """C_T and C_P at rest of blades in the stream that they induce: C_T = pi/2 J_i^2, momentum theory."""
    lack = found[:, 0] - np.pi / 2 * advances**2
    induced = zero(advances, lack)
    return [np.interp(induced, advances, column) for column in found.T]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tool", help="ambient_preprocess")
    parser.add_argument("--wings", default="auto", help="as of build (default auto)")
    options = parser.parse_args()
    print("propeller | C_T, C_P at rest: measured; mesh; mesh in its own stream | J without thrust: measured; mesh")
    for propeller in json.loads(DATA.read_text())["propellers"]:
        radius, measured = propeller["diameter"] / 2, np.array(propeller["ct_cp"])
        parts = [("blade", blade(propeller["geometry"], radius, turn)) for turn in (0, np.pi)]
        parts.append(("hub", hub(0.16 * radius, 0.08 * radius)))
        with tempfile.TemporaryDirectory() as folder:
            mesh, body = Path(folder) / "propeller.obj", Path(folder) / "propeller.ambient"
            write(mesh, parts)
            subprocess.run([options.tool, "build", mesh, "-o", body, "--wings", options.wings, "--panels", "600",
                            "--origin", "0,0,0"], check=True, stdout=subprocess.DEVNULL)
            advances = np.arange(0, 1.2, 0.05)
            found = curve(options.tool, body, propeller, advances)
        print(f"{propeller['name']} | {measured[0, 1]:.3f}, {measured[0, 2]:.3f}; {found[0, 0]:.3f}, {found[0, 1]:.3f}; "
              "{:.3f}, {:.3f} | ".format(*at_rest(advances, found)) +
              f"{zero(measured[:, 0], measured[:, 1]):.2f}; {zero(advances, found[:, 0]):.2f}")


if __name__ == "__main__":
    main()
