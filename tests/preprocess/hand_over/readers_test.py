#!/usr/bin/python3
"""What MuJoCo reads of ambient_preprocess export: readers_test.py AMBIENT_PREPROCESS FOLDER [-v]. FOLDER gets the npm
packages."""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
SHAPES = {
    "ball": {"type": "sphere", "radius": 0.5},
    "torpedo": {"type": "ellipsoid", "semi_axes": [2, 0.4, 0.3]},
    "brick": {"type": "box", "size": [2, 1, 0.5]},
    "cone": {"type": "cone", "radius": 0.3, "height": 1},
    "card": {"type": "sheet", "size": [1, 0.6]},
}
DENSITY, GRAVITY = 1000.0, 9.8


def run(*arguments):
    return subprocess.run([PREPROCESS, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def rows_of(report, title):
    """Numbers of the body and of MuJoCo in a table of the report, translation first."""
    table = report.split(title)[1]
    rows = re.findall(r"^  (?:along|about) \w +(\S+) +(\S+) +\S+ %$", table, re.MULTILINE)[:6]
    return np.array(rows, float).T


class ReadersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        for name, shape in SHAPES.items():
            (cls.folder / f"{name}.json").write_text(json.dumps(shape))
            run("build", cls.folder / f"{name}.json", "-o", cls.folder / f"{name}.ambient")

    def export(self, name, form, *options):
        file = self.folder / f"{name}.{form}"
        words = ["--density", DENSITY, "--gravity", GRAVITY, "--viscosity", 0, *options]
        return file, run("export", self.folder / f"{name}.ambient", "--format", form, "-o", file, *words)

    def test_mujoco_has_what_the_report_says(self):
        for name in ("package.json", "package-lock.json"):
            shutil.copy(HERE / name, FOLDER)
        if not (FOLDER / "node_modules/@mujoco/mujoco").exists():
            subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=FOLDER, check=True)
        made = [self.export(name, "mjcf", "--mass", 400) for name in SHAPES]
        script = [HERE / "mujoco_forces.mjs", FOLDER, *(file for file, _ in made)]
        found = json.loads(subprocess.run(["node", *script], check=True, stdout=subprocess.PIPE).stdout)
        for (file, report), body in zip(made, found):
            with self.subTest(file=file.name):
                self.assertEqual(body["mass"], 400)
                # The report has four digits; MuJoCo's integrals are rough where an ellipsoid is as thin as a sheet.
                accuracy = 1e-2 if file.stem == "card" else 1e-3
                added = rows_of(report, "added mass along its axes")[1]
                np.testing.assert_allclose(DENSITY * np.array(body["added"]), added, rtol=accuracy, atol=1e-3)
                drag = rows_of(report, "drag along its axes")[1]
                np.testing.assert_allclose(body["drag"][:3], drag[:3], rtol=accuracy)
                # Munk's moment of a motion along x and y, by the added mass of the body itself.
                along = rows_of(report, "added mass along its axes")[0]
                np.testing.assert_allclose(body["munk"], along[0] - along[1], rtol=1e-3, atol=0.1)
                # The inertia is the mass alone, and the water carries what the body displaces.
                self.assertAlmostEqual((body["pushed"][0] - body["fall"][0]) * 400, 1)
                carried = 1 - DENSITY * self.volume(file) / 400
                self.assertAlmostEqual(body["fall"][2], -GRAVITY * carried, places=6)

    def volume(self, file):
        return json.loads(run("inspect", file.with_suffix(".ambient"), "--json"))["volume"]


if __name__ == "__main__":
    PREPROCESS, FOLDER = sys.argv.pop(1), Path(sys.argv.pop(1))
    unittest.main()
