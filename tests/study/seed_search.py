#!/usr/bin/python3
"""Looks for winged seeds that begin to autorotate from rest by the default law.

Draws the nut, wing and masses of data/meshes/make_winged_seed.py at random, keeps those whose centre of mass lies within
a range of the chord behind the leading edge (about a third in real samaras: Norberg, Biol. Rev. 48, 1973), and releases each
at rest in several directions and spun by hand at 200 rad/s either way. A run autorotates if it turns about the vertical at
more than 60 rad/s and falls at less than 2.6 m/s in its last second of three."""
import argparse
import csv
import importlib.util
import json
import random
from math import cos, pi, sin, sqrt
from pathlib import Path

from bullet_ambient import run_cases

ROOT = Path(__file__).resolve().parents[2]
CHORD, LEADING_EDGE = 11e-3, 3.2e-3  # of the wing [m]
SPUN = {"bodies.0.orientation": [1, 0, 0, 0], "bodies.0.linear_velocity": [0, 0, -1]}


def turned(axis, angle):
    return [cos(angle / 2)] + [sin(angle / 2) * x for x in axis]


def at_random(rng):
    q = [rng.gauss(0, 1) for _ in range(4)]
    size = sqrt(sum(x * x for x in q))
    return [x / size for x in q]


def drawn_seed(rng, least, most):
    """The module with its numbers drawn, and its mass properties."""
    spec = importlib.util.spec_from_file_location("seed", ROOT / "data/meshes/make_winged_seed.py")
    while True:
        seed = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(seed)
        seed.NUT_Y, seed.NUT_Z = rng.uniform(-5, 2), rng.uniform(-0.6, 0.6)
        seed.PITCH, seed.RISE = rng.uniform(-4, 4), rng.uniform(-2, 12)
        seed.MASS = rng.choice([6e-5, 1e-4, 1.6e-4])
        seed.NUT_SHARE, seed.VEIN_SHARE = rng.uniform(0.55, 0.8), rng.uniform(0.5, 0.8)
        mass, centre, inertia = seed.mass_properties()
        if least < (LEADING_EDGE - centre[1]) / CHORD < most:
            return seed, {"mass": mass, "centre_of_mass": centre, "inertia": inertia}


def write_scene(seed, masses, path):
    points, triangles = seed.make_mesh()
    lines = ["v " + " ".join(f"{x:.9f}" for x in point) for point in points]
    lines += ["f " + " ".join(str(v + 1) for v in triangle) for triangle in triangles]
    path.with_suffix(".obj").write_text("\n".join(lines) + "\n")
    scene = json.loads((ROOT / "data/scenes/winged_seed.json").read_text())
    scene = {key: value for key, value in scene.items() if key not in ("$schema", "law")} | {"duration": 3}
    scene["bodies"][0] |= masses | {"shape": {"type": "mesh", "file": str(path.with_suffix(".obj"))}}
    path.write_text(json.dumps(scene))


def autorotates(folder):
    with (folder / "trajectory.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if float(row["time"]) >= 2]
    spin = sum(float(row["wz"]) for row in rows) / len(rows)
    fall = (float(rows[0]["pz"]) - float(rows[-1]["pz"])) / (float(rows[-1]["time"]) - float(rows[0]["time"]))
    return abs(spin) > 60 and fall < 2.6


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path, help="folder for seeds and runs")
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--chord", type=float, nargs=2, default=(0.25, 0.5), help="range of the centre of mass")
    arguments = parser.parse_args()
    rng = random.Random(7)
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    releases = [turned(axis, angle) for axis, angle in (((0, 1, 0), 0), ((0, 1, 0), pi / 2), ((0, 1, 0), -1.4),
                                                        ((1, 0, 0), -pi / 2), ((1, 0, 0), pi / 2))]
    releases += [at_random(rng) for _ in range(5)]
    with (out / "cases.jsonl").open("w") as cases:
        for number in range(arguments.seeds):
            path = out / f"seed{number}.json"
            write_scene(*drawn_seed(rng, *arguments.chord), path)
            changes = [{"bodies.0.orientation": release} for release in releases]
            changes += [SPUN | {"bodies.0.angular_velocity": [0, 0, spin]} for spin in (-200, 200)]
            cases.writelines(json.dumps({"scene": str(path), "set": change}) + "\n" for change in changes)
    if failures := run_cases(out / "cases.jsonl", out / "runs").failures:
        raise SystemExit(f"{len(failures)} cases failed; the first: {failures[min(failures)]}")
    counts = {"from rest": [0, 0], "spun": [0, 0]}
    for summary in (out / "runs").glob("*/summary.json"):
        start = json.loads(summary.read_text())["bodies"][0]["start"]
        count = counts["spun" if any(start["angular_velocity"]) else "from rest"]
        count[0] += autorotates(summary.parent)
        count[1] += 1
    for name, (good, of) in counts.items():
        print(f"{name}: {good} of {of} autorotate")


if __name__ == "__main__":
    main()
