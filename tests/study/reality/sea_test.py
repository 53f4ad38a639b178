#!/usr/bin/python3
"""Numbers of motions at sea, and docs/reality_at_sea.md, which is what the Python module makes now."""

import math
import re
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path += [str(ROOT / "tests/study/reality"), str(ROOT / "demos/plot")]

import matplotlib

matplotlib.use("Agg")

import numpy as np
import sea_page
import sea_runs
from reality_numbers import Sea

PAGE = ROOT / "docs/reality_at_sea.md"
DATA = ROOT / "data/reality/measurements_at_sea.json"
NUMBER = r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?"


class MeasureTest(unittest.TestCase):
    """Numbers taken from series of which they are known."""

    def near(self, what, y, duration, expected, delta):
        t = np.linspace(0, duration, 4001)
        self.assertAlmostEqual(sea_runs.measure(what, t, y(t)), expected, delta=delta)

    def test_a_damped_swing_has_its_period_extremes_and_decay(self):
        omega, rate = 8, 0.8
        lag, half = math.atan(rate / omega) / omega, math.pi / omega
        first = math.exp(-rate * (half - lag)) * math.cos(math.pi - omega * lag)
        for of, count, expected in (
            ("period", 4, 2 * half),
            ("time of extreme", 1, half - lag),
            ("decay", 6, rate),
            ("extreme", 1, first),
            ("extreme", 2, -first * math.exp(-rate * half)),
        ):
            what = {"of": of, "count": count, "balance": 3, "scale": 0.1}
            with self.subTest(of=of, count=count):
                self.near(what, lambda t: 3 + 0.1 * np.exp(-rate * t) * np.cos(omega * t), 4, expected, 1e-4 if of == "decay" else 1e-5)
        with self.assertRaises(ValueError):
            self.near({"of": "extreme", "count": 99}, np.cos, 4, 0, 0)

    def test_a_sine_has_its_amplitude_wherever_its_middle_is(self):
        sine, duration = lambda t: 5 + 0.02 * np.sin(3 * t + 1), 2 * math.pi
        self.near({"of": "amplitude", "period": duration / 3, "count": 2, "scale": 0.01}, sine, duration, 2, 2e-3)
        self.near({"of": "mean", "time": duration / 3}, sine, duration, 5, 1e-4)
        self.near({"of": "largest", "balance": 5}, sine, duration, 0.02, 1e-6)
        self.near({"of": "value", "time": 0.5}, sine, duration, sine(0.5), 1e-6)

    def test_quadratic_damping_is_found_again(self):
        x, w, kappa, step, values = 0.2, 0, 0.4, 1e-3, []
        for _ in range(10000):
            values.append(x)
            w += step * (-x - kappa * abs(w) * w)
            x += step * w
        found = sea_runs.measure({"of": "quadratic decay"}, step * np.arange(10000), np.array(values))
        self.assertAlmostEqual(found, kappa, delta=0.01 * kappa)

    def test_a_body_in_free_fall_feels_nothing(self):
        class Fall:
            t = np.array([0, 0.1, 0.2])
            linear_velocity = np.zeros((3, 1, 3))

        Fall.linear_velocity[:, 0, 2] = -9.81 * Fall.t
        t, felt = sea_runs.coordinate("felt", Fall, 9.81)
        self.assertEqual(len(t), 2)
        self.assertLess(np.abs(felt).max(), 1e-12)


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sea = Sea(DATA)
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "images").mkdir()
            sea_page.write(cls.sea, Path(folder))
            cls.made = (Path(folder) / PAGE.name).read_text(encoding="utf-8")

    def test_words_are_those_of_the_program(self):
        bare = [re.sub(NUMBER, "#", text) for text in (PAGE.read_text(encoding="utf-8"), self.made)]
        self.assertEqual(*bare)

    def test_numbers_are_those_of_the_library(self):
        shown, made = (re.findall(NUMBER, text) for text in (PAGE.read_text(encoding="utf-8"), self.made))
        for number, now in zip(shown, made):
            # One unit of the last digit.
            digit = 10.0 ** -len(number.partition(".")[2]) if "e" not in number else abs(float(number)) / 100
            self.assertAlmostEqual(float(number), float(now), delta=1.01 * digit)

    def test_measurements_have_their_sources_and_cases(self):
        self.assertGreaterEqual(len(self.sea.cases), 60)
        self.assertEqual(len(self.sea.cases), len(self.sea.rows))
        for case in self.sea.cases:
            with self.subTest(id=case.row["id"]):
                self.assertTrue(case.row["verified"])
                self.assertIn(case.row["source"], self.sea.sources)
                self.assertNotEqual(case.value, 0)

    # Kramer et al. 2021: with the drag of steady motion the ball's first troughs are 0.93, 0.84 and 0.73 of the measured ones.
    def test_what_is_right_stays_near_the_measurements(self):
        near = {
            0.01: ("barge_20", "barge_30"),
            0.02: ("kramer_30_time", "kramer_150_time"),
            0.03: ("kramer_30_extreme_1", "kramer_90_extreme_1", "kramer_30_extreme_2"),
            0.06: ("ship_heave_period", "ship_roll_period", "caisson_period", "sloshing_time_1", "sloshing_time_3", "sloshing_time_5",
                   "sloshing_tank_1_9", "sloshing_tank_1_6", "sloshing_tank_1_4", "sloshing_tank_1_2", "sloshing_tank_1"),
            0.07: ("kramer_90_extreme_2",),
            0.10: ("cone_45_50cm", "cylinder_40ms"),
            0.12: ("kramer_150_extreme_1",),
            0.20: ("kramer_30_decay", "kramer_150_decay"),
        }
        ratios = {case.row["id"]: case.ratio() for case in self.sea.cases}
        for delta, names in near.items():
            for name in names:
                with self.subTest(id=name):
                    self.assertAlmostEqual(ratios[name], 1, delta=delta)


if __name__ == "__main__":
    unittest.main()
