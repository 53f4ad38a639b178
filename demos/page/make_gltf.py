#!/usr/bin/python3
"""Writes an animated glTF 2.0 of a run of ambient_demo, for Blender and other viewers: make_gltf.py RUN -o FILE.glb (or .gltf).

Metres and seconds. Each body is a node with its triangles and a material, below a root that turns the direction against
gravity (z without gravity) into y, as glTF demands. Keys are the output steps, and as many between them as it takes that no
body turns by more than an eighth of a turn from one to the next, because players interpolate along the shorter rotation.

The water in the holds of vessels, of a run with --log holds, is a flip book: its level at up to LEVELS times, of which one is
shown at a time and the others have the scale zero.
"""

import argparse
import base64
import json
import math
import os
import struct
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parent.parent / "plot"))

from files import reading, writing
from page_data import MOTION, read_motion

LARGEST_TURN = math.pi / 4
LEVELS = 100
# Linear red, green, blue.
COLOURS = ((0.013, 0.158, 0.831), (0.694, 0.065, 0.004), (0.024, 0.254, 0.056), (0.332, 0.037, 0.462), (0.807, 0.371, 0), (0.003, 0.198, 0.258))
STATIC_COLOUR = (0.48, 0.54, 0.6)
WATER_COLOUR = (0.03, 0.21, 0.46)
FLOAT, UNSIGNED = 5126, 5125  # glTF's numbers of component types


def product(a, b):
    """Product of quaternions (w, x, y, z)."""
    w, v = a[0] * b[0] - a[1:] @ b[1:], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
    return np.append(w, v)


def conjugate(q):
    return q * [1, -1, -1, -1]


def rotated(q, vector):
    return product(product(q, np.append(0, vector)), conjugate(q))[1:]


def quaternion_of(vector):
    """The rotation by a rotation vector [rad]."""
    angle = np.linalg.norm(vector)
    return np.append(math.cos(angle / 2), np.sinc(angle / (2 * math.pi)) / 2 * vector)


def turn_between(a, b, guess):
    """The rotation vector from a to b in the axes of a [rad], with the full turns that bring it nearest to `guess`."""
    q = product(conjugate(a), b)
    q = q if q[0] >= 0 else -q
    sine = np.linalg.norm(q[1:])
    if sine == 0:
        return np.zeros(3)
    axis, angle = q[1:] / sine, 2 * math.atan2(sine, q[0])
    return (angle + 2 * math.pi * round((guess @ axis - angle) / (2 * math.pi))) * axis


def vector_rate(vector, spin):
    """Rate of a rotation vector for an angular velocity in the turned axes."""
    angle = np.linalg.norm(vector)
    c = 1 / 12 if angle < 1e-3 else 1 / angle**2 - 1 / (2 * angle * math.tan(angle / 2))
    across = np.cross(vector, spin)
    return spin + across / 2 + c * np.cross(vector, across)


def hermite(value_0, slope_0, value_1, slope_1, s):
    """Cubic through two values with slopes by s, s in [0, 1]."""
    t = 1 - s
    return (1 + 2 * s) * t * t * value_0 + s * t * t * slope_0 + s * s * (3 - 2 * s) * value_1 - s * s * t * slope_1


def keys_of(rows):
    """Times, positions and quaternions (w, x, y, z) of the keys. Rows as read_motion() gives them."""
    keys = []
    for a, b in zip(rows, rows[1:]):
        step = b[0] - a[0]
        spins = [step * rotated(conjugate(row[4:8]), row[8:11]) for row in (a, b)]
        turn = turn_between(a[4:8], b[4:8], (spins[0] + spins[1]) / 2)
        largest = max(np.linalg.norm(spin) for spin in (*spins, turn))
        pieces = max(1, math.ceil(largest / LARGEST_TURN))
        for s in np.arange(pieces) / pieces:
            place = hermite(a[1:4], step * a[11:14], b[1:4], step * b[11:14], s)
            # The rate is singular near a full turn: rotations beyond half a turn are interpolated linearly.
            is_linear = np.linalg.norm(turn) > math.pi
            vector = s * turn if is_linear else hermite(np.zeros(3), spins[0], turn, vector_rate(turn, spins[1]), s)
            keys.append((a[0] + s * step, place, product(a[4:8], quaternion_of(vector))))
    last = rows[-1]
    keys.append((last[0], last[1:4], last[4:8]))
    quaternions = np.array([key[2] / np.linalg.norm(key[2]) for key in keys])
    for i in range(1, len(quaternions)):
        if quaternions[i] @ quaternions[i - 1] < 0:
            quaternions[i] *= -1
    return np.array([key[0] for key in keys]), np.array([key[1] for key in keys]), quaternions


def cut(points, triangles, place, normal):
    """The lines (n, 2, 3) in which a plane cuts a closed surface."""
    heights = (points - place) @ normal
    lines = []
    for triangle in triangles:
        ends = []
        for a, b in zip(triangle, np.roll(triangle, -1)):
            if (heights[a] > 0) != (heights[b] > 0):
                share = heights[a] / (heights[a] - heights[b])
                ends.append(points[a] + share * (points[b] - points[a]))
        if ends:
            lines.append(ends)
    return np.array(lines).reshape(-1, 2, 3)


def fill(lines, normal):
    """Triangles (n, 3, 3) of the area inside the closed outlines (n, 2, 3) in a plane: in each strip between neighbouring corners
    every second gap between the lines that cross it."""
    u = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    u /= np.linalg.norm(u)
    along = lines @ u
    lines = np.where((along[:, 0] > along[:, 1])[:, None, None], lines[:, ::-1], lines)
    along = np.sort(along, axis=1)
    triangles = []
    corners = np.unique(along)
    for left, right in zip(corners, corners[1:]):
        crossing = (along[:, 0] <= left) & (along[:, 1] >= right)
        span = np.ptp(along[crossing], axis=1)[:, None]
        ends = [a + (x - along[crossing, :1]) / span * (b - a) for x in (left, right) for a, b in [(lines[crossing, 0], lines[crossing, 1])]]
        order = np.argsort((ends[0] + ends[1]) @ np.cross(normal, u))
        for low, high in zip(order[::2], order[1::2]):
            a, b, c, d = ends[0][low], ends[1][low], ends[1][high], ends[0][high]
            triangles += [(a, b, c), (a, c, d)]
    return np.array(triangles).reshape(-1, 3, 3)


def levels_of(hold, rows, columns):
    """Times and levels of the water in a hold in the world: triangles (n, 3, 3), none if it is empty or full."""
    points, triangles = np.reshape(hold["vertices"], (-1, 3)), np.reshape(hold["triangles"], (-1, 3))
    for row in rows[:: max(1, math.ceil(len(rows) / LEVELS))]:
        volume, place, normal = row[columns[0]], row[columns[1:4]], row[columns[4:7]]
        in_world = np.array([row[1:4] + rotated(row[4:8], point) for point in points])
        yield row[0], fill(cut(in_world, triangles, place, normal), normal) if volume > 0 else np.empty((0, 3, 3))


class Buffer:
    """Arrays of numbers, and what glTF says of them."""

    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def add(self, values, component, kind, **more):
        values = np.ascontiguousarray(values, "<f4" if component == FLOAT else "<u4")
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes, **more})
        flat = values.reshape(len(values), -1)
        self.accessors.append({
            "bufferView": len(self.views) - 1,
            "componentType": component,
            "count": len(values),
            "type": kind,
            "min": flat.min(axis=0).tolist(),
            "max": flat.max(axis=0).tolist(),
        })  # fmt: skip
        self.data += values.tobytes()
        return len(self.accessors) - 1


def up_to_y(gravity):
    """The shortest rotation that turns the direction against gravity into y, as glTF writes it: x, y, z, w."""
    up = -np.array(gravity, float) if np.any(gravity) else np.array([0.0, 0, 1])
    up /= np.linalg.norm(up)
    if up[1] <= -1:
        return [1.0, 0, 0, 0]
    q = np.append(np.cross(up, [0, 1, 0]), 1 + up[1])
    return (q / np.linalg.norm(q)).tolist()


def add_motion(node, values, times, buffer, animation, interpolation="LINEAR"):
    """Adds keys of a node: values (n, 3 or 4) by the name of what they set."""
    time = buffer.add(times, FLOAT, "SCALAR")
    for path, keys in values.items():
        animation["channels"].append({"sampler": len(animation["samplers"]), "target": {"node": node, "path": path}})
        output = buffer.add(keys, FLOAT, f"VEC{keys.shape[1]}")
        animation["samplers"].append({"input": time, "output": output, "interpolation": interpolation})


def add_body(body, rows, colour, buffer, text, animation):
    points = buffer.add(np.reshape(body["vertices"], (-1, 3)), FLOAT, "VEC3", target=34962)
    corners = buffer.add(body["triangles"], UNSIGNED, "SCALAR", target=34963)
    primitive = {"attributes": {"POSITION": points}, "indices": corners, "material": len(text["materials"])}
    text["materials"].append(material(body["name"], [*colour, 1]))
    times, places, turns = keys_of(rows)
    turns = np.roll(turns, -1, axis=1).astype("f4")  # x, y, z, w
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    text["nodes"].append({"name": body["name"], "mesh": len(text["meshes"]), "translation": places[0].tolist(), "rotation": turns[0].tolist()})
    text["meshes"].append({"name": body["name"], "primitives": [primitive]})
    if body["mass"] > 0:
        add_motion(len(text["nodes"]) - 1, {"translation": places, "rotation": turns}, times, buffer, animation)


def add_water(name, levels, buffer, text, animation):
    """Adds the flip book of the level in a hold."""
    times = [float(time) for time, _ in levels]
    for k, (_, triangles) in enumerate(levels):
        if not len(triangles):
            continue
        points = buffer.add(triangles.reshape(-1, 3), FLOAT, "VEC3", target=34962)
        primitive = {"attributes": {"POSITION": points}, "material": len(text["materials"])}
        text["nodes"].append({"name": f"{name} {k}", "mesh": len(text["meshes"]), "scale": [float(k == 0)] * 3})
        text["meshes"].append({"name": name, "primitives": [primitive]})
        shown = range(max(k - 1, 0), min(k + 2, len(levels)))
        scales = np.array([[float(i == k)] * 3 for i in shown])
        add_motion(len(text["nodes"]) - 1, {"scale": scales}, [times[i] for i in shown], buffer, animation, "STEP")
    text["materials"].append({**material(name, [*WATER_COLOUR, 0.7]), "alphaMode": "BLEND"})


def material(name, colour):
    return {"name": name, "pbrMetallicRoughness": {"baseColorFactor": colour, "metallicFactor": 0, "roughnessFactor": 0.6}, "doubleSided": True}


def make_text(name, gravity, bodies, motion, more):
    """The JSON of an asset without its buffer, and the buffer. `more`: columns of the motion as read_motion() names them."""
    buffer, animation = Buffer(), {"name": name, "channels": [], "samplers": []}
    text = {"asset": {"version": "2.0", "generator": "bullet_ambient"}, "scene": 0, "scenes": [{"nodes": [0]}]}
    text.update({"nodes": [{"name": name, "rotation": up_to_y(gravity)}], "meshes": [], "materials": []})
    for index, body in enumerate(bodies):
        rows = motion[body["name"]]
        add_body(body, rows, COLOURS[index % len(COLOURS)] if body["mass"] > 0 else STATIC_COLOUR, buffer, text, animation)
        for i, hold in enumerate(body.get("holds", [])):
            columns = [len(MOTION) + k for k, column in enumerate(more) if column.startswith(f"hold{i}_")]
            if columns and body["mass"] > 0:
                add_water(f"water in {body['name']}", list(levels_of(hold, rows, columns)), buffer, text, animation)
    text["nodes"][0]["children"] = list(range(1, len(text["nodes"])))
    text.update({"accessors": buffer.accessors, "bufferViews": buffer.views, "buffers": [{"byteLength": len(buffer.data)}]})
    if animation["channels"]:  # an animation must have a channel
        text["animations"] = [animation]
    return text, buffer.data


def chunk(kind, data, filling):
    data += filling * (-len(data) % 4)
    return struct.pack("<I4s", len(data), kind) + data


def make_bytes(file, text, data):
    if file.suffix == ".gltf":
        text["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        return (json.dumps(text, indent=1) + "\n").encode()
    chunks = chunk(b"JSON", json.dumps(text, separators=(",", ":")).encode(), b" ") + chunk(b"BIN\0", data, b"\0")
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, metavar="RUN")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE")
    arguments = parser.parse_args()
    file, folder = arguments.output, arguments.run
    if file.suffix not in (".glb", ".gltf"):
        sys.exit(f"{file}: the name must end in .glb or .gltf")
    with reading(folder, "a folder of results of ambient_demo"):
        summary = json.loads((folder / "summary.json").read_text())
        bodies = json.loads((folder / "geometry.json").read_text())["bodies"]
        made = make_text(summary["scene"], summary["gravity"], bodies, *read_motion(folder / "trajectory.csv"))
    partial = file.with_name(f".{file.name}.{os.getpid()}.partial")
    with writing(file):
        partial.write_bytes(make_bytes(file, *made))
        partial.replace(file)


if __name__ == "__main__":
    main()
