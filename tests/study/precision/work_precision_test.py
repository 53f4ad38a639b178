"""What work_precision.py measures: errors shrink with the step, samples and work are counted."""

import tempfile
import unittest

import numpy as np
from bullet_ambient import Scene
from work_precision import CASES, METHODS, REFERENCE, Run, rows

EULER, LEAPFROG, PAIR = METHODS["symplectic euler"], METHODS["leapfrog 1e-3"], ("dormand_prince", 1e-6, 0, "single")


class WorkPrecision(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.ellipsoid = Scene("underwater_ellipsoid", {"duration": 0.5})

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_of(self, scene, method, rate, takes=1):
        return Run(scene, method, rate, self.folder.name, takes)

    def test_errors_shrink_with_the_step(self):
        reference = self.run_of(self.ellipsoid, REFERENCE, 1920)
        coarse, fine, pair = (self.run_of(self.ellipsoid, method, rate).error(reference)
                              for method, rate in ((EULER, 60), (EULER, 960), (PAIR, 60)))
        self.assertGreater(fine[0], 0)
        self.assertLess(fine[0], coarse[0] / 12)
        self.assertLess(fine[1], coarse[1] / 12)
        self.assertLess(pair[0], fine[0])

    def test_joints_err_to_first_order_in_the_step(self):
        # As in docs/error_vs_runtime.md; the reference has a sixteenth of the coarse error.
        flap = Scene("flap_in_current", {"duration": 1})
        reference = self.run_of(flap, LEAPFROG, 3840)
        coarse, fine = (self.run_of(flap, LEAPFROG, rate).error(reference)[0] for rate in (240, 480))
        self.assertAlmostEqual(coarse / fine, 15 / 7, delta=0.3)

    def test_samples_and_work_are_counted(self):
        twice, once = self.run_of(self.ellipsoid, EULER, 120, 2), self.run_of(self.ellipsoid, EULER, 120)
        self.assertEqual(len(twice.motion.t), 16)
        self.assertEqual(twice.evaluations, 60)
        self.assertGreater(twice.seconds, 0)
        self.assertEqual(twice.error(once), (0, 0))

    def test_a_run_that_breaks_down_is_infinitely_wrong(self):
        fast = self.ellipsoid.replace({"bodies.0.angular_velocity": [0, 3000, 3000]})
        broken = self.run_of(fast, EULER, 30)
        self.assertIsNone(broken.motion)
        self.assertEqual(broken.error(self.run_of(self.ellipsoid, PAIR, 60)), (np.inf, np.inf))

    def test_loads_in_double_are_others(self):
        single, double = (self.run_of(self.ellipsoid, (*PAIR[:3], precision), 60) for precision in ("single", "double"))
        self.assertLess(0, single.error(double)[0])
        self.assertLess(single.error(double)[0], 1e-5)

    def test_every_case_has_a_row_for_each_method_and_step(self):
        table = list(rows("flap", 1, self.folder.name))
        self.assertEqual(len(table), 6 * len(METHODS))
        for scene, _, changes in CASES.values():
            Scene(scene, changes)


if __name__ == "__main__":
    unittest.main()
