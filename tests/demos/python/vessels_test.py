#!/usr/bin/python3
"""Vessels in worlds of the Python module: a tray by every way in, closed forms afloat at several steps, ten minutes of sloshing, bad values."""

import sys
import tempfile
import unittest
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "demos/python/examples"))

import numpy as np
import vessels

import bullet_ambient as ba

# A tray of 1 x 0.6 x 0.4 m on z = 0, walls of 2 cm.
SIZES = [[1, 0.6, 0.02], [0.02, 0.6, 0.38], [0.02, 0.6, 0.38], [0.96, 0.02, 0.38], [0.96, 0.02, 0.38]]
PLACES = [[0, 0, 0.01], [-0.49, 0, 0.21], [0.49, 0, 0.21], [0, -0.29, 0.21], [0, 0.29, 0.21]]
TRAY = {"type": "compound", "parts": [vessels.box(size, place) for size, place in zip(SIZES, PLACES)]}
DRAUGHT = 60 / 998 / 0.6
BARGE = vessels.open_box(2, 1, 0.5, 0.02)


def tray_obj():
    """The tray as one closed mesh."""
    ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    levels = [(0.5, 0.3, 0), (0.5, 0.3, 0.4), (0.48, 0.28, 0.4), (0.48, 0.28, 0.02)]
    corners = [(x * a, y * b, z) for a, b, z in levels for x, y in ring]
    faces = [(4, 3, 2, 1), (13, 14, 15, 16)]
    for low in (1, 5, 9):
        faces += [(low + k, low + (k + 1) % 4, low + 4 + (k + 1) % 4, low + 4 + k) for k in range(4)]
    return "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join("f " + " ".join(map(str, face)) + "\n" for face in faces)


def pieces_obj():
    """The tray as a convex decomposition: an object for each of its boxes."""
    text = ""
    for number, (size, place) in enumerate(zip(SIZES, PLACES)):
        text += f"o piece_{number}\n"
        for corner in range(8):
            text += "v " + " ".join(str(p + (0.5 if corner >> k & 1 else -0.5) * s) for k, (s, p) in enumerate(zip(size, place))) + "\n"
        for face in ((1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)):
            text += "f " + " ".join(str(8 * number + corner) for corner in face) + "\n"
    return text


BOXES = "".join(
    f'<collision><origin xyz="{x} {y} {z}"/><geometry><box size="{a} {b} {c}"/></geometry></collision>' for (a, b, c), (x, y, z) in zip(SIZES, PLACES)
)


def tray_urdf(collisions=BOXES):
    inertial = '<inertial><origin xyz="0 0 0.1"/><mass value="60"/><inertia ixx="4.1" iyy="8.3" izz="10.4" ixy="0" ixz="0" iyz="0"/></inertial>'
    return f'<robot name="tray"><link name="tray">{inertial}{collisions}</link></robot>'


def world_of(step, folder=".", air=None, **of):
    """A world in water at z = 0, fresh unless `water` is in it; `air`: what is above."""
    scene = {"time_step": step, "duration": 1, "output_step": step, "water": {"level": 0, "density": 1000}}
    return ba.World(ba.Scene({**scene, **({"medium": air} if air else {}), **of}, folder=folder))


def barge(step, air=None, **body):
    return world_of(step, air=air, bodies=[{"name": "barge", "shape": BARGE, "mass": 200, "centre_of_mass": [0, 0, 0], **body}])


class DoorsTest(unittest.TestCase):
    def test_a_tray_is_a_vessel_by_every_way_in(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "tray.obj").write_text(tray_obj())
            (Path(folder) / "pieces.obj").write_text(pieces_obj())
            (Path(folder) / "tray.urdf").write_text(tray_urdf())
            (Path(folder) / "pieces.urdf").write_text(tray_urdf('<collision><geometry><mesh filename="pieces.obj"/></geometry></collision>'))
            body = {"name": "tray", "mass": 60, "position": [0, 0, 0.1], "centre_of_mass": [0, 0, 0.1]}
            doors = {
                "JSON": {"bodies": [{**body, "shape": TRAY}]},
                "mesh file": {"bodies": [{**body, "shape": {"type": "mesh", "file": "tray.obj"}}]},
                "URDF": {"robots": [{"name": "robot", "urdf": "tray.urdf", "position": [0, 0, 0.05]}]},
                "hulls of URDF": {"robots": [{"name": "robot", "urdf": "pieces.urdf", "position": [0, 0, 0.05]}]},
            }
            for name, scene in doors.items():
                for step in (1 / 30, 1 / 240):
                    with self.subTest(door=name, step=step), world_of(step, folder, water={"level": 0, "density": 998}, **scene) as world:
                        tray = next(iter(world.bodies.values()))
                        world.run(20)
                        heights = []
                        for _ in range(round(5 / step)):
                            world.step()
                            heights.append(tray.position[2])
                        self.assertAlmostEqual(0.1 - np.mean(heights), DRAUGHT, delta=0.005 * DRAUGHT)
                        (hold,) = tray.holds
                        self.assertAlmostEqual(hold["capacity"], 0.96 * 0.56 * 0.38, delta=1e-7)
                        self.assertEqual(hold["volume"], 0)

    def test_holds_are_given_by_hand_or_refused_in_a_sentence(self):
        def block(x, y, z):
            corners = np.array([[a * x, b * y, c * z] for c in (-1, 1) for b in (-1, 1) for a in (-1, 1)], float)
            return corners, np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]])

        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            corners, faces = block(0.5, 0.3, 0.125)
            tank = Path(folder) / "tank.obj"
            tank.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces))
            hull = block(1, 0.5, 0.25)
            body = ba.FluidBody.from_mesh(*hull, panels=0, tanks=[tank], openings=[([0, 0, -0.125], [0, 0, -1], 0.001)])
            (hold,) = body.holds
            self.assertAlmostEqual(hold["volume"], 0.15, delta=1e-7)  # the file has the rounding of float
            for given, words in (
                ({"holds": 1}, 'holds must be "auto" or "none", not 1'),
                ({"holds": "some"}, "holds must be \"auto\" or \"none\", not 'some'"),
                ({"tanks": "tank.obj"}, "tanks must be a list of files"),
                ({"openings": [1]}, "openings must be a list of"),
                ({"openings": [([0, 0, 0], [0, 0, 1], 1)]}, "mesh: opening 1: there is no hold that it could open"),
            ):
                with self.subTest(given=given), self.assertRaisesRegex(ValueError, words):
                    ba.FluidBody.from_mesh(*hull, panels=0, **given)

    def test_a_cup_of_staves_of_many_heights_holds_water_up_to_the_lowest(self):
        """As convex hulls that came out of a decomposition: a lid along the rim would cut the staves, or have faces without area."""
        half, wall = 0.108, 0.008
        side, inside = half * np.tan(np.pi / 8), 8 * np.tan(np.pi / 8) * (half - wall) ** 2
        for heights in ([0.13488, 0.1305, 0.13856, 0.13051, 0.13688, 0.13577, 0.13172, 0.13591], [0.1349, 0.1305, 0.1386, 0.1305, 0.1369, 0.1358, 0.1317, 0.1359]):
            parts = []
            for k, height in enumerate(heights):
                turn, lie = [np.cos(np.pi * k / 8), 0, 0, np.sin(np.pi * k / 8)], np.array([np.cos(np.pi * k / 4), np.sin(np.pi * k / 4)])
                parts.append({**vessels.box([wall, 2 * side, height], [*(half - wall / 2) * lie, height / 2]), "orientation": turn})
                if k < 4:
                    parts.append({**vessels.box([2 * half, 2 * side, wall], [0, 0, wall / 2]), "orientation": turn})
            (hold,) = ba.FluidBody.from_shape({"type": "compound", "parts": parts}, panels=0).holds
            self.assertAlmostEqual(hold["volume"], inside * (min(heights) - wall), delta=0.01 * hold["volume"])


class ClosedFormsTest(unittest.TestCase):
    def test_a_barge_with_a_hole_dips_its_rim_in_torricellis_time(self):
        inner, outer, hole, depth = 1.96 * 0.96, 2.0, 0.01, 0.08
        fall = 1 / inner - 1 / outer  # of the head for the volume that comes in
        time = 2 * (np.sqrt(depth) - np.sqrt(depth - 0.8 * fall)) / (0.6 * hole * np.sqrt(2 * 9.81) * fall)
        self.assertAlmostEqual(time, 116.447, delta=1e-3)
        for step in (1 / 30, 1 / 60, 1 / 240):
            with barge(step, position=[0, 0, 0.06], centre_of_mass=[0, 0, -0.09], inertia=[20, 70, 80, 0, 0, 0]) as world:
                body = world.bodies["barge"]
                body.add_opening(0, [0, 0, -0.24], [0, 0, -1], hole)
                while body.position[2] + 0.09 + 0.25 > 0:
                    world.step()
                self.assertAlmostEqual(world.time, time, delta=0.003 * time)
                self.assertAlmostEqual(body.holds[0]["volume"], 0.8, delta=2e-3)

    def test_a_barge_with_water_lolls_to_its_angle(self):
        """tan^2 = -2 GM / (BM outside - BM inside); under air without weight, 1.2 kg/m^3 of which make 0.28 degrees."""
        for centre, degrees in ((0.2385, 7.0501), (0.24, 11.6314)):
            for step in (1 / 30, 1 / 240):
                half, start = np.radians(degrees) / 2, {"position": [0, 0, centre - 0.2], "centre_of_mass": [0, 0, centre - 0.25]}
                nothing = {"density": 0, "viscosity": 0}
                with barge(step, nothing, orientation=[np.cos(half), np.sin(half), 0, 0], inertia=[30, 70, 80, 0, 0, 0], holds={"water": [0.2]}, **start) as world:
                    heels = []
                    for _ in range(round(60 / step)):
                        world.step()
                        w, x, y, z = world.bodies["barge"].orientation
                        heels.append(np.degrees(np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))))
                self.assertAlmostEqual(np.mean(heels), degrees, delta=0.01)
                self.assertLess(np.ptp(heels), 0.2)


class SloshingTest(unittest.TestCase):
    def test_ten_minutes_in_calm_water_only_take_energy(self):
        for step in (1 / 30, 1 / 60, 1 / 240):
            for share in (0.05, 0.7):
                volume = share * 0.9
                start = {"position": [0, 0, 0.16 - (0.2 + volume) / 2], "centre_of_mass": [0, 0, -0.09], "inertia": [20, 70, 80, 0, 0, 0]}
                moves = {"angular_velocity": [0.4, 0.3, 0.1], "linear_velocity": [0.3, 0.2, 0.1]}
                with barge(step, holds={"water": [volume], "are_open": False}, **start, **moves) as world:
                    body, largest = world.bodies["barge"], []
                    for _ in range(5):
                        most = 0
                        for _ in range(round(120 / step)):
                            world.step()
                            most = max(most, np.linalg.norm(body.twist))
                        largest.append(most)
                    self.assertTrue(np.all(np.diff(largest) < 0), largest)
                    self.assertLess(largest[-1], 0.05 * largest[0])
                    self.assertEqual(body.holds[0]["volume"], volume)


class RefusalTest(unittest.TestCase):
    def test_bad_values_are_refused_in_one_line(self):
        nan = float("nan")
        for holds, words in (
            ({"water": [-0.1]}, r"bodies\[0\].holds.water\[0\] is -0.1; must be >= 0"),
            ({"water": [5]}, "5.000000 m\\^3 of water in hold 0, which must be zero to 0.903168"),
            ({"water": [0.1, 0.1]}, "water for 2 holds, but its fluid body has 1"),
            ({"water": [nan]}, "must be finite"),
            ({"sloshing_damping": -1}, "must be >= 0"),
            ({"water": 0.1}, 'must be of type "array"'),
            ({"levels": []}, 'unknown key "levels"'),
        ):
            with self.subTest(holds=holds), self.assertRaisesRegex(ValueError, words) as caught:
                barge(1 / 60, holds=holds)
            self.assertNotIn("\n", str(caught.exception))
        with barge(1 / 60, position=[0, 0, 0.1]) as world:
            body, floor, down = world.bodies["barge"], [0, 0, -0.24], [0, 0, -1]
            for call in (
                lambda: body.set_water(0, nan),
                lambda: body.set_water(1, 0.1),
                lambda: body.pump(0, nan),
                lambda: body.pump(-1, 0.1),
                lambda: body.set_opening(0, 9, True),
                lambda: body.add_opening(0, floor, [0, 0, 0], 0.1),
                lambda: body.add_opening(0, floor, down, nan),
                lambda: body.add_opening(0, [0, 0, -5], down, 0.1),
                lambda: body.add_opening(7, floor, down, 0.1),
            ):
                with self.assertRaises(ValueError) as caught:
                    call()
                self.assertNotIn("\n", str(caught.exception))
            with self.assertRaisesRegex(ValueError, "more than the area of its fluid body"):
                body.add_opening(0, floor, down, 1e9)
            world.run(1)
            self.assertEqual(body.holds[0]["volume"], 0)
        for up in ([0, 0, 0], [nan, 0, 1]):
            with self.assertRaisesRegex(ValueError, "up must be a direction"):
                ba.FluidBody.from_shape(TRAY, up=up, panels=0)


if __name__ == "__main__":
    warnings.simplefilter("ignore")  # of what sinks
    unittest.main()
