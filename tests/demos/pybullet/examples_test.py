#!/usr/bin/python3
"""The examples do what docs/pybullet.md says of them; skipped where PyBullet does not import."""

import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

if importlib.util.find_spec("pybullet") is None:
    print("SKIPPED: PyBullet does not import; PYTHONPATH=FOLDER ctest finds one in FOLDER")
    sys.exit(77)

import matplotlib.image
import numpy as np

EXAMPLES = Path(__file__).resolve().parents[3] / "demos/pybullet/examples"


class ExamplesTest(unittest.TestCase):
    def run_example(self, script):
        """The numbers that it prints; its picture has to show something."""
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "picture.png"
            run = subprocess.run([sys.executable, "-B", EXAMPLES / script, picture], env={**os.environ, "MPLCONFIGDIR": folder},
                                 capture_output=True, text=True)
            if run.returncode == 77:
                self.skipTest(run.stdout.strip().splitlines()[-1])
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertGreater(np.ptp(matplotlib.image.imread(picture)[:, :, :3], axis=(0, 1)).min(), 0.3)
        said = re.sub(r"pybullet build time.*|m\^3|\[.*?\]", "", run.stdout)
        return [float(number) for number in re.findall(r"-?\d+\.?\d*", said)]

    def test_light_boxes_float_by_density_and_heavy_ones_lie_on_the_bottom(self):
        density, height = np.reshape(self.run_example("boxes_in_pool.py"), (-1, 2)).T
        self.assertTrue(np.all(np.diff(height[density < 1000]) < 0), height)
        np.testing.assert_allclose(height[density > 1000], -0.85, atol=0.01)
        box = 0.3
        self.assertAlmostEqual(height[0], box / 2 - 0.2 * box, delta=0.02)  # flat

    def test_a_quadruped_trots_through_water_more_slowly_than_on_land(self):
        water, seconds, land = self.run_example("wading_quadruped.py")
        self.assertGreater(water / seconds, 0.1)
        self.assertLess(water, 0.8 * land)

    def test_a_cup_stays_dry_and_bears_a_duck(self):
        alone, weight, upright, height, loaded, both, heel, *_ = self.run_example("duck_and_cup.py")
        np.testing.assert_allclose([alone, loaded], [weight, both], rtol=5e-3)
        self.assertLess(upright, 0.1)
        self.assertGreater(heel, 2)
        self.assertLess(abs(height), 20)

    def test_a_boat_heaves_with_waves_twice_as_long_as_it_is(self):
        amplitude, heave, pitch = self.run_example("boat_in_waves.py")
        self.assertAlmostEqual(heave / amplitude, 1, delta=0.25)
        self.assertGreater(pitch, 2)

    def test_an_arm_turns_more_slowly_under_water(self):
        numbers = self.run_example("kuka_under_water.py")
        (_, *first), (_, *second), (_, wet, dry) = numbers[:3], numbers[3:6], numbers[-3:]
        self.assertLess(first[0], first[1])
        self.assertLess(second[0], second[1])
        self.assertGreater(wet, dry)


if __name__ == "__main__":
    unittest.main()
