#!/usr/bin/python3
"""rivals_cost runs, is right about what has a closed form, and its results can be drawn: rivals_test.py RIVALS_COST"""

import json
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.append(str(Path(__file__).parent))
sys.dont_write_bytecode = True

import plot_rivals


class RivalsTest(unittest.TestCase):
    program = ""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.file = Path(cls.folder.name) / "results.json"
        subprocess.run([cls.program, "--quick", "--out", cls.file], check=True, stdout=subprocess.DEVNULL)
        cls.results = json.loads(cls.file.read_text())
        cls.numbers = {row["case"]: row["numbers"] for row in cls.results["accuracy"]}

    def test_costs_are_positive(self):
        for row in self.results["cost"]:
            for engine, cost in row["engines"].items():
                with self.subTest(case=row["case"], engine=engine):
                    self.assertTrue(cost is None or cost["dry"] > 0 and cost["ratio"] > 0)
        self.assertEqual(len(self.results["cost"]), 4)

    def test_a_light_ball_carries_half_of_its_water(self):
        # Bullet in float, 1 ms: rounding of the velocity, 1e-7.
        self.assertAlmostEqual(self.numbers["light ball"]["bullet_ambient"], 14.715, delta=0.001)
        # By hand there is no added mass: 9 g.
        self.assertAlmostEqual(self.numbers["light ball"]["forces by hand"], 9 * 9.81, delta=0.001)

    def test_the_barge_without_added_mass_has_the_period_of_its_own_mass(self):
        # Linear spring rho g A of the quarters, drag of the order of 1 % of the mass: to 1 %.
        expected = 2 * math.pi * math.sqrt(314.4 / (998 * 9.81 * 4 * 0.4))
        self.assertAlmostEqual(self.numbers["barge in heave"]["forces by hand"], expected, delta=0.01 * expected)
        self.assertGreater(self.numbers["barge in heave"]["bullet_ambient"], 1.1 * expected)

    def test_the_cube_by_hand_has_the_speed_of_the_coefficient_that_was_typed_in(self):
        row = next(row for row in self.results["accuracy"] if row["case"] == "rising cube")
        self.assertAlmostEqual(row["numbers"]["forces by hand"], row["reference"], delta=0.01 * row["reference"])

    def test_ideal_flow_keeps_its_energy(self):
        # Leapfrog at 1/60 s; without added mass the flow's energy comes and goes.
        self.assertLess(self.numbers["ellipsoid in ideal flow"]["bullet_ambient"], 1e-2)
        self.assertGreater(self.numbers["ellipsoid in ideal flow"]["forces by hand"], 5e-2)

    def test_results_are_drawn_into_the_page(self):
        docs = Path(self.folder.name) / "docs"
        (docs / "images").mkdir(parents=True)
        (docs / "rivals.md").write_text((ROOT / "docs/rivals.md").read_text(encoding="utf-8"), encoding="utf-8")
        plot_rivals.write(self.results, docs)
        self.assertIn(self.results["date"], (docs / "rivals.md").read_text(encoding="utf-8"))
        self.assertGreater((docs / plot_rivals.PICTURE).stat().st_size, 10000)

    def test_times_of_a_quick_run_are_not_drawn(self):
        run = subprocess.run([Path(__file__).with_name("plot_rivals.py"), self.file, "-o", ROOT / "docs"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertEqual(run.stderr, f"{self.file}: was made with --quick, its times mean nothing\n")

    def test_a_file_that_cannot_be_written_is_one_line(self):
        run = subprocess.run([self.program, "--quick", "--out", "/nonexistent/results.json"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, r"^rivals_cost: [^\n]*/nonexistent[^\n]*\n$")


if __name__ == "__main__":
    RivalsTest.program = sys.argv.pop()
    unittest.main()
