#!/usr/bin/python3
"""An aeroplane of one mesh: its polar, where it is neutral, and how it glides: docs/wings.md.

    aeroplane.py [--out FILE.obj] [--picture FILE.png]
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

import bullet_ambient as ba

AIR = ba.Medium(density=1.2, viscosity=1.8e-5)
AREA, CHORD = 0.18, 0.15  # of the wing [m^2], [m]
MASS, SPEED = 0.45, 9.3  # [kg], [m/s]


def section(camber, thickness, points=16):
    """Outline of a NACA section of four digits, camber at 0.4 of the chord: x ahead, z up; nose at x = 0.5."""
    angles = np.linspace(0, 2 * np.pi, 2 * points, endpoint=False)
    s, side = (1 + np.cos(angles)) / 2, np.where(angles < np.pi, 1, -1)
    thick = 5 * thickness * (0.2969 * np.sqrt(s) - 0.126 * s - 0.3516 * s**2 + 0.2843 * s**3 - 0.1036 * s**4)
    ahead, start = np.where(s < 0.4, 0.4, 0.6), np.where(s < 0.4, 0, 0.2)
    return np.c_[0.5 - s, camber / ahead**2 * (start + 0.8 * s - s**2) + side * thick]


def wing(outline, chord, span, along=20):
    """Vertices and triangles of a wing of one section along y."""
    points, places = len(outline), np.linspace(-span / 2, span / 2, along + 1)
    vertices = np.vstack([np.c_[chord * outline[:, 0], np.full(points, y), chord * outline[:, 1]] for y in places])
    triangles = []
    for ring in range(0, along * points, points):
        for i in range(points):
            a, b = ring + i, ring + (i + 1) % points
            triangles += [(a, b + points, a + points), (a, b, b + points)]
    last = along * points
    for i in range(points // 2):  # the ends, between upper and lower side
        a, b, c, d = i, i + 1, (points - i - 1) % points, (points - i) % points
        ends = [t for t in ((a, c, b), (a, d, c)) if len(set(t)) == 3]
        triangles += ends + [(last + p, last + r, last + q) for p, q, r in ends]
    return vertices, np.array(triangles)


def hull(nose=0.3, length=0.95, radius=0.04, around=24, along=20):
    """A spindle along x."""
    x = nose - length * np.arange(1, along) / along
    r = radius * np.sqrt(1 - ((x - nose + length / 2) / (length / 2)) ** 2)
    angles = 2 * np.pi * np.arange(around) / around
    rings = np.vstack([np.c_[np.full(around, a), b * np.cos(angles), b * np.sin(angles)] for a, b in zip(x, r)])
    tip, end, last = len(rings), len(rings) + 1, len(rings) - around
    triangles = []
    for i in range(around):
        j = (i + 1) % around
        for ring in range(0, last, around):
            triangles += [(ring + i, ring + around + i, ring + j), (ring + j, ring + around + i, ring + around + j)]
        triangles += [(tip, i, j), (end, last + j, last + i)]
    return np.vstack([rings, [[nose, 0, 0], [nose - length, 0, 0]]]), np.array(triangles)


def aeroplane():
    """Named parts: a wing of 1.2 m of NACA 2412, a tail at -3 degrees, a fin, a hull. Origin in the middle of the wing."""
    turn = np.radians(3)
    tail, tail_faces = wing(section(0, 0.12, 14), 0.1, 0.4, 10)
    tilt = np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])
    fin, fin_faces = wing(section(0, 0.10, 14), 0.1, 0.15, 6)
    return {
        "wing": wing(section(0.02, 0.12), CHORD, 1.2, 24),
        "tail": (tail @ tilt.T + [-0.54, 0, 0], tail_faces),
        "fin": (np.c_[fin[:, 0], -fin[:, 2], fin[:, 1]] + [-0.54, 0, 0.09], fin_faces),
        "hull": hull(),
    }


def write_obj(parts, file):
    lines, first = [], 1
    for name, (vertices, triangles) in parts.items():
        lines.append(f"o {name}")
        lines += ["v %.9g %.9g %.9g" % tuple(v) for v in vertices]
        lines += ["f %d %d %d" % tuple(t) for t in triangles + first]
        first += len(vertices)
    Path(file).write_text("\n".join(lines) + "\n")


def numbers(body):
    """Slope of the lift [1/rad], place of no change of the moment behind the wing's quarter chord [chords], lift over
    drag at 4 degrees, and where the lift acts then ahead of F's origin [m]."""
    attack = np.radians([-2.0, 2, 4])
    polar = body.polar(attack, medium=AIR, speed=SPEED, reference_area=AREA, reference_length=CHORD)
    lift, moment = polar["C_L"], polar["C_m"]
    slope = (lift[1] - lift[0]) / (attack[1] - attack[0])
    ahead = (moment[1] - moment[0]) / (lift[1] - lift[0])  # of F's origin [chords]
    quarter = (CHORD / 4 - body.origin[0]) / CHORD
    return slope, quarter - ahead, lift[2] / polar["C_D"][2], CHORD * moment[2] / lift[2]


def glide(file, centre, step=1 / 240, seconds=40):
    """Glide ratio and speed in the second half of a flight that begins at 9.3 m/s. centre: of mass, ahead of F's origin [m]."""
    inertia = [0.02, 0.03, 0.05, 0, 0, 0]
    body = {"name": "aeroplane", "mass": MASS, "shape": {"type": "fluid_body", "file": str(file)}, "position": [0, 0, 200],
            "centre_of_mass": [centre, 0, 0], "inertia": inertia, "linear_velocity": [SPEED, 0, 0]}
    scene = ba.Scene({"duration": seconds, "time_step": step, "medium": {"density": 1.2, "viscosity": 1.8e-5}, "bodies": [body]})
    with ba.World(scene) as world:
        places = world.run(seconds, 0.05).position[:, 0]
    way = places[-1] - places[len(places) // 2]
    return np.hypot(way[0], way[1]) / -way[2], np.linalg.norm(way) / (seconds / 2)


def draw(body_file, picture):
    """The parts that lift, in colours, over the hull."""
    import matplotlib.pyplot as plt
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    body = {"name": "aeroplane", "mass": MASS, "shape": {"type": "fluid_body", "file": str(body_file)}, "inertia": [0.02, 0.03, 0.05, 0, 0, 0]}
    with ba.World(ba.Scene({"duration": 1, "time_step": 1 / 240, "gravity": [0, 0, 0], "bodies": [body]})) as world:
        world.step()
        bare = len(world.lines([])[0])
        points, colours = (array[bare:] for array in world.lines(["wings"]))
    corners, faces = hull()
    axes = plt.figure(figsize=(7, 4.6)).add_subplot(projection="3d")
    axes.plot_trisurf(*corners.T, triangles=faces, color="0.85", edgecolor="0.7", linewidth=0.2)
    axes.add_collection3d(Line3DCollection(points, colors=colours, linewidths=2))
    axes.set(xlabel="x [m]", ylabel="y [m]", xlim=(-0.65, 0.55), ylim=(-0.6, 0.6), zlim=(-0.1, 0.3), zticks=[0, 0.2])
    axes.set_box_aspect((1.2, 1.2, 0.4))
    axes.view_init(28, -130)
    plt.savefig(picture, dpi=100, bbox_inches="tight")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", help="where to write the mesh")
    parser.add_argument("--picture", help="where to draw its parts")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        mesh = arguments.out or Path(folder) / "aeroplane.obj"
        write_obj(aeroplane(), mesh)
        shape = {"type": "mesh", "file": str(Path(mesh).resolve())}
        for wings in ("none", "auto"):
            body = ba.FluidBody.from_shape(shape, name="aeroplane", panels=3000, wings=wings)
            slope, neutral, ratio, centre = numbers(body)
            print(f"wings {wings}: {len(body.wings)} parts; lift {slope:.2f} per rad, neutral {neutral:.2f} chords behind c/4, L/D {ratio:.1f}")
        body.write(Path(folder) / "aeroplane.ambient")
        if arguments.picture:
            draw(Path(folder) / "aeroplane.ambient", arguments.picture)
        ratio, speed = glide(Path(folder) / "aeroplane.ambient", centre)
        print(f"it glides 1 : {ratio:.1f} at {speed:.1f} m/s")


if __name__ == "__main__":
    main()
