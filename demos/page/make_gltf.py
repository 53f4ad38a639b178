#!/usr/bin/python3
"""Writes an animated glTF 2.0 of a run of ambient_demo, for Blender and other viewers: make_gltf.py RUN -o FILE.glb (or .gltf).

Metres and seconds. Each body is a node with its triangles and a material, below a root that turns the direction against
gravity (z without gravity) into y, as glTF demands. Keys are the output steps, and as many between them as it takes that no
body turns by more than an eighth of a turn from one to the next, because players interpolate along the shorter rotation.
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
from page_data import read_motion

LARGEST_TURN = math.pi / 4
# Linear red, green, blue.
COLOURS = ((0.013, 0.158, 0.831), (0.694, 0.065, 0.004), (0.024, 0.254, 0.056), (0.332, 0.037, 0.462), (0.807, 0.371, 0), (0.003, 0.198, 0.258))
STATIC_COLOUR = (0.48, 0.54, 0.6)
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


def make_text(name, gravity, bodies, motion):
    """The JSON of an asset without its buffer, and the buffer."""
    buffer, meshes, materials, channels, samplers = Buffer(), [], [], [], []
    nodes = [{"name": name, "rotation": up_to_y(gravity), "children": list(range(1, len(bodies) + 1))}]
    for index, body in enumerate(bodies):
        rows = motion[body["name"]]
        points = buffer.add(np.reshape(body["vertices"], (-1, 3)), FLOAT, "VEC3", target=34962)
        corners = buffer.add(body["triangles"], UNSIGNED, "SCALAR", target=34963)
        meshes.append({"name": body["name"], "primitives": [{"attributes": {"POSITION": points}, "indices": corners, "material": index}]})
        colour = COLOURS[index % len(COLOURS)] if body["mass"] > 0 else STATIC_COLOUR
        surface = {"baseColorFactor": [*colour, 1], "metallicFactor": 0, "roughnessFactor": 0.6}
        materials.append({"name": body["name"], "pbrMetallicRoughness": surface, "doubleSided": True})
        times, places, turns = keys_of(rows)
        turns = np.roll(turns, -1, axis=1).astype("f4")  # x, y, z, w
        turns /= np.linalg.norm(turns, axis=1, keepdims=True)
        nodes.append({"name": body["name"], "mesh": index, "translation": places[0].tolist(), "rotation": turns[0].tolist()})
        if not body["mass"] > 0:
            continue
        time = buffer.add(times, FLOAT, "SCALAR")
        for path, kind, values in (("translation", "VEC3", places), ("rotation", "VEC4", turns)):
            channels.append({"sampler": len(samplers), "target": {"node": index + 1, "path": path}})
            samplers.append({"input": time, "output": buffer.add(values, FLOAT, kind), "interpolation": "LINEAR"})
    text = {
        "asset": {"version": "2.0", "generator": "bullet_ambient"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    if channels:  # an animation must have a channel
        text["animations"] = [{"name": name, "channels": channels, "samplers": samplers}]
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
        made = make_text(summary["scene"], summary["gravity"], bodies, read_motion(folder / "trajectory.csv")[0])
    partial = file.with_name(f".{file.name}.{os.getpid()}.partial")
    with writing(file):
        partial.write_bytes(make_bytes(file, *made))
        partial.replace(file)


if __name__ == "__main__":
    main()
