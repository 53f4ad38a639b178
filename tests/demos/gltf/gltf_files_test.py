#!/usr/bin/python3
"""What make_gltf.py writes: gltf_files_test.py AMBIENT_DEMO FOLDER [-v]. FOLDER gets the npm packages."""

import csv
import json
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
SCENES = HERE.parents[2] / "data/scenes"
MAKE = HERE.parents[2] / "demos/page/make_gltf.py"
DEMO = FOLDER = None
KINDS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def run_scene(out, scene, *changes, gltf=None, log=()):
    words = [word for change in changes for word in ("--set", change)] + [word for name in log for word in ("--log", name)]
    subprocess.run([DEMO, SCENES / f"{scene}.json", "--quiet", "--out", out, *words], check=True)
    if gltf:
        subprocess.run(["/usr/bin/python3", "-B", MAKE, out, "-o", gltf], check=True)


def rows_of(folder, body):
    with open(folder / "trajectory.csv", newline="") as stream:
        return np.array([[float(x) for x in row[:1] + row[2:15]] for row in csv.reader(stream) if row[1] == body])


class Container:
    """A .glb file."""

    def __init__(self, file):
        data = file.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        self.text = json.loads(data[20 : 20 + length])
        self.buffer = data[28 + length :]

    def array(self, accessor):
        entry = self.text["accessors"][accessor]
        view = self.text["bufferViews"][entry["bufferView"]]
        width = KINDS[entry["type"]]
        start = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
        return np.frombuffer(self.buffer, "<f4", entry["count"] * width, start).reshape(-1, width).astype(float)

    def keys(self, body, path):
        """Times and values of the channel of a body."""
        animation = self.text["animations"][0]
        for channel in animation["channels"]:
            node = self.text["nodes"][channel["target"]["node"]]
            if node["name"] == body and channel["target"]["path"] == path:
                sampler = animation["samplers"][channel["sampler"]]
                assert sampler["interpolation"] == "LINEAR"
                return self.array(sampler["input"])[:, 0], self.array(sampler["output"])
        raise KeyError(body)


def slerp(times, values, time):
    """As glTF demands of a player: along the shorter way."""
    i = min(max(np.searchsorted(times, time) - 1, 0), len(times) - 2)
    share = (time - times[i]) / (times[i + 1] - times[i])
    a, b = values[i], values[i + 1]
    cosine = a @ b
    b, cosine = (-b, -cosine) if cosine < 0 else (b, cosine)
    angle = np.arccos(min(cosine, 1))
    if angle < 1e-6:
        return (1 - share) * a + share * b
    return (np.sin((1 - share) * angle) * a + np.sin(share * angle) * b) / np.sin(angle)


class GltfTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = Path(folder.name)
        # Five radians of spin per output step, and the same motion with finer steps to compare with.
        run_scene(cls.out / "a", "golf_dimpled_spin", "duration=0.5", "output_step=0.02", gltf=cls.out / "golf.glb")
        run_scene(cls.out / "golf", "golf_dimpled_spin", "duration=0.5", "output_step=0.005")
        run_scene(cls.out / "b", "ball_on_bottom", "duration=0.2", gltf=cls.out / "floor.glb")
        run_scene(cls.out / "c", "flap_in_current", "duration=0.2", gltf=cls.out / "flap.gltf")
        run_scene(cls.out / "d", "barge_floods", "duration=50", "output_step=10", gltf=cls.out / "barge.glb", log=["holds"])

    def test_khronos_validator_has_nothing_to_say(self):
        for name in ("package.json", "package-lock.json"):
            shutil.copy(HERE / name, FOLDER)
        if not (FOLDER / "node_modules/gltf-validator").exists():
            subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=FOLDER, check=True)
        files = [self.out / name for name in ("golf.glb", "floor.glb", "flap.gltf", "barge.glb")]
        found = subprocess.run(["node", HERE / "validate.js", FOLDER, *files], check=True, stdout=subprocess.PIPE)
        reports = json.loads(found.stdout)
        self.assertEqual(len(reports), len(files))
        for file, issues in zip(files, reports):
            self.assertEqual(issues["messages"], [], file)

    def test_body_moves_as_logged(self):
        golf = Container(self.out / "golf.glb")
        times, places = golf.keys("ball", "translation")
        turn_times, turns = golf.keys("ball", "rotation")
        rows = rows_of(self.out / "golf", "ball")
        self.assertGreater(np.linalg.norm(rows[0, 8:11]) * 0.02, np.pi)
        for row in rows:
            place = [np.interp(row[0], times, places[:, k]) for k in range(3)]
            # A straight line between keys 3 ms apart: 20 m/s^2 * (3 ms)^2 / 8; a float of 25 m has 1e-6 m.
            np.testing.assert_allclose(place, row[1:4], atol=5e-5)
            x, y, z, w = slerp(turn_times, turns, row[0])
            self.assertGreater(abs(np.dot([w, x, y, z], row[4:8])), 1 - 1e-6)

    def test_turns_are_small_and_along_the_shorter_way(self):
        turns = Container(self.out / "golf.glb").keys("ball", "rotation")[1]
        cosines = np.sum(turns[1:] * turns[:-1], axis=1)
        self.assertGreater(cosines.min(), np.cos(np.pi / 8 * 1.01))

    def test_up_is_y_and_what_stands_still_has_no_keys(self):
        floor = Container(self.out / "floor.glb")
        x, y, z, w = floor.text["nodes"][0]["rotation"]
        up = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]  # of z
        np.testing.assert_allclose(up, [0, 1, 0], atol=1e-15)
        moved = {channel["target"]["node"] for channel in floor.text["animations"][0]["channels"]}
        self.assertEqual({floor.text["nodes"][node]["name"] for node in moved}, {"ball"})

    def test_water_in_a_hold_is_shown_at_its_level(self):
        barge = Container(self.out / "barge.glb")
        names = [node["name"] for node in barge.text["nodes"]]
        with open(self.out / "d/trajectory.csv", newline="") as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual(names.count("water in barge 0"), 0)  # dry
        for k, row in enumerate(rows[1:], 1):
            node = names.index(f"water in barge {k}")
            primitive = barge.text["meshes"][barge.text["nodes"][node]["mesh"]]["primitives"][0]
            corners = barge.array(primitive["attributes"]["POSITION"]).reshape(-1, 3, 3)
            np.testing.assert_allclose(corners[:, :, 2], float(row["hold0_level_z"]), atol=1e-5)
            areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
            self.assertAlmostEqual(areas.sum(), 1.96 * 0.96, delta=1e-4)
            samplers = barge.text["animations"][0]["samplers"]
            sampler = next(samplers[c["sampler"]] for c in barge.text["animations"][0]["channels"] if c["target"]["node"] == node)
            shown = dict(zip(barge.array(sampler["input"])[:, 0], barge.array(sampler["output"])[:, 0]))
            self.assertEqual((sampler["interpolation"], shown[float(row["time"])], sum(shown.values())), ("STEP", 1, 1))

    def test_what_is_no_run_is_refused_in_one_line(self):
        for run, file in ((self.out, "a.glb"), (self.out / "golf", "a.obj"), (self.out / "golf", "none/a.glb")):
            made = subprocess.run(["/usr/bin/python3", "-B", MAKE, run, "-o", self.out / file], capture_output=True, text=True)
            self.assertEqual((made.returncode, len(made.stderr.splitlines())), (1, 1), made.stderr)
        self.assertFalse((self.out / "a.glb").exists())

    def test_shapes_are_in_metres(self):
        golf = Container(self.out / "golf.glb")
        points = golf.array(golf.text["meshes"][0]["primitives"][0]["attributes"]["POSITION"])
        np.testing.assert_allclose(np.linalg.norm(points, axis=1), 0.0213, rtol=0.01)


if __name__ == "__main__":
    DEMO, FOLDER = sys.argv.pop(1), Path(sys.argv.pop(1))
    unittest.main()
