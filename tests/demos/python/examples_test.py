#!/usr/bin/python3
"""The examples do what docs/python.md says of them."""

import contextlib
import inspect
import io
import os
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

import bullet_ambient as ba

EXAMPLES = Path(__file__).resolve().parents[3] / "demos/python/examples"
sys.path.append(str(EXAMPLES))

import aeroplane  # noqa: E402
import hold_hover  # noqa: E402
import hold_place  # noqa: E402
import hull_rates  # noqa: E402
import hydrofoil  # noqa: E402
import plate_map  # noqa: E402
import pybullet_limits  # noqa: E402
import scene_energy  # noqa: E402
import vessels  # noqa: E402
import viscosity  # noqa: E402
import wind_field  # noqa: E402


class PyBulletTest(unittest.TestCase):
    def test_a_free_body_is_right_to_first_order_of_the_step(self):
        errors = [pybullet_limits.distances("plate_8cm", 0.25, step)[0] for step in (1 / 240, 1 / 960)]
        self.assertLess(errors[0], 0.01)
        self.assertLess(errors[1], errors[0] / 3)

    def test_an_impact_sees_dry_masses(self):
        # 2 m1 / (m1 + m2), of dry masses and of those with half of the displaced water.
        forces, ours = pybullet_limits.collision()
        carried = 2 / 3 * np.pi * 0.1**3 * 1000
        self.assertAlmostEqual(forces, 2 * 0.4189 / (0.4189 + 4.189), delta=0.01)
        self.assertAlmostEqual(ours, 2 * (0.4189 + carried) / (0.4189 + 4.189 + 2 * carried), delta=0.01)

    def test_a_heavy_body_in_a_vacuum_needs_no_force(self):
        scene = ba.Scene("football_vacuum", {"duration": 0.1, "medium": {"density": 0}})
        path, fall = pybullet_limits.fall_by_forces(scene), ba.World(scene).run(0.1, scene.time_step).position[1:, 0]
        np.testing.assert_allclose(path, fall, rtol=1e-9, atol=1e-12)


class ViscosityTest(unittest.TestCase):
    def test_sand_settles_as_spheres_do(self):
        # Of 1 and 0.1 mm in water, by the closed form of a ball, eq. (119).
        water = ba.Medium(density=1000, viscosity=1e-3)
        np.testing.assert_allclose(viscosity.settling_speeds([1e-3, 1e-4], water), [0.15773, 0.0080817], rtol=2e-4)

    def test_scenes_settle_as_the_page_says_at_any_step(self):
        # [mm/s], docs/viscosity.md: steel, sand, a cube and two bubbles; dust, pollen, fog, sand, a seed.
        expected = {"glycerine": [10.15, 39.80, 143.3, 0.50, 10.74, -4.37, -17.24],
                    "dust_and_seeds": [23.8, 56.0, 2.99, 2288, 1811]}
        for name, speeds in expected.items():
            for step in (1 / 30, 1 / 60, 1 / 240):
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # of bubbles, which rise
                    scene = ba.Scene(name, {"time_step": step, "output_step": step})
                    fallen = -1e3 * ba.World(scene).run(scene.duration).twist[-1, :, 5]
                np.testing.assert_allclose(fallen, speeds, rtol=0.01, err_msg=f"{name} at {step} s")


class HydrofoilTest(unittest.TestCase):
    def test_a_boat_flies_on_what_its_foils_lift_by_hand(self):
        scene = ba.Scene("hydrofoil_boat", {"duration": 12})
        record = ba.World(scene).run(scene.duration, 0.1)
        place, speed = record.position[-1, 0], np.linalg.norm(record.twist[-1, 0, 3:5])
        self.assertAlmostEqual(speed, 5.68, delta=0.06)
        self.assertAlmostEqual(place[2], 0.515, delta=0.005)
        np.testing.assert_allclose(record.twist[-50:, 0, [0, 1, 5]], 0, atol=0.02)  # it flies steadily
        attack = -np.radians(0.7)
        lift = hydrofoil.lift_by_hand(scene.document, place[2], speed, attack).sum()
        self.assertAlmostEqual(lift / (250 * 9.81), 0.94, delta=0.02)  # the struts float 2 %


class RocketTest(unittest.TestCase):
    def test_fins_turn_the_nose_into_the_wind_as_fast_as_by_hand(self):
        tilted = {"medium.velocity": [0, 0, 0], "gravity": [0, 0, 0], "thrusters.0.command": 0, "bodies.0.orientation": [1, 0, 0, 0],
                  "bodies.0.linear_velocity": [30, 0, 1.5], "duration": 0.7, "output_step": 1 / 240}
        turning = ba.World(ba.Scene("rocket", tilted)).run(0.7, 1 / 240).twist[1:, 0, 1]
        first, second = np.flatnonzero(np.diff(np.sign(turning)))[:2] / 240
        area, pressure = 2 * 0.08 * 0.1, 1.204 / 2 * 29.3**2  # of two fins, after the first half of a swing
        fins = pressure * area * hydrofoil.lift_slope(1.6) * 0.355
        tube = pressure * 0.9 * 2 * 0.95 * np.pi * 0.03**2 * (0.8 + 0.15 / 3)
        self.assertAlmostEqual(np.sqrt((fins - tube) / 0.0302) / (np.pi / (second - first)), 1, delta=0.1)


class AeroplaneTest(unittest.TestCase):
    def test_of_one_mesh_flies(self):
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of parts that are united
            mesh, file = Path(folder) / "aeroplane.obj", Path(folder) / "aeroplane.ambient"
            aeroplane.write_obj(aeroplane.aeroplane(), mesh)
            body = ba.FluidBody.from_shape({"type": "mesh", "file": str(mesh)}, panels=2000, wings="auto")
            body.write(file)
            self.assertEqual(sorted(wing["name"] for wing in body.wings), ["fin", "tail", "tail", "wing", "wing"])
            slope, neutral, ratio, centre = aeroplane.numbers(body)
            self.assertAlmostEqual(slope, 5.4, delta=0.25)
            self.assertAlmostEqual(neutral, 0.32, delta=0.06)
            self.assertGreater(ratio, 10)
            glides = [aeroplane.glide(file, centre, step) for step in (1 / 60, 1 / 240)]
            for distance, speed in glides:
                self.assertAlmostEqual(distance, 14.6, delta=0.5)
                self.assertAlmostEqual(speed, 8.2, delta=0.2)


class WindFieldTest(unittest.TestCase):
    def test_boats_drift_with_the_wind(self):
        drift = ba.World(wind_field.scene()).run(20).twist[-1, :, 3]
        self.assertGreater(drift.min(), 0.05)
        self.assertLess(drift.max(), 0.6)


class VesselsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        warnings.simplefilter("ignore")  # of what sinks
        cls.addClassCleanup(warnings.resetwarnings)

    def test_one_wave_too_many_swamps_a_laden_boat(self):
        rows = vessels.swamped()
        self.assertEqual(rows[rows[:, 0] < 5, 2].max(), 0)
        self.assertGreater(rows[-1, 2], 1.1)
        self.assertLess(rows[-1, 1], -2)

    def test_a_bowl_that_was_pushed_under_is_full_and_floats_by_its_wood(self):
        rows = vessels.bowl_pushed_under()
        self.assertEqual(rows[rows[:, 0] < 1, 2].max(), 0)
        self.assertAlmostEqual(rows[:, 2].max(), 0.37**2 * 0.135, delta=1e-6)
        self.assertGreater(rows[-1, 2], 0.99 * rows[:, 2].max())
        self.assertGreater(rows[-1, 1], -0.12)

    def test_a_bucket_is_filled_lifted_and_poured_out(self):
        time, _, _, water = vessels.bucket().T
        self.assertAlmostEqual(np.interp(7.5, time, water), 0.28**2 * 0.29, delta=1e-6)
        self.assertLess(water[-1], 1e-6)

    def test_a_bell_keeps_its_air_by_boyles_law(self):
        _, depth, air = vessels.diving_bell().T
        pressed = 101325 / (101325 + 9810 * (depth - 0.58 * (1 - air)))
        np.testing.assert_allclose(air[depth > 0.1], pressed[depth > 0.1], atol=2e-3)
        self.assertLess(air.min(), 0.52)

    def test_a_ship_of_four_compartments_floats_with_one_trims_with_two_and_sinks_with_three(self):
        one, two, three = (vessels.compartments(holed)[-1] for holed in (1, 2, 3))
        for holed, (_, height, trim, water) in ((1, one), (2, two)):
            # Depths of slices of the box at x of its frame, and of the water in open holds, level with the sea: what is left bears the ship.
            x = (np.arange(4000) + 0.5) / 1000 - 2
            deep = 0.3 + (x * np.sin(trim) - height) / np.cos(trim)
            self.assertGreater(0.8 - deep.max(), 0)
            deep = np.clip(deep, 0, None)
            inside = 0.96 * np.clip(deep - 0.02, 0, None) * (x < 1.98) * (x > 2.01 - holed) * (abs(x - 1) > 0.01)
            self.assertAlmostEqual(inside.sum() / 1000, water, delta=1e-4)
            self.assertAlmostEqual((deep - inside).sum() / 1000, 350 / 998, delta=1e-3)
        self.assertAlmostEqual(one[2], 0.05, delta=2e-3)
        self.assertAlmostEqual(two[2], 0.224, delta=2e-3)
        self.assertLess(three[1], -3)

    def test_a_pump_gains_on_a_leak(self):
        time, draught, water = vessels.bilge_pump().T
        # By Torricelli: 0.6 of 4 cm^2, from the sea to the level inside, at first 0.08 m lower.
        self.assertAlmostEqual(np.interp(10, time, water), 0.6 * 4e-4 * np.sqrt(2 * 9.81 * 0.08) * 10, delta=3e-5)
        self.assertAlmostEqual(np.interp(10, time, draught), 0.1 + np.interp(10, time, water) / 2, delta=1e-3)
        self.assertLess(water[-1], 1e-5)  # what leaks in a step

    def test_a_loose_ball_of_lead_heels_a_tray_until_it_lies_in_a_corner(self):
        # It still rocks by half a thousandth of a radian: the mean of some swings.
        _, trim, heel, along, across = vessels.loose_ball()[-100:].mean(axis=0)
        np.testing.assert_allclose(np.abs([along, across]), [0.42, 0.22], atol=1e-4)
        # Of a box, in its frame from the bottom: middle of the water displaced below z = depth + slope . (x, y) over the middle of the weights.
        mass, sizes = 70.26, np.array([1, 0.6])
        depth, slope = mass / 998 / sizes.prod(), -np.array([trim, heel]) / np.sqrt(1 - trim**2 - heel**2)
        displaced = np.append(slope * sizes**2 / 12 / depth, depth / 2 + (slope**2 @ sizes**2) / 24 / depth)
        weights = (10.26 * np.array([along, across, 0.08]) + 60 * np.array([0, 0, 0.15])) / mass
        lever = displaced - weights
        np.testing.assert_allclose(lever[:2], -slope * lever[2], atol=8e-5)


class PlateMapTest(unittest.TestCase):
    def test_shapes_are_made_before_the_runs_and_both_say_how_far_they_are(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as said:
            plate_map.run(2, 0.1, Path(folder))
        lines = said.getvalue().split("\r")
        shapes = [i for i, line in enumerate(lines) if line.startswith("shapes: ")]
        runs = [i for i, line in enumerate(lines) if line.startswith("runs: ")]
        self.assertLess(max(shapes), min(runs))
        self.assertRegex(lines[shapes[1]], r"shapes: 1 of 2, \d+ s left")
        self.assertIn("shapes: 2 of 2", lines[shapes[-1]])
        self.assertIn("runs: 4 of 4", lines[runs[-1]])


class HullRatesTest(unittest.TestCase):
    def hull(self, ratio):
        return ba.FluidBody.from_shape({"type": "ellipsoid", "semi_axes": [ratio, 1, 1], "faces": 500})

    def test_potential_flow_has_the_rates_of_its_closed_form(self):
        # Lamb, Hydrodynamics, articles 114 and 115: inertia coefficients of prolate spheroids.
        ratio, e = 2, np.sqrt(1 - 1 / 2**2)
        log = np.log((1 + e) / (1 - e))
        a, b = 2 * (1 - e**2) / e**3 * (log / 2 - e), 1 / e**2 - (1 - e**2) / (2 * e**3) * log
        along, across = 2 / (2 - a), 2 / (2 - b)
        turning = (ratio**2 + 1) / 5 * (1 + e**4 * (b - a) / ((2 - e**2) * (2 * e**2 - (2 - e**2) * (b - a))))
        expected = np.sqrt(along * (across - along) / (across * turning))
        hull = self.hull(ratio)
        found = sorted(hull_rates.rates(hull, hull_rates.derivatives(hull, None)))
        np.testing.assert_allclose(found, [-expected, expected], rtol=1e-2)

    def test_bare_hulls_leave_their_course(self):
        # As measured at 4 : 1, at a rate of about 1.2 speeds per length.
        hull, length = self.hull(4), 8
        rate = length * max(hull_rates.rates(hull, hull_rates.derivatives(hull, "form")))
        self.assertGreater(rate, 0.8)
        self.assertLess(rate, 1.6)
        self.assertGreater(length * max(hull_rates.rates(hull, hull_rates.derivatives(hull, "published"))), rate)


class SceneEnergyTest(unittest.TestCase):
    def test_leaves_that_fall_lose_energy_only(self):
        scene = ba.Scene("leaves", {"duration": 0.5})
        values = scene_energy.energy(scene, ba.World(scene).run(0.5, scene.output_step))
        self.assertLess(values[-1], values[0] - 1e-3)
        self.assertLess(scene_energy.rise(values), 1e-9)

    def test_a_ball_that_rests_in_water_has_the_potential_energy_of_its_weight_there(self):
        body = {"name": "ball", "shape": {"type": "sphere", "radius": 0.1}, "mass": 5, "position": [0, 0, 2]}
        steps = {"duration": 1, "time_step": 1 / 60, "output_step": 1 / 60}
        water = {"density": 1000, "viscosity": 0.001}
        scene = ba.Scene({**steps, "gravity": [0, 0, -9.81], "medium": water, "bodies": [body]})
        motion = ba.World(scene).run(0.1)
        weight = (5 - 1000 * 4 / 3 * np.pi * 0.1**3) * 9.81
        self.assertAlmostEqual(scene_energy.energy(scene, motion)[0], 2 * weight, delta=1e-12 * weight)


class HoldHoverTest(unittest.TestCase):
    def test_a_quadrotor_stays_within_a_metre_and_drifts_by_its_attitude_alone(self):
        with tempfile.TemporaryDirectory() as cache:
            runs = [hold_hover.run(holds_place, 10, cache) for holds_place in (True, False)]
        (time, held, _, turns), (_, drifts, tilt, _) = runs
        self.assertLess(np.linalg.norm(held - hold_hover.PLACE, axis=1).max(), 1)
        self.assertGreater(drifts[-1, 0], 10)
        self.assertGreater(tilt.min(), np.cos(np.radians(3)))
        propeller = ba.Scene(hold_hover.SCENE).document["thrusters"][0]["propeller"]
        hovering = np.sqrt(1.2 * 9.81 / 4 / (1.204 * propeller["diameter"] ** 4 * propeller["ct_cp"][0][1]))
        self.assertAlmostEqual(turns[time > 1].mean(), hovering, delta=0.05 * hovering)  # of updraughts


class HoldPlaceTest(unittest.TestCase):
    def test_a_vehicle_stays_within_five_centimetres(self):
        with tempfile.TemporaryDirectory() as cache:
            (time, held, thrust), (_, free, _) = (hold_place.run(10, controlled, cache) for controlled in (True, False))
        place, later = [0, 0, -2], time > 5
        self.assertLess(np.linalg.norm(held - place, axis=1)[later].max(), 0.05)
        self.assertLess(abs(thrust).max(), hold_place.LARGEST)
        self.assertGreater(np.linalg.norm(free - place, axis=1)[-1], 2)

    def test_the_controller_has_thirty_lines(self):
        lines = inspect.getsource(hold_place.Controller).splitlines()
        self.assertLessEqual(len([line for line in lines if line.strip()]), 30)


class ArgumentsTest(unittest.TestCase):
    def test_wrong_arguments_are_answered_by_the_usage(self):
        for script in EXAMPLES.glob("*.py"):
            if "__main__" in script.read_text():
                with self.subTest(script=script.name):
                    run = subprocess.run([script, "--nosuch"], capture_output=True, text=True)
                    self.assertEqual(run.returncode, 2, run.stderr)
                    self.assertTrue(run.stderr.startswith("usage: "), run.stderr)


class PicturesTest(unittest.TestCase):
    def draw(self, script, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "picture.png"
            command = [sys.executable, EXAMPLES / script, *[str(a).format(folder=folder, picture=picture) for a in arguments]]
            run = subprocess.run(command, env={**os.environ, "MPLCONFIGDIR": folder}, capture_output=True, text=True, check=True)
            self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))
            return run.stdout

    def test_tutorial(self):
        self.assertIn("carries", self.draw("tutorial.py", "{picture}"))

    def test_map_of_plates(self):
        report = self.draw("plate_map.py", "--side", 2, "--duration", 1, "--out", "{folder}", "--picture", "{picture}")
        self.assertIn("4 cases, 0 done before, 0 failed", report)


if __name__ == "__main__":
    unittest.main()
