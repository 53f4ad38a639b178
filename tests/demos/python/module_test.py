#!/usr/bin/python3
"""The Python module: values against formulas and against ambient_demo, errors, interrupts."""

import csv
import json
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np

import bullet_ambient as ba

DEMO = sys.argv.pop(1)
PREPROCESS = Path(DEMO).with_name("ambient_preprocess")

BALL = {"name": "ball", "mass": 0.5, "shape": {"type": "sphere", "radius": 0.1, "faces": 80}}
STILL = {"duration": 0.2, "time_step": 0.01, "gravity": [0, 0, 0], "bodies": [BALL]}
TORN = {"bodies.0.linear_velocity": [1e200, 0, 0]}


def box(size):
    """Vertices and faces of a box about the origin."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.array(size) / 2
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))])


class Temporary(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def assertSameBits(self, a, b):
        self.assertEqual(a.shape, b.shape)
        self.assertEqual(a.tobytes(), b.tobytes())


class SettingsTest(unittest.TestCase):
    def test_values_are_frozen_and_equal_by_content(self):
        water = ba.water()
        self.assertEqual(water.density, 998.0)
        self.assertEqual(eval(repr(water), vars(ba)), water)
        self.assertEqual(hash(ba.water()), hash(water))
        self.assertEqual(pickle.loads(pickle.dumps(water)), water)
        self.assertNotEqual(ba.Medium(density=998, viscosity=1.002e-3, velocity=(1, 0, 0)), water)
        with self.assertRaises(AttributeError):
            water.density = 1
        self.assertNotEqual(water, 3)

    def test_bad_keywords_and_words_are_refused(self):
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'densty'"):
            ba.Medium(densty=1)
        with self.assertRaisesRegex(TypeError, r"Medium.velocity cannot be \(1, 2\)"):
            ba.Medium(velocity=(1, 2))
        for wrong in ({"density": "1"}, {"density": None}, {"velocity": 1}, {"velocity": ("1", 0, 0)}):
            with self.assertRaisesRegex(TypeError, f"Medium.{next(iter(wrong))} cannot be "):
                ba.Medium(**wrong)
        with self.assertRaisesRegex(TypeError, "1 is no Medium"):
            ba.FluidBody.from_shape({"type": "sphere", "radius": 1}).loads([0] * 6, 1)
        with self.assertRaisesRegex(ValueError, 'law is "mine"; must be form or published'):
            ba.FlowSettings(law="mine")
        with self.assertRaisesRegex(ValueError, r"Medium: density \[kg/m\^3\] is nan; must be zero or positive"):
            ba.Medium(density=float("nan"))
        self.assertEqual(ba.FlowSettings(law="form").law, "form")
        for quantity, wrong in (
            (r"roughness \[m\] is -1; must be zero or positive and finite", {"roughness": -1}),
            (r"roughness \[m\] is nan", {"roughness": float("nan")}),
            (r"separation angle \[rad\] is nan; must be between pi/2 and pi", {"separation_angle": float("nan"), "law": "published"}),
            (r"stall lag \[lengths over speed\] is -1; must be from 0 to 1e6", {"stall_lag": -1}),
        ):
            with self.assertRaisesRegex(ValueError, "^FlowSettings: " + quantity):
                ba.FlowSettings(**wrong)

    def test_an_angle_that_the_law_does_not_read_is_a_warning(self):
        with self.assertWarnsRegex(UserWarning, 'separation_angle: only the law "published" reads it') as caught:
            ba.FlowSettings(separation_angle=2)
        self.assertEqual(caught.filename, __file__)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            ba.FlowSettings(separation_angle=2, law="published")
            ba.FlowSettings()


class FluidBodyTest(Temporary):
    def test_a_sphere_carries_half_of_what_it_displaces(self):
        ball = ba.FluidBody.from_shape({"type": "sphere", "radius": 2})
        self.assertAlmostEqual(ball.volume, 4 / 3 * np.pi * 8, delta=0.01)
        np.testing.assert_allclose(ball.added_mass[3:, 3:], 2 / 3 * np.pi * 8 * np.eye(3), rtol=1e-12, atol=1e-12)
        self.assertEqual(ball.sphere_radius, 2)

    def test_meshes_are_whatever_looks_like_one(self):
        vertices, faces = box([1, 2, 3])
        settings = {"panels": 200, "name": "box"}
        body = ba.FluidBody.from_mesh(vertices, faces, **settings)
        self.assertAlmostEqual(body.volume, 6)
        self.assertAlmostEqual(body.areas.sum(), 22)
        np.testing.assert_allclose(body.uniform_mass[1], np.diag([13, 10, 5]) / 12)
        for mesh in (
            SimpleNamespace(vertices=vertices.tolist(), faces=faces.astype(np.int32)),
            SimpleNamespace(points=vertices, cells_dict={"triangle": faces}),
            SimpleNamespace(points=vertices, cells_dict={5: faces}),
        ):
            self.assertEqual(ba.FluidBody.from_mesh(mesh, **settings).content_hash, body.content_hash)
        with self.assertRaises(TypeError):
            ba.FluidBody.from_mesh(vertices)

    def test_arrays_are_float64_and_nobody_writes_to_them(self):
        body = ba.FluidBody.from_shape({"type": "ellipsoid", "semi_axes": [1, 2, 3], "faces": 80})
        count = body.areas.size
        for array, shape in (
            (body.added_mass, (6, 6)),
            (body.centre_of_volume, (3,)),
            (body.normals, (count, 3)),
            (body.centroids, (count, 3)),
            (body.surface_mass[1], (3, 3)),
        ):
            self.assertEqual((array.shape, array.dtype), (shape, np.float64))
            self.assertTrue(array.flags.c_contiguous)
            self.assertFalse(array.flags.writeable)
        np.testing.assert_allclose(np.linalg.norm(body.normals, axis=1), 1)

    def test_loads_of_many_twists_are_those_of_each(self):
        body = ba.FluidBody.from_shape({"type": "ellipsoid", "semi_axes": [1, 2, 3], "faces": 80})
        twists = np.random.default_rng(1).normal(size=(20, 6))
        wrenches = body.loads(twists, ba.water())
        self.assertEqual(wrenches.shape, (20, 6))
        for twist, wrench in zip(twists, wrenches):
            self.assertSameBits(body.loads(twist, ba.water()), wrench)
        self.assertSameBits(body.loads_in(ba.water())(twists), wrenches)
        self.assertLess((wrenches * twists).sum(axis=1).max(), 0)  # the fluid only takes energy
        double = body.loads(2 * twists, ba.Medium(density=1))
        np.testing.assert_allclose(double, 4 * body.loads(twists, ba.Medium(density=1)), rtol=1e-12)
        for setting in ({"law": "published"}, {"law": "published", "separation_angle": 2.0}, {"skin_friction": False}):
            self.assertGreater(abs(body.loads(twists, ba.water(), ba.FlowSettings(**setting)) - wrenches).max(), 0, setting)
        with self.assertRaisesRegex(ValueError, r"must be of shape \(N, 6\) or \(6,\), not \(2, 3\)"):
            body.loads(np.zeros((2, 3)), ba.water())

    def test_loads_beyond_the_numbers_are_none(self):
        box_body = ba.FluidBody.from_shape({"type": "box", "size": [1, 1, 1], "faces": 200}, panels=0)
        ball = ba.FluidBody.from_shape({"type": "sphere", "radius": 1})
        thin = ba.Medium(density=1, viscosity=1e-3)
        loads = box_body.loads([[1e200] * 6, [1] * 6], thin)
        self.assertTrue(np.isnan(loads[0]).all())
        self.assertSameBits(loads[1], box_body.loads([1] * 6, thin))
        for medium, twist in ((thin, [1e160, 0, 0, 0, 0, 0]), (ba.Medium(density=1e150, viscosity=1e-3), [1] * 6), (ba.Medium(density=1), [1e200] * 6)):
            self.assertTrue(np.isnan(ball.loads(twist, medium)).all(), medium)
        fast = ball.loads([0, 0, 0, 1e90, 0, 0], ba.Medium(density=1))
        np.testing.assert_allclose(fast[3], 1e180 * ball.loads([0, 0, 0, 1, 0, 0], ba.Medium(density=1))[3], rtol=1e-12)

    def test_stall_lag_matters_to_what_turns_by_the_form_law(self):
        wing = ba.FluidBody.from_shape({"type": "box", "size": [1, 2, 0.1], "faces": 200}, panels=0)
        late, now = (ba.FlowSettings(law="form", stall_lag=lag) for lag in (4.5, 0))
        along, turning = [0, 0, 0, 1, 0, -0.3], [0, 0.5, 0, 1, 0, -0.3]
        air = ba.air()
        self.assertSameBits(wing.loads(along, air, late), wing.loads(along, air, now))
        self.assertGreater(abs(wing.loads(turning, air, late) - wing.loads(turning, air, now)).max(), 0.01)
        self.assertEqual(ba.FlowSettings().stall_lag, 4.5)

    def test_reduced_loads_stand_in_where_their_error_is_allowed(self):
        shape, file = self.folder / "body.json", self.folder / "body.ambient"
        shape.write_text('{"type": "ellipsoid", "semi_axes": [1, 2, 3]}')
        command = [PREPROCESS, "build", shape, "-o", file, "--levels", "100", "--json"]
        report = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
        body = ba.FluidBody.read(file)
        forces = [
            body.loads([0.1, 0.2, 0, 1, 0.5, 0], ba.water(), ba.FlowSettings(maximum_load_error=error))[3:] for error in (0, 1e-9, 1)
        ]
        self.assertSameBits(forces[0], forces[1])
        # Half the density times the area times the mean square of the speed, by translation alone.
        scale = 0.5 * ba.water().density * body.area * (1 + 0.5**2)
        difference = np.linalg.norm(forces[2] - forces[0]) / scale
        self.assertGreater(difference, 0)
        self.assertLess(difference, report["form_levels"][0]["p99_error"])

    def test_polar_is_that_of_the_loads(self):
        body = ba.FluidBody.from_shape({"type": "box", "size": [1, 2, 0.1], "faces": 200}, panels=0)
        attack = np.radians([0, 20, 90])
        polar = body.polar(attack, flow=ba.FlowSettings(law="form"))
        self.assertEqual(polar.dtype.names, ("attack", "side_slip", "C_L", "C_D", "C_Y", "C_l", "C_m", "C_n"))
        np.testing.assert_array_equal(polar["attack"], attack)
        # Forward is x: at an angle of attack the body moves along x and down.
        force = body.loads([0, 0, 0, np.cos(attack[1]), 0, -np.sin(attack[1])], ba.Medium(density=1), ba.FlowSettings(law="form"))[3:]
        self.assertAlmostEqual(polar["C_L"][1], (force[0] * np.sin(attack[1]) + force[2] * np.cos(attack[1])) / (0.5 * 2))
        self.assertGreater(polar["C_D"][2], 1)  # a plate across the stream
        with self.assertRaisesRegex(ValueError, '"w" is none of x, y, z'):
            body.polar(0, forward="w")
        with self.assertRaisesRegex(TypeError, "unknown keyword velocity"):
            body.polar(0, velocity=3)
        with self.assertRaisesRegex(TypeError, "takes 1 positional argument"):
            ba.Medium(1.2, 1e-5)

    def test_files_and_pickles_are_the_same_body(self):
        body = ba.FluidBody.from_shape({"type": "sphere", "radius": 1, "faces": 80}, name="ball")
        file = self.folder / "ball.ambient"
        body.write(file)
        for other in (ba.FluidBody.read(file), pickle.loads(pickle.dumps(body))):
            self.assertEqual((other.name, other.content_hash), ("ball", body.content_hash))
        self.assertAlmostEqual(body.scaled(2).volume, 8 * body.volume)

    def test_waterline_tables_are_made_when_they_are_asked_for(self):
        box = {"type": "box", "size": [1, 1, 1], "faces": 48}
        plain = ba.FluidBody.from_shape(box, panels=0)
        body = ba.FluidBody.from_shape(box, panels=0, waterline_table=1)
        self.assertEqual((plain.waterline_table, body.waterline_table), (0, 1))
        self.assertNotEqual(plain.content_hash, body.content_hash)
        with self.assertRaisesRegex(ValueError, "a sphere needs no waterline table"):
            ba.FluidBody.from_shape({"type": "sphere", "radius": 1, "faces": 80}, waterline_table=1)

    def test_a_cache_solves_once(self):
        vertices, faces = box([1, 2, 3])
        solve = lambda panels: ba.FluidBody.from_mesh(vertices, faces, panels=panels, cache=self.folder)  # noqa: E731
        first = solve(200)
        (file,) = self.folder.iterdir()
        stamp = file.stat().st_mtime_ns
        self.assertEqual(solve(200).content_hash, first.content_hash)
        self.assertEqual(file.stat().st_mtime_ns, stamp)
        solve(300)
        self.assertEqual(len(list(self.folder.iterdir())), 2)

    def test_errors_are_of_the_right_kind_and_one_line(self):
        vertices, faces = box([1, 1, 1])
        with self.assertRaisesRegex(ValueError, "^brick: not watertight: 3 boundary edges"):
            ba.FluidBody.from_mesh(vertices, faces[1:], name="brick", strict=True)
        with self.assertWarnsRegex(UserWarning, "^brick: not watertight: 3 boundary edges.*; holes filled: 1, of"):
            closed = ba.FluidBody.from_mesh(vertices, faces[1:], name="brick", panels=0)
        self.assertAlmostEqual(closed.volume, 1, delta=1e-9)
        with self.assertRaisesRegex(ValueError, r"faces must be of shape \(F, 3\), not \(36,\)"):
            ba.FluidBody.from_mesh(vertices, faces.ravel())
        with self.assertRaisesRegex(TypeError, "faces must be integers, not float64"):
            ba.FluidBody.from_mesh(vertices, faces + 0.5)
        with self.assertRaisesRegex(ValueError, "faces refer to vertex 1099511627776, but there are"):
            ba.FluidBody.from_mesh(vertices, np.asarray(faces, np.int64) + 2**40)
        with self.assertRaisesRegex(ValueError, "radius is -1"):
            ba.FluidBody.from_shape({"type": "sphere", "radius": -1})
        with self.assertRaises(FileNotFoundError):
            ba.FluidBody.read(self.folder / "gone.ambient")
        (self.folder / "bad.ambient").write_text("no body")
        with self.assertRaisesRegex(ValueError, "bad.ambient: not a .ambient file"):
            ba.FluidBody.read(self.folder / "bad.ambient")
        with self.assertRaises(OSError):
            ba.FluidBody.from_shape({"type": "sphere", "radius": 1}).write(self.folder / "no" / "ball.ambient")

    def test_bodies_are_handed_over_as_by_the_program(self):
        ball = ba.FluidBody.from_shape({"type": "sphere", "radius": 0.5}, name="ball")
        ball.write(self.folder / "ball.ambient")
        options = {"mass": 300.0, "draught": 0.6, "forward": "-x", "up": "y", "gravity": 9.8}
        words = [text for key, value in options.items() for text in (f"--{key}", str(value))]
        for name in "sdf", "mjcf", "fossen":
            command = [PREPROCESS, "export", self.folder / "ball.ambient", "--format", name, *words]
            shown = subprocess.run(command, check=True, capture_output=True, text=True).stdout
            self.assertEqual(ball.export(name, self.folder / "out", **options), shown)
            self.assertEqual((self.folder / "out").read_text(), shown)
        matrices = json.loads(ball.export("fossen", medium=ba.Medium(density=1000), centre_of_mass=[0, 0.1, 0], speed=2))
        mass = 2 / 3 * np.pi * 0.5**3 * 1000
        np.testing.assert_allclose(np.diag(matrices["M_A"])[:3], mass, rtol=1e-12)
        self.assertEqual(matrices["centre_of_gravity"], [0, -0.1, 0])
        self.assertLess(matrices["tau"][0], 0)

    def test_bad_exports_are_refused(self):
        ball = ba.FluidBody.from_shape({"type": "sphere", "radius": 0.5}, name="ball")
        with self.assertRaisesRegex(ValueError, '"urdf" is none of sdf, mjcf, fossen'):
            ball.export("urdf")
        with self.assertRaisesRegex(ValueError, r"fluid body 'ball': draught \[m\] is -1, must be positive and finite"):
            ball.export("sdf", draught=-1)
        with self.assertRaisesRegex(OSError, "cannot be written"):
            ball.export("sdf", self.folder / "no" / "ball.sdf")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_doubts_are_warnings(self):
        vertices, faces = box([1, 1, 1])
        for source in "made", "read from the cache":
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                ba.FluidBody.from_mesh(vertices, faces[:, ::-1], panels=200, name="brick", cache=self.folder)
            self.assertTrue(any("brick" in str(w.message) for w in caught), source)
        dart = Path(__file__).resolve().parents[3] / "data/meshes/dart.obj"  # fins cross in its axis
        body = ba.FluidBody.from_shape({"type": "mesh", "file": str(dart)})
        body.write(self.folder / "dart.ambient")
        ba.FluidBody.read(self.folder / "dart.ambient")  # layers in the hollows between its fins end at those of a plate
        self.assertEqual(body.wings, [])
        fins = ba.FluidBody.from_shape({"type": "mesh", "file": str(dart)}, wings="auto").wings
        self.assertEqual([(fin["joined"], fin["nose"], round(fin["span"], 3)) for fin in fins], 4 * [(True, 0, 0.04)])
        with self.assertRaisesRegex(FileNotFoundError, "nowhere"):
            ba.FluidBody.from_shape({"type": "mesh", "file": str(dart)}, wings="nowhere")


class SceneTest(Temporary):
    def test_is_the_same_from_text_dict_and_pickle(self):
        scene = ba.Scene("plate_8cm")
        self.assertEqual(scene.bodies, ["plate"])
        self.assertEqual(pickle.loads(pickle.dumps(scene)), scene)
        same = ba.Scene(scene.document, folder=Path(scene.file).parent)
        self.assertEqual(same.key, scene.key)
        self.assertEqual(scene.replace({"duration": 8}), scene)
        self.assertEqual(scene.replace({"duration": 8.0}).key, scene.key)
        self.assertNotEqual(scene.replace({"duration": 3}), scene)
        self.assertIn("plate_8cm", ba.scene_names())

    def test_overrides_are_numbers_words_and_arrays_of_numpy(self):
        scene = ba.Scene(STILL, {"bodies.0.position": np.arange(3.0), "model": "vacuum", "bodies.0.mass": np.float64(2)})
        self.assertEqual(scene.document["bodies"][0]["position"], [0, 1, 2])
        self.assertEqual(scene.document["model"], "vacuum")
        self.assertEqual(scene.document["bodies"][0]["mass"], 2)

    def test_errors_are_of_the_right_kind(self):
        for error, make in (
            (ValueError, lambda: ba.Scene(STILL, {"duration": -1})),
            (ValueError, lambda: ba.Scene(STILL, {"weight": 1})),
            (ValueError, lambda: ba.Scene(STILL, {"duration": float("nan")})),
            (ValueError, lambda: ba.Scene("no_such_scene")),
            (TypeError, lambda: ba.Scene(STILL, {"duration": object()})),
            (TypeError, lambda: ba.Scene(3)),
            (FileNotFoundError, lambda: ba.Scene(self.folder / "gone.json")),
        ):
            with self.assertRaises(error):
                make()


    def test_numbers_that_are_not_finite_are_named(self):
        nan = float("nan")
        for words, make in (
            ("./scene.json: bodies[0].mass is nan; must be finite", lambda: ba.Scene({**STILL, "bodies": [{**BALL, "mass": nan}]})),
            ("bodies.0.position[2] is -inf; must be finite",
             lambda: ba.Scene(STILL, {"bodies.0.position": np.array([0, 0, -np.inf])})),
            ("duration is nan; must be finite", lambda: ba.Scene("sphere_fall").replace({"duration": np.float32(nan)})),
            ("pea: radius is inf; must be finite",
             lambda: ba.FluidBody.from_shape({"type": "sphere", "radius": np.inf}, name="pea")),
        ):
            with self.assertRaises(ValueError) as caught:
                make()
            self.assertEqual(str(caught.exception), words)


class WorldTest(Temporary):
    def test_reports_are_warnings(self):
        def world(angle, law="form"):
            return ba.World(ba.Scene(STILL, {"medium": {"density": 1}, "law": law, "bodies.0.separation_angle": angle}))

        for model in ("vacuum", "ideal", "uwrbd", "gwtf"):  # without this law
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                ba.World(ba.Scene(STILL, {"medium": {"density": 1}, "model": model, "bodies.0.separation_angle": 2}))
        with self.assertWarnsRegex(UserWarning, "body 'ball' has a separation angle, which the form law does not read.* its shape and its roughness"):
            world(2).step()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            world(np.pi / 2).step()
            world(2, "published").step()

    def test_all_reports_are_kept(self):
        scene = ba.Scene({**STILL, "gravity": [0, 0, -9.81], "medium": {"density": 998}}, {"bodies.0.separation_angle": 2})
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            world = ba.World(scene)
            world.step()
        for said in (world.warning.splitlines(), [str(warning.message) for warning in caught]):
            self.assertRegex("\n".join(sorted(said)), r"^.* so that it rises; .*\n.* has a separation angle, .*$")

    def test_takes_scenes_alone(self):
        with self.assertRaisesRegex(TypeError, r"^World takes a Scene, as in World\(Scene\(\.\.\.\)\)$"):
            ba.World(STILL)

    def test_a_world_takes_winds_and_layers(self):
        wind = [ba.wind_profile([6, 0, 0], roughness=0.1, ground=-5), ba.turbulence(length=4, smallest=2, carried=[4, 0, 0], seed=2)]
        ball = {**BALL, "mass": 0.01}
        air = {"density": 1.2, "viscosity": 1.8e-5}
        scene = {**STILL, "duration": 1, "bodies": [ball], "regions": [{"medium": air, "flow": wind}]}
        twists = [ba.World(ba.Scene(scene, {"time_step": step, "output_step": 1})).run(1).twist[-1, 0, 3:] for step in (0.01, 0.005)]
        self.assertGreater(twists[0][0], 0.1)
        np.testing.assert_allclose(twists[0], twists[1], atol=0.1)
        heavy = ba.Scene({**STILL, "gravity": [0, 0, -9.81], "regions": [
            {"medium": {"density": 1000}, "layers": ba.layers([-1, 1], [1000, 3000])}]})
        light = heavy.replace({"regions.0.layers": ba.layers([-1, 1], [1000, 1000])})
        rises = [ba.World(scene).run(0.2).position[-1, 0, 2] for scene in (heavy, light)]
        self.assertGreater(rises[0], 1.2 * rises[1])

    def test_flows_are_sampled(self):
        wind = ba.wind_profile([6, 0, 0], height=8, roughness=0.125)
        points = [[0, 0, 1], [5, 5, 8]]
        np.testing.assert_allclose(ba.flow_velocity([wind], points), [[3, 0, 0], [6, 0, 0]], atol=1e-12)
        gust = ba.discrete_gust([0, 2, 0], rise=2, hold=None)
        np.testing.assert_allclose(ba.flow_velocity([wind, gust], points[:1], 9), [[3, 2, 0]], atol=1e-12)
        current = ba.current_profile([0, 2], [[1, 0, 0], [0, 0, 0]])
        np.testing.assert_allclose(ba.flow_velocity([current], [[0, 0, -0.5]]), [[0.75, 0, 0]], atol=1e-12)
        dryden = [ba.flow_velocity([ba.dryden_gusts(height=30, seed=seed)], points, 3) for seed in (1, 1, 2)]
        np.testing.assert_array_equal(dryden[0], dryden[1])
        self.assertTrue((dryden[0] != dryden[2]).any())
        self.assertEqual(ba.flow_velocity([ba.gauss_markov_gusts([0, 2, 0], 3)], points, 3).any(axis=0).tolist(), [False, True, False])
        with self.assertRaisesRegex(ValueError, r"^wind profile: roughness \[m\] is 20; must be from 0 to below the height$"):
            ba.flow_velocity([ba.wind_profile([1, 0, 0], roughness=20)], points)
        with self.assertRaisesRegex(ValueError, "number of|must be|flow"):
            ba.flow_velocity([{"storm": {}}], points)
        self.assertAlmostEqual(ba.standard_atmosphere(0).density, 1.225, delta=1e-4)
        self.assertRaisesRegex(ValueError, "must be from -5000 to 86000", ba.standard_atmosphere, 1e5)
        self.assertEqual(ba.air_layers(0, 500), {"standard_atmosphere": [0, 500]})
        with self.assertRaisesRegex(ValueError, "^heights are 2 and densities 1; must be as many$"):
            ba.layers([0, 1], [1000])

    def test_regions_change_while_it_runs(self):
        world = ba.World(ba.Scene({**STILL, "gravity": [0, 0, -9.81], "water": {"level": -5}}))
        world.step()
        self.assertEqual(world.bodies["ball"].wet["volume"], 0)
        world.set_regions(world.scene.replace({"water.level": 5}))
        world.step()
        self.assertAlmostEqual(world.bodies["ball"].wet["share"], 1, delta=1e-12)
        with self.assertRaisesRegex(ValueError, "it has 0 waters and regions, the world 1; must be as many"):
            world.set_regions(ba.Scene(STILL))

    def test_forces_and_torques_act_for_one_step(self):
        vacuum = ba.Scene(STILL, {"model": "vacuum", "bodies.0.inertia": [0.2, 0.3, 0.4, 0, 0, 0]})
        world = ba.World(vacuum)
        ball = world.bodies["ball"]
        ball.apply_force([1, 0, 0], at=[0, 0.3, 0])
        ball.apply_torque([0.2, 0, 0])
        world.step(5)
        # One step of 0.01 s: the velocity F h / m, the spins tau h / I.
        np.testing.assert_allclose(ball.twist, [0.01, 0, -0.0075, 0.02, 0, 0], rtol=1e-3, atol=1e-5)
        np.testing.assert_allclose(world.position[0, 0], 5 * 0.01 * 0.02)
        self.assertAlmostEqual(world.time, 0.05)
        with self.assertRaisesRegex(ValueError, "force must be three numbers"):
            ball.apply_force([1, 2])

    def test_a_force_moves_the_fluid_too(self):
        world = ba.World(ba.Scene(STILL, {"medium": {"density": 1000}}))
        world.bodies["ball"].apply_force([1, 0, 0])
        world.step()
        carried = 2 / 3 * np.pi * 0.1**3 * 1000
        self.assertAlmostEqual(world.twist[0, 3], 0.01 / (0.5 + carried), delta=1e-6)

    def test_a_medium_that_is_set_anew_in_each_step_carries_the_body(self):
        scene = ba.Scene(STILL, {"model": "ideal", "bodies.0.mass": 4 / 3 * np.pi * 0.1**3 * 1000})
        world = ba.World(scene)
        places = []
        for _ in range(400):  # one period
            speed = 0.5 * np.sin(2 * np.pi * world.time / 4)
            world.bodies["ball"].set_medium(ba.Medium(density=1000, velocity=[speed, 0, 0]))
            world.step()
            places.append(world.position[0, 0])
        self.assertAlmostEqual(np.ptp(places), 0.5 * 4 / np.pi, delta=0.01)

    def test_pose_and_twist_may_be_set(self):
        world = ba.World(ba.Scene(STILL, {"model": "vacuum"}))
        ball = world.bodies["ball"]
        ball.set_twist([0, 0, 2, 1, 0, 0])
        ball.set_pose([5, 6, 7], [0, 1, 0, 0])
        np.testing.assert_allclose(ball.position, [5, 6, 7])
        np.testing.assert_allclose(np.abs(ball.orientation), [0, 1, 0, 0])
        np.testing.assert_allclose(ball.twist, [0, 0, 2, 1, 0, 0])
        world.step(10)
        np.testing.assert_allclose(ball.position, [5.1, 6, 7])
        with self.assertRaisesRegex(ValueError, "twist must be six numbers"):
            ball.set_twist([1, 2, 3])

    def test_the_kinetic_energy_is_that_of_the_body_and_its_water(self):
        world = ba.World(ba.Scene(STILL, {"medium.density": 998}))
        ball = world.bodies["ball"]
        ball.set_twist([0, 0, 0, 3, 0, 4])
        wet_mass = BALL["mass"] + 998 * 2 / 3 * np.pi * BALL["shape"]["radius"]**3  # with half of what it displaces
        self.assertAlmostEqual(ball.kinetic_energy / (wet_mass * 25 / 2), 1, delta=1e-12)
        with self.assertRaisesRegex(ValueError, "ball"):
            ba.World(ba.Scene(STILL, {"model": "vacuum"})).bodies["ball"].kinetic_energy  # noqa: B018

    def test_another_medium_may_be_set(self):
        world = ba.World(ba.Scene(STILL, {"bodies.0.linear_velocity": [1, 0, 0]}))
        world.bodies["ball"].set_medium(ba.water())
        world.step(10)
        self.assertLess(world.twist[0, 3], 0.95)
        with self.assertRaisesRegex(ValueError, r"density \[kg/m\^3\] is -1"):
            world.bodies["ball"].set_medium(ba.Medium(density=-1))

    def test_holds_are_read_filled_pumped_and_opened(self):
        scene = ba.Scene("barge_floods", {"bodies.0.holds": {"water": [0.1]}})
        with ba.World(scene) as world:
            barge = world.bodies["barge"]
            (hold,) = barge.holds
            self.assertAlmostEqual(hold["capacity"], 1.96 * 0.96 * 0.48, places=9)
            self.assertEqual(hold["volume"], 0.1)
            world.run(1)
            self.assertGreater(barge.holds[0]["volume"], 0.1)
            self.assertFalse(barge.holds[0]["has_trapped_air"])
            openings = [0, 1]
            for opening in openings:
                barge.set_opening(0, opening, False)
            barge.set_water(0, 0.2)
            barge.pump(0, -0.01)
            world.run(5)
            self.assertAlmostEqual(barge.holds[0]["volume"], 0.15, places=9)
            barge.pump(0, 0)
            hole = barge.add_opening(0, [0.5, 0, -0.23], [0, 0, -1], 0.01)
            self.assertEqual(hole, 2)
            world.run(1)
            self.assertGreater(barge.holds[0]["volume"], 0.152)
            with self.assertRaisesRegex(ValueError, "body 'barge' has 1 holds, and none has the number 3"):
                barge.set_water(3, 0)
            with self.assertRaisesRegex(ValueError, "has no opening with the number 7"):
                barge.set_opening(0, 7, True)
            self.assertEqual(ba.World(ba.Scene("duck_dive")).bodies["ball_0.3"].holds, [])

    def test_the_wrench_of_the_fluid_is_the_change_of_momentum(self):
        scene = ba.Scene(STILL, {"gravity": [0, 0, -9.81], "water": {"level": 100}, "bodies.0.linear_velocity": [1, 0, 0]})
        world = ba.World(scene)
        ball = world.bodies["ball"]
        with self.assertRaisesRegex(RuntimeError, "readWrench"):
            ball.wrench
        ball.read_wrench()
        before = world.twist[0, 3:]
        world.step()
        wrench = ball.wrench
        self.assertEqual(list(wrench), ["pressure", "friction", "buoyancy", "waves", "wind", "added_mass", "constraints"])
        change = scene.document["bodies"][0]["mass"] * (world.twist[0, 3:] - before) / scene.time_step
        weight = np.array(scene.document.get("gravity", [0, 0, 0])) * scene.document["bodies"][0]["mass"]
        np.testing.assert_allclose(sum(part[3:] for part in wrench.values()), change - weight, rtol=1e-9, atol=1e-9)
        self.assertLess(wrench["pressure"][3], 0)
        wet = ball.wet
        self.assertAlmostEqual(wet["share"], 1, places=12)
        self.assertEqual(wet["region"], 0)
        np.testing.assert_allclose(wet["centre_of_buoyancy"], world.position[0], atol=1e-9)

    def test_a_raft_floats_and_goes_on_from_a_state(self):
        raft = {"name": "raft", "mass": 998 * 0.4 * 0.3 * 0.1 / 2, "shape": {"type": "box", "size": [0.4, 0.3, 0.1]}}
        scene = ba.Scene({"duration": 1, "time_step": 1 / 120, "water": {"level": 0}, "bodies": [raft]})
        world = ba.World(scene)
        world.step(60)
        state = world.state()
        world.step(60)
        end = world.position
        self.assertLess(abs(end[0, 2]), 1e-3)  # half of it displaces its mass
        world.restore(state)
        world.step(60)
        self.assertSameBits(world.position, end)

    def test_work_tells_what_bounds_removed(self):
        world = ba.World(ba.Scene("plate_10cm"))
        world.step(480)
        work = world.bodies["plate"].work
        self.assertGreater(work["load_evaluations"], 0)
        self.assertEqual(work["halted"], 0)
        self.assertGreater(work["energy_removed"], 0)

    def test_run_is_what_ambient_demo_writes(self):
        subprocess.run([DEMO, "plate_9cm", "--out", self.folder, "--quiet", "--set", "duration=1"], check=True)
        with open(self.folder / "trajectory.csv") as file:
            rows = list(csv.reader(file))[1:]
        numbers = np.array([[float(cell) for cell in [row[0], *row[2:]]] for row in rows])
        with ba.World(ba.Scene("plate_9cm")) as world:
            motion = world.run(1)
        self.assertSameBits(motion.t, np.ascontiguousarray(numbers[:, 0]))
        self.assertSameBits(motion.position[:, 0], np.ascontiguousarray(numbers[:, 1:4]))
        self.assertSameBits(motion.orientation[:, 0], np.ascontiguousarray(numbers[:, 4:8]))
        self.assertSameBits(motion.twist[:, 0], np.ascontiguousarray(numbers[:, 8:]))
        np.testing.assert_array_equal(motion.orientation_xyzw[..., 3], motion.orientation[..., 0])
        np.testing.assert_array_equal(motion.linear_velocity, motion.twist[..., 3:])

    def test_a_second_run_goes_on(self):
        scene = ba.Scene("plate_9cm")
        once, twice = ba.World(scene), ba.World(scene)
        twice.run(0.5, 0.1)
        motion = twice.run(0.5)
        np.testing.assert_allclose(motion.position, once.run(1).position[50:], rtol=1e-9)
        self.assertSameBits(twice.position, once.position)  # times differ by rounding, steps do not
        self.assertEqual((motion.t[0], motion.t[-1]), (0.5, 1))
        for duration, step in ((0, None), (1, 1e-9), (float("nan"), None), (1e30, None)):
            with self.assertRaises(ValueError):
                once.run(duration, step)

    def test_goes_on_from_a_state_bit_for_bit(self):
        scene = ba.Scene("chain_in_water")
        world, other = ba.World(scene), ba.World(scene)
        world.step(30)
        state = world.state()
        world.step(30)
        end = world.position
        world.restore(state)
        self.assertAlmostEqual(world.time, 30 * scene.time_step)
        other.restore(state)
        for again in (world, other):
            again.step(30)
            self.assertSameBits(again.position, end)
        with self.assertRaises(ValueError):
            world.restore(state[:-1])
        with self.assertRaises(ValueError):
            ba.World(ba.Scene(STILL)).restore(state)
        self.assertSameBits(world.position, end)

    def test_parts_of_compounds_that_touch_go_on_from_a_state_bit_for_bit(self):
        """Two tables of three boxes fall on each other."""
        size = [([0.6, 0.2, 0.1], [0, 0, 0.3]), ([0.1, 0.2, 0.6], [-0.2, 0, 0]), ([0.1, 0.2, 0.6], [0.2, 0, 0])]
        table = {"type": "compound", "parts": [{"shape": {"type": "box", "size": s}, "position": p} for s, p in size]}
        bodies = [{"name": "floor", "mass": 0, "position": [0, 0, -0.5], "shape": {"type": "box", "size": [10, 10, 1]}}]
        for i in range(2):
            turn = np.array([0.9, 0.1 * i, 0.2, 0.1])
            bodies.append({"name": f"table_{i}", "mass": 10, "shape": table, "position": [0.05 * i, 0, 0.5 + 0.8 * i],
                           "orientation": list(turn / np.linalg.norm(turn))})
        scene = ba.Scene({"duration": 1, "time_step": 1 / 120, "bodies": bodies})
        world, other = ba.World(scene), ba.World(scene)
        for steps in (48, 48):
            world.step(steps)
            state = world.state()
            world.step(120)
            end = world.position
            for again in (world, other):
                again.restore(state)
                again.step(120)
                self.assertSameBits(again.position, end)
            world.restore(state)

    def test_a_state_that_is_not_finite_is_an_arithmetic_error(self):
        world = ba.World(ba.Scene(STILL, TORN))
        with self.assertRaisesRegex(FloatingPointError, 'body "ball": its state is not finite at t = 0.01 s'):
            world.step()

    def test_a_closed_world_answers_nothing(self):
        with ba.World(ba.Scene(STILL)) as world:
            ball = world.bodies["ball"]
        for ask in (world.step, world.state, lambda: world.position, lambda: ball.twist):
            with self.assertRaisesRegex(ValueError, "the world is closed"):
                ask()

    def test_the_interpreter_is_free_and_interrupts_are_heard(self):
        world = ba.World(ba.Scene(STILL))
        ticks, kinds = [], []

        def tick():
            time.sleep(0.05)
            ticks.append(time.monotonic())
            try:
                world.step()
            except RuntimeError as error:
                kinds.append(str(error))
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=tick)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            world.step(10**9)
        thread.join()
        self.assertEqual(len(ticks), 1)
        self.assertEqual(kinds, ["the world is in use by another thread"])
        world.step()  # and is free again


class RobotTest(Temporary):
    ARM = Path(__file__).resolve().parents[3] / "data/robots/underwater_arm.urdf"
    FALLING = {"duration": 1, "time_step": 0.01, "medium": {"density": 0}, "bodies": [dict(BALL, position=[5, 0, 0])]}
    WEIGHT = 6.663 * 9.81  # of an upper arm or forearm, whose middle is 0.3 m from its joint

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.cache = folder.name

    def arm(self, **settings):
        self.world = ba.World(ba.Scene(self.FALLING), robots=True, cache=self.cache)
        self.world.step(3)
        return self.world.load_urdf(self.ARM, name="arm", fixed_base=True, **settings)

    def test_robots_join_a_world_that_moves(self):
        arm = self.arm(joint_positions={"elbow": -0.8})
        self.assertEqual((arm.name, arm.joints), ("arm", ["yaw", "shoulder", "elbow"]))
        np.testing.assert_array_equal(arm.joint_positions, [0, 0, -0.8])
        self.assertEqual(list(self.world.bodies), ["ball", "arm/turntable", "arm/upper_arm", "arm/forearm"])
        self.assertEqual(self.world.position.shape, (4, 3))
        cosine, sine = np.cos(0.8), np.sin(0.8)
        pose = [[cosine, 0, sine, 0.6], [0, 1, 0, 0], [-sine, 0, cosine, 0.2], [0, 0, 0, 1]]
        np.testing.assert_allclose(arm.pose("forearm"), pose, atol=1e-12)
        other = self.world.load_urdf(self.ARM, name="other", fixed_base=True, position=[0, 3, 0])
        np.testing.assert_allclose(other.pose("turntable")[:3, 3], [0, 3, 0], atol=1e-12)
        self.assertEqual(list(self.world.robots), ["arm", "other"])
        self.world.step(20)
        again = ba.World(self.world.scene, cache=self.cache)  # the robots are in its scene
        self.assertEqual(again.bodies.keys(), self.world.bodies.keys())

    def test_robots_may_be_the_only_bodies(self):
        world = ba.World(ba.Scene({**self.FALLING, "bodies": []}), robots=True, cache=self.cache)
        world.step()
        self.assertEqual(world.position.shape, (0, 3))
        world.load_urdf(self.ARM, name="arm", fixed_base=True)
        world.step()
        self.assertEqual(list(world.bodies), ["arm/turntable", "arm/upper_arm", "arm/forearm"])

    def test_a_world_with_room_for_robots_moves_as_others(self):
        free = [ba.World(ba.Scene("plate_9cm"), robots=robots).run(0.2).position for robots in (False, True)]
        self.assertSameBits(*free)

    def test_motors_hold_weights_and_sensors_say_so(self):
        arm = self.arm()
        for joint in arm.joints:
            arm.set_motor(joint, position=0.3)
        arm.measure("shoulder")
        self.world.step(400)
        np.testing.assert_allclose(arm.joint_positions, 0.3, atol=0.01)  # ten iterations let the elbow sag
        np.testing.assert_allclose(arm.joint_velocities, 0, atol=1e-3)
        _, lift, bend = arm.joint_positions
        elbow = self.WEIGHT * 0.3 * np.cos(lift + bend)
        shoulder = self.WEIGHT * 0.9 * np.cos(lift) + elbow
        np.testing.assert_allclose(arm.motor_efforts[1:], [shoulder + 0.2, elbow + 0.2], atol=0.02)  # the joints' brakes: 0.2 N m
        np.testing.assert_allclose(arm.joint_wrench("shoulder"), [0, 0, 0, 0, 0, 2 * self.WEIGHT], atol=0.01 * self.WEIGHT)
        arm.set_motor("elbow", velocity=0.5)
        self.world.step(50)
        self.assertAlmostEqual(arm.joint_velocities[2], 0.5, delta=0.05)  # ten iterations again
        arm.set_motor("elbow", velocity=0, effort=0)
        self.world.step()
        self.assertEqual(arm.motor_efforts[2], 0)

    def test_robots_may_begin_in_motion_and_be_put_elsewhere(self):
        world = ba.World(ba.Scene(self.FALLING), robots=True, cache=self.cache)
        arm = world.load_urdf(self.ARM, name="turning", fixed_base=True, position=[0, 9, 0], joint_velocities={"yaw": 0.5})
        np.testing.assert_allclose(arm.joint_velocities, [0.5, 0, 0])
        arm.set_joint("elbow", position=0.4, velocity=-0.2)
        np.testing.assert_allclose(arm.joint_positions, [0, 0, 0.4])
        np.testing.assert_allclose(arm.joint_velocities, [0.5, 0, -0.2])
        arm.set_pose([1, 2, 3])
        np.testing.assert_allclose(arm.pose("turntable")[:3, 3], [1, 2, 3], atol=1e-12)
        with self.assertRaisesRegex(ValueError, "fixed base"):
            arm.set_twist([0, 0, 0, 1, 0, 0])
        swimmer = ba.World(ba.Scene("three_link_swimmer"), cache=self.cache)
        swimmer.robots["swimmer"].set_twist([0, 0, 2, 1, 0, 0])
        np.testing.assert_allclose(swimmer.bodies["swimmer/front"].twist, [0, 0, 2, 1, 2.4, 0], atol=1e-12)  # 1.2 m ahead of the base

    def test_torques_act_for_one_step(self):
        arm = self.arm()
        for joint in arm.joints[1:]:
            arm.set_motor(joint, position=0)
        self.world.step(100)
        arm.apply_torque("yaw", 50)
        self.world.step()
        # Both arms and the turntable about the axis, a brake of 0.2 N m.
        moment = 0.04 + 2 * 0.1832814926 + 6.663 * (0.3**2 + 0.9**2)
        self.assertAlmostEqual(arm.joint_velocities[0], 0.01 * 49.8 / moment, delta=1e-3)
        before = arm.joint_velocities[0]
        self.world.step()
        self.assertLessEqual(arm.joint_velocities[0], before)

    def test_what_does_not_fit_is_refused(self):
        with self.assertRaisesRegex(ValueError, r"needs World\(scene, robots=True\)"):
            ba.World(ba.Scene(STILL)).load_urdf(self.ARM)
        arm = self.arm()
        state = self.world.state()
        for error, text, call in (
            (FileNotFoundError, "gone.urdf", lambda: self.world.load_urdf("gone.urdf")),
            (ValueError, 'unknown key "pose"', lambda: self.world.load_urdf(self.ARM, pose=1)),
            (ValueError, "its mass is 0 kg", lambda: self.world.load_urdf(self.ARM)),
            (ValueError, "arm", lambda: self.world.load_urdf(self.ARM, name="arm", fixed_base=True)),
            (ValueError, 'joint "wrist" is not known; known are: yaw, shoulder, elbow', lambda: arm.set_motor("wrist", 1)),
            (ValueError, "a position or a velocity", lambda: arm.set_motor("yaw", 1, 2)),
            (ValueError, "must be finite", lambda: arm.set_motor("yaw", float("nan"))),
            (ValueError, "the torque of joint \"yaw\" is not finite", lambda: arm.apply_torque("yaw", float("nan"))),
            (ValueError, 'joint "yaw" is not measured', lambda: arm.joint_wrench("yaw")),
        ):
            with self.assertRaisesRegex(error, text):
                call()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for name, more, limit in (("a", {"roughness": 9}, r"roughness \[m\] is 9, must be from 0 to"),
                                      ("b", {"roughness": 9}, r"roughness \[m\] is 9, must be from 0 to"),
                                      ("c", {"medium": {"density": 1, "viscosity": 1e25}}, r"viscosity of the medium \[Pa s\] is 1e\+25")):
                with self.assertRaisesRegex(ValueError, rf'body "{name}/turntable": {limit}'):
                    self.world.load_urdf(self.ARM, name=name, fixed_base=True, position=[0, 3, 0], **more)
                self.assertEqual((len(self.world.position), list(self.world.bodies)[1:]),
                                 (4, ["arm/turntable", "arm/upper_arm", "arm/forearm"]))
        self.world.restore(state)  # of as many bodies and constraints as before
        self.assertEqual(list(self.world.robots), ["arm"])
        self.world.load_urdf(self.ARM, name="other", fixed_base=True, position=[0, 3, 0], medium={"density": 1000})
        forearm = self.world.bodies["other/forearm"]
        forearm.read_wrench()
        self.world.step()
        self.assertGreater(abs(forearm.wrench["buoyancy"]).max(), 1)
        with self.assertRaises(ValueError):
            self.world.restore(state)  # of a world with one robot


class RolloutTest(Temporary):
    MASSES = np.linspace(1e-4, 4e-4, 6)

    def plates(self, **more):
        return ba.rollout(ba.Scene("plate_8cm"), {"bodies.0.mass": self.MASSES}, duration=0.5, **more)

    def test_the_same_bits_on_any_number_of_threads(self):
        one = self.plates(threads=1)
        self.assertEqual(one.motion.position.shape, (6, 51, 1, 3))
        self.assertEqual(one.errors, {})
        for threads in (2, 5):
            other = self.plates(threads=threads)
            self.assertSameBits(other.motion.twist, one.motion.twist)
            self.assertSameBits(other.summary["end_position_z"], one.summary["end_position_z"])
        world = ba.World(ba.Scene("plate_8cm", {"bodies.0.mass": self.MASSES[3]}))
        self.assertSameBits(world.run(0.5).position, one.motion.position[3])
        np.testing.assert_array_equal(one.summary["mass"][:, 0], self.MASSES)
        np.testing.assert_array_equal(one.summary["end_position_z"], one.motion.position[:, -1, :, 2])

    def test_worlds_side_by_side_do_not_disturb_each_other(self):
        scenes = [ba.Scene("box_pile"), ba.Scene("box_pile"), ba.Scene("box_pile")]
        side_by_side = ba.rollout(scenes, threads=3, duration=0.3)
        alone = ba.World(scenes[0]).run(0.3)
        for run in side_by_side.motion.twist:
            self.assertSameBits(run, alone.twist)

    def test_failed_runs_are_apart(self):
        speeds = [[1, 0, 0], [1e200, 0, 0], [2, 0, 0]]
        out = ba.rollout(ba.Scene(STILL), {"bodies.0.linear_velocity": speeds})
        self.assertEqual(out.failed.tolist(), [1])
        self.assertIn("not finite", out.errors[1])
        self.assertTrue(np.isnan(out.motion.position[1]).all())
        self.assertTrue(np.isfinite(out.motion.position[[0, 2]]).all())
        self.assertEqual(out.summary["body"].ravel().tolist(), ["ball", "", "ball"])

    def test_progress_is_told_and_may_stop_it(self):
        told = []
        self.plates(progress=lambda *counts: told.append(counts))
        self.assertEqual(told[-1], (6, 6))
        self.assertEqual(told, sorted(set(told)))

        def refuse(ended, runs):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            self.plates(progress=refuse)

    def test_interrupts_stop_it(self):
        endless = ba.Scene(STILL, {"duration": 1e6, "output_step": 1e6})
        timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            ba.rollout([endless, endless, endless])
        timer.join()

    def test_summary_alone_and_files(self):
        out = self.plates(motion=False)
        self.assertIsNone(out.motion)
        self.plates().save(self.folder / "sweep.npz")
        with np.load(self.folder / "sweep.npz") as saved:
            self.assertEqual(sorted(saved), ["failed", "orientation", "position", "summary", "t", "twist"])
            self.assertSameBits(saved["summary"]["swings"], out.summary["swings"])

    def test_runs_that_do_not_fit_are_refused(self):
        scene = ba.Scene(STILL)
        two = dict(STILL, bodies=[BALL, dict(BALL, name="other", position=[1, 0, 0])])
        for arguments in (
            ([],),
            ([scene, ba.Scene(two)],),
            ([scene, scene.replace({"duration": 1})],),
            (scene, {"bodies.0.mass": [1, 2], "duration": [1]}),
            (scene, {"bodies.0.mass": [1, -2]}),
            ([scene], {"duration": [1]}),
        ):
            with self.assertRaises(ValueError):
                ba.rollout(*arguments)
        durations = ba.rollout([scene, scene.replace({"duration": 1})], motion=False)
        self.assertEqual(durations.summary["end_time"].ravel().tolist(), [0.2, 1])


class CasesTest(Temporary):
    def test_results_are_those_of_ambient_demo_and_of_a_rollout(self):
        cases = self.folder / "cases.jsonl"
        masses = np.linspace(0.1, 0.5, 5)
        self.assertEqual(ba.write_cases(cases, STILL, {"bodies.0.mass": masses, "model": ["ambient"] * 5}), 5)
        for i in (1, 0):
            counts = ba.run_cases(cases, self.folder / "python", shard=(i, 2))
        self.assertEqual(counts, (3, 0, {}))
        (self.folder / "cases.json").write_text(json.dumps(STILL))
        for mass in masses:
            command = [DEMO, self.folder / "cases.json", "--out", self.folder / "demo", "--quiet"]
            subprocess.run([*command, "--set", f"bodies.0.mass={mass}"], check=True)
            key = ba.Scene(STILL, {"bodies.0.mass": mass, "model": "ambient"}).key
            for name in ("trajectory.csv", "geometry.json"):
                self.assertEqual((self.folder / "python" / key / name).read_bytes(), (self.folder / "demo" / name).read_bytes())
        table = ba.collect(cases, self.folder / "python")
        np.testing.assert_array_equal(table["case"], range(5))
        np.testing.assert_array_equal(table["bodies.0.mass"], masses)
        self.assertEqual(set(table["model"]), {"ambient"})
        out = ba.rollout(ba.Scene(STILL), {"bodies.0.mass": masses}, motion=False)
        self.assertSameBits(np.ascontiguousarray(table["end_position_x"]), np.ascontiguousarray(out.summary["end_position_x"][:, 0]))

    def test_errors(self):
        with self.assertRaises(FileNotFoundError):
            ba.run_cases(self.folder / "gone.jsonl", self.folder)
        (self.folder / "cases.jsonl").write_text("[]\n")
        with self.assertRaises(ValueError):
            ba.run_cases(self.folder / "cases.jsonl", self.folder, shard=(2, 2))
        self.assertEqual(list(ba.run_cases(self.folder / "cases.jsonl", self.folder).failures), [0])


if __name__ == "__main__":
    unittest.main()
