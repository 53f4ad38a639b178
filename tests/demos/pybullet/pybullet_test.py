#!/usr/bin/python3
"""The plugin in a real PyBullet; skipped where none imports."""

import importlib.util
import json
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

if importlib.util.find_spec("pybullet") is None:
    print("SKIPPED: PyBullet does not import; PYTHONPATH=FOLDER ctest finds one in FOLDER")
    sys.exit(77)

import numpy as np
import pybullet as p

import bullet_ambient.pybullet
from bullet_ambient import FluidBody
from bullet_ambient.pybullet import Fluid, Spectrum, Wave

RHO = 998.0
# Five boxes: a tray of 1 x 0.6 x 0.4 m on z = 0, walls of 2 cm.
TRAY_HALVES = [[0.5, 0.3, 0.01], *[[0.01, 0.3, 0.19]] * 2, *[[0.48, 0.01, 0.19]] * 2]
TRAY_PLACES = [[0, 0, 0.01], [-0.49, 0, 0.21], [0.49, 0, 0.21], [0, -0.29, 0.21], [0, 0.29, 0.21]]
CUBE = 0.638  # added mass of a cube over the displaced mass


HULLS = """
import sys, pybullet as p
from bullet_ambient.pybullet import Fluid
for _ in range(2):
    client = p.connect(p.DIRECT)
    fluid = Fluid(client)
    fluid.settings(folder=sys.argv[1])
    fluid.water(level=0)
    for _ in range(2):
        corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        shape = p.createCollisionShape(p.GEOM_MESH, vertices=corners, physicsClientId=client)
        p.createMultiBody(100, shape, physicsClientId=client)
        p.stepSimulation(physicsClientId=client)
        shapes = fluid.status()["shapes"]
        p.resetSimulation(physicsClientId=client)
    p.disconnect(client)
print(shapes)
"""


class Case(unittest.TestCase):
    def setUp(self):
        self.places = 0
        self.client = p.connect(p.DIRECT)
        self.fluid = Fluid(self.client)

    def tearDown(self):
        if p.isConnected(self.client):
            p.disconnect(self.client)

    def box(self, half=0.1, mass=4.0, position=None, client=None, **more):
        client = self.client if client is None else client
        self.places += 1
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[half] * 3, physicsClientId=client)
        position = (self.places, 0, -1) if position is None else position
        body = p.createMultiBody(mass, shape, basePosition=position, physicsClientId=client, **more)
        p.changeDynamics(body, -1, linearDamping=0, angularDamping=0, physicsClientId=client)
        return body

    def arm(self, **motor):
        """A plate of 1 m on a hinge, with a motor."""
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.05, 0.2], physicsClientId=self.client)
        arm = p.createMultiBody(
            0, -1, linkMasses=[20], linkCollisionShapeIndices=[shape], linkVisualShapeIndices=[-1], linkPositions=[[0, 0, 0]],
            linkOrientations=[[0, 0, 0, 1]], linkInertialFramePositions=[[0.5, 0, 0]],
            linkInertialFrameOrientations=[[0, 0, 0, 1]], linkParentIndices=[0], linkJointTypes=[p.JOINT_REVOLUTE],
            linkJointAxis=[[0, 0, 1]], physicsClientId=self.client)
        p.changeDynamics(arm, -1, linearDamping=0, angularDamping=0, jointDamping=0, physicsClientId=self.client)
        p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, force=0, physicsClientId=self.client)
        p.setJointMotorControl2(arm, 0, physicsClientId=self.client, **motor)
        return arm

    def steps(self, count, client=None):
        for _ in range(count):
            p.stepSimulation(physicsClientId=self.client if client is None else client)

    def height(self, body, client=None):
        client = self.client if client is None else client
        return p.getBasePositionAndOrientation(body, physicsClientId=client)[0][2]

    def speed(self, body):
        return p.getBaseVelocity(body, physicsClientId=self.client)[0][0]

    def gravity(self, client=None):
        p.setGravity(0, 0, -9.81, physicsClientId=self.client if client is None else client)

    def floats(self, client=None):
        self.gravity(client)
        body = self.box(client=client)
        self.steps(60, client)
        return self.height(body, client) > -0.95


class MotionTest(Case):
    def test_a_box_of_half_density_floats_at_half_its_height(self):
        self.fluid.water(level=0, density=1000)
        self.gravity()
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.4, 0.1], physicsClientId=self.client)
        body = p.createMultiBody(80, shape, basePosition=[0, 0, 0.1], physicsClientId=self.client)
        self.steps(240 * 30)
        heights = []
        for _ in range(240):
            self.steps(1)
            heights.append(self.height(body))
        self.assertAlmostEqual(sum(heights) / len(heights), 0, delta=0.01)

    def test_a_force_moves_a_cube_with_its_added_mass(self):
        self.fluid.region(density=RHO)
        for maximal in (False, True):
            with self.subTest(maximal=maximal):
                body = self.box(0.5, 1000, useMaximalCoordinates=maximal)
                mass = self.fluid.inertia(body)[3, 3]
                self.assertAlmostEqual((mass - 1000) / RHO, CUBE, delta=0.005)
                place = p.getBasePositionAndOrientation(body, physicsClientId=self.client)[0]
                p.applyExternalForce(body, -1, [100, 0, 0], place, p.WORLD_FRAME, physicsClientId=self.client)
                self.steps(1)
                self.assertAlmostEqual(self.speed(body) / (100 / 240 / mass), 1, delta=5e-5)

    def test_wet_volume_and_wrench(self):
        self.fluid.water(level=0, density=1000)
        self.gravity()
        body, deep = self.box(position=(0, 0, 0)), self.box(position=(5, 0, -2))
        self.assertAlmostEqual(self.fluid.wet_volume(body), 0.004, delta=1e-6)
        self.assertAlmostEqual(self.fluid.wet_volume(deep), 0.008, delta=1e-6)
        self.assertAlmostEqual(self.fluid.wet(body)["draught"], 0.1, delta=1e-6)
        self.assertAlmostEqual(self.fluid.wrench(deep)["buoyancy"][5], 1000 * 9.81 * 0.008, delta=0.1)
        self.steps(1)
        wrench = self.fluid.wrench(deep)
        self.assertAlmostEqual(wrench["buoyancy"][5], 1000 * 9.81 * 0.008, delta=0.1)
        momentum = 4 * p.getBaseVelocity(deep, physicsClientId=self.client)[0][2] * 240
        fluid = sum(part for name, part in wrench.items() if name != "constraints")
        self.assertAlmostEqual(fluid[5] + wrench["constraints"][5] - 4 * 9.81, momentum, delta=1e-3)

    def test_a_motor_turns_a_joint_with_the_fluid(self):
        self.fluid.region(density=RHO)
        for motor in ({"controlMode": p.TORQUE_CONTROL}, {"controlMode": p.VELOCITY_CONTROL, "targetVelocity": 1}):
            with self.subTest(**motor):
                arm = self.arm(force=5, **motor)
                dry = p.calculateMassMatrix(arm, [0], physicsClientId=self.client)[0][0]
                wet = self.fluid.mass_matrix(arm)[-1, -1]
                self.assertGreater(wet, 2 * dry)
                self.steps(1)
                rate = p.getJointState(arm, 0, physicsClientId=self.client)[1]
                self.assertAlmostEqual(rate / (5 / 240 / wet), 1, delta=1e-4)
                p.removeBody(arm, physicsClientId=self.client)

    def test_an_impact_has_wet_masses(self):
        self.fluid.settings(law="published", separation=math.pi)
        self.fluid.region(density=1000, viscosity=0)  # ideal: nothing but added mass
        carried = 1000 * 2 / 3 * math.pi * 0.1**3
        dry = (0.2 * carried, 2.6 * carried)
        balls = []
        for mass, x in zip(dry, (-0.15, 0.15)):
            shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1, physicsClientId=self.client)
            balls.append(p.createMultiBody(mass, shape, basePosition=(x, 0, 0), physicsClientId=self.client))
            p.changeDynamics(balls[-1], -1, linearDamping=0, angularDamping=0, restitution=1, lateralFriction=0,
                             physicsClientId=self.client)
        self.steps(1)
        p.resetBaseVelocity(balls[0], [1, 0, 0], physicsClientId=self.client)
        self.steps(30)
        a, b = (mass + carried for mass in dry)
        self.assertAlmostEqual(self.speed(balls[1]), 2 * a / (a + b), delta=0.005)
        self.assertAlmostEqual(self.speed(balls[0]), (a - b) / (a + b), delta=0.005)

    def test_waves_wind_and_currents_move_a_box(self):
        self.fluid.settings(law="form")  # flat sides
        self.gravity()
        for name, water, along in (("current", {"current": (1, 0, 0)}, 0), ("waves", {"waves": [Wave(0.1, 2)]}, None),
                                   ("spectrum", {"spectrum": Spectrum(0.2, 3)}, None)):
            with self.subTest(name):
                self.fluid.water(level=0, **water)
                body = self.box(position=(0, 0, 0))
                self.steps(240)
                if along is not None:
                    self.assertGreater(self.speed(body), 0.3)
                else:
                    self.assertGreater(abs(self.height(body)), 1e-4)
                p.removeBody(body, physicsClientId=self.client)
        self.fluid.remove()
        self.fluid.air(wind=(10, 0, 0))
        body = self.box(mass=0.1)
        self.steps(60)
        self.assertGreater(self.speed(body), 0.1)

    def test_flows_and_layers_reach_bodies(self):
        wind = [bullet_ambient.wind_profile([10, 0, 0], roughness=0, exponent=0, ground=-100)]
        for region in (lambda: self.fluid.air(flow=wind, name="water"), lambda: self.fluid.region("water", density=1.2, flow=wind),
                       lambda: self.fluid.water(level=-50, flow_above=wind)):
            region()
            body = self.box(mass=0.1)
            self.steps(60)
            self.assertGreater(self.speed(body), 0.1)
            p.removeBody(body, physicsClientId=self.client)
            self.fluid.remove()
        self.gravity()
        rises = []
        for density in (1000, 2000):
            self.fluid.region("water", density=1000, layers=bullet_ambient.layers([-50, 50], [density, density]))
            body = self.box(mass=1)
            self.steps(10)
            rises.append(self.height(body) + 1)
            p.removeBody(body, physicsClientId=self.client)
            self.fluid.remove()
        self.assertGreater(rises[1], 1.5 * rises[0])

    def test_a_current_that_is_set_anew_in_each_step_carries_what_is_in_it(self):
        """0.5 sin(2 pi t / 4) m/s: the water moves by 0.6366 m to and fro, and a neutral ball without friction with it."""
        self.fluid.settings(law="published", separation=math.pi)
        shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1, physicsClientId=self.client)
        for maximal in (False, True):
            with self.subTest(maximal=maximal):
                ball = p.createMultiBody(1000 * 4 / 3 * math.pi * 0.1**3, shape, useMaximalCoordinates=maximal, physicsClientId=self.client)
                p.changeDynamics(ball, -1, linearDamping=0, angularDamping=0, physicsClientId=self.client)
                places = []
                for step in range(240 * 4):
                    speed = 0.5 * math.sin(2 * math.pi * step / 240 / 4)
                    self.fluid.region("sea", density=1000, viscosity=0, velocity=(speed, 0, 0))
                    self.steps(1)
                    places.append(p.getBasePositionAndOrientation(ball, physicsClientId=self.client)[0][0])
                self.assertAlmostEqual(max(places) - min(places), 0.5 * 4 / math.pi, delta=0.003)
                p.removeBody(ball, physicsClientId=self.client)

    def hovers(self, **chosen):
        """How far a quadrotor of 27 g comes off its place in a wind of 3 m/s, with the gains of gym-pybullet-drones [m]."""
        shape = p.createCollisionShape(p.GEOM_CYLINDER, radius=0.06, height=0.025, physicsClientId=self.client)
        drone = p.createMultiBody(0.027, shape, physicsClientId=self.client)
        p.changeDynamics(drone, -1, localInertiaDiagonal=[1.4e-5, 1.4e-5, 2.17e-5], physicsClientId=self.client)
        if chosen:
            self.fluid.body(drone, **chosen)
        for _ in range(240 * 5):
            place, turn = p.getBasePositionAndOrientation(drone, physicsClientId=self.client)
            velocity, spin = map(np.array, p.getBaseVelocity(drone, physicsClientId=self.client))
            axes = np.reshape(p.getMatrixFromQuaternion(turn), (3, 3))
            thrust = [0, 0, 0.027 * 9.81] - np.multiply([0.4, 0.4, 1.25], place) - np.multiply([0.2, 0.2, 0.5], velocity)
            torque = 0.0193 * np.cross(axes[:, 2], thrust / np.linalg.norm(thrust)) - 2.75e-3 * spin
            torque = axes @ np.clip(axes.T @ torque, -4.4e-4, 4.4e-4)  # what its rotors have
            force = max(0, axes[:, 2] @ thrust) * axes[:, 2]
            p.applyExternalForce(drone, -1, force, place, p.WORLD_FRAME, physicsClientId=self.client)
            p.applyExternalTorque(drone, -1, torque, p.WORLD_FRAME, physicsClientId=self.client)
            self.steps(1)
        return np.linalg.norm(place)

    def test_a_drone_that_is_mostly_air_holds_its_place_in_a_wind(self):
        self.gravity()
        self.fluid.air(wind=(3, 0, 0))
        self.assertGreater(self.hovers(), 1)  # a solid puck tips over
        side = 0.12 * 0.025 * (0.027 / 600 / (math.pi * 0.06**2 * 0.025)) ** (2 / 3)
        force = 0.5 * 1.2 * 3**2 * side * 1.1
        self.assertAlmostEqual(self.hovers(density=600, drag=(1.1, 1.1, 1.2)), force / 0.4, delta=0.1 * force / 0.4)

    def test_without_fluid_it_is_stock_bit_for_bit(self):
        ends = []
        for kind in ("stock", "loaded", "vacuum"):
            client = p.connect(p.DIRECT)
            if kind != "stock":
                fluid = Fluid(client)
            if kind == "vacuum":
                fluid.region(density=0, viscosity=0)
            self.gravity(client)
            floor = p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client)
            p.createMultiBody(0, floor, physicsClientId=client)
            bodies = [self.box(0.1, 1, (0.05 * i, i % 2, 0.2 + 0.3 * i), client, useMaximalCoordinates=i % 2) for i in range(10)]
            self.steps(300, client)
            ends.append([p.getBasePositionAndOrientation(body, physicsClientId=client) for body in bodies])
            p.disconnect(client)
        self.assertEqual(ends[0], ends[1])
        self.assertEqual(ends[0], ends[2])


class LifeTest(Case):
    """The traps of docs/pybullet.md."""

    def setUp(self):
        super().setUp()
        self.fluid.water(level=0)

    def test_bodies_that_come_later(self):
        for _ in range(3):
            self.assertTrue(self.floats())

    def test_resets_in_all_forms(self):
        for flags in (0, 0, p.RESET_USE_SIMPLE_BROADPHASE, p.RESET_USE_DISCRETE_DYNAMICS_WORLD, 0):
            self.assertTrue(self.floats(), flags)
            p.resetSimulation(flags, physicsClientId=self.client)
            self.steps(2)
        self.assertTrue(self.floats())

    def test_light_bodies_are_told_of_once(self):
        """Lighter than the air that they displace; not again after each reset, nor for each of several that are alike."""
        for _ in range(3):
            p.resetSimulation(physicsClientId=self.client)
            self.gravity()
            for _ in range(4):
                self.box(mass=0.004)
            self.steps(2)
            said = [line for line in self.fluid.status()["said"] if "so that it rises" in line]
            self.assertEqual(len(said), 1)
            self.assertIn("has a mass of 0.004 kg and displaces", said[0])

    def test_a_deformable_world_is_refused_and_left_alone(self):
        p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD, physicsClientId=self.client)
        self.assertFalse(self.floats())
        self.assertIn("btDeformableMultiBodyDynamicsWorld", self.fluid.status()["refused"])
        with self.assertRaisesRegex(ValueError, "Deformable"):
            self.fluid.save()
        p.resetSimulation(physicsClientId=self.client)
        self.assertTrue(self.floats())

    def test_types_of_solver(self):
        kinds = (p.CONSTRAINT_SOLVER_LCP_DANTZIG, p.CONSTRAINT_SOLVER_LCP_PGS, p.CONSTRAINT_SOLVER_LCP_SI,
                 p.CONSTRAINT_SOLVER_LCP_DANTZIG)
        for kind in kinds:
            p.setPhysicsEngineParameter(constraintSolverType=kind, physicsClientId=self.client)
            self.assertTrue(self.floats(), kind)
            p.setPhysicsEngineParameter(constraintSolverType=kind, physicsClientId=self.client)
        p.resetSimulation(physicsClientId=self.client)
        self.assertTrue(self.floats())
        p.setPhysicsEngineParameter(constraintSolverType=p.CONSTRAINT_SOLVER_LCP_PGS, physicsClientId=self.client)
        p.resetSimulation(physicsClientId=self.client)  # no step between
        self.assertTrue(self.floats())

    def test_a_body_at_an_old_address_has_its_own_fluid(self):
        p.setGravity(0, 0, 0, physicsClientId=self.client)
        for i in range(40):
            half = 0.1 + 0.01 * (i % 7)
            body = self.box(half, 1)
            self.assertAlmostEqual((self.fluid.inertia(body)[3, 3] - 1) / RHO / (2 * half) ** 3, CUBE, delta=0.005)
            self.steps(i % 3)
            p.removeBody(body, physicsClientId=self.client)
        self.assertTrue(self.floats())

    def test_several_clients(self):
        other = p.connect(p.DIRECT)
        fluid = Fluid(other)
        self.assertTrue(self.floats())
        self.assertFalse(self.floats(other))
        fluid.water(level=0)
        self.assertTrue(self.floats(other))
        p.disconnect(self.client)
        self.assertTrue(self.floats(other))
        p.disconnect(other)

    def test_disconnecting_in_any_state(self):
        p.disconnect(self.client)
        for kind in ("loaded", "water", "body", "solver", "reset"):
            client = p.connect(p.DIRECT)
            fluid = Fluid(client)
            if kind != "loaded":
                fluid.water(level=0)
            if kind not in ("loaded", "water"):
                self.assertTrue(self.floats(client))
            if kind == "solver":
                p.setPhysicsEngineParameter(constraintSolverType=p.CONSTRAINT_SOLVER_LCP_PGS, physicsClientId=client)
            if kind == "reset":
                p.resetSimulation(physicsClientId=client)
            p.disconnect(client)

    def test_a_second_fluid_of_a_client_is_the_first(self):
        Fluid(self.client).remove()
        self.assertFalse(self.floats())

    def test_off_and_on(self):
        for _ in range(3):
            self.assertTrue(self.floats())
            self.fluid.off()
            self.assertFalse(self.floats())
            p.resetSimulation(physicsClientId=self.client)
            self.fluid.off()
            self.fluid.water(level=0)

    def test_unload(self):
        self.assertTrue(self.floats())
        p.unloadPlugin(self.fluid._plugin, physicsClientId=self.client)
        self.assertFalse(self.floats())

    def test_loading_after_unloading_ends_pybullet_itself(self):
        """PyBullet's own bug, with a plugin of its own: the reason why Fluid has no unload()."""
        script = ("import pybullet as p; p.connect(p.DIRECT); q = 'PLUGIN'; f = p.loadPlugin(q, '_ambient');"
                  "p.unloadPlugin(f); p.loadPlugin(q, '_ambient')").replace("PLUGIN", bullet_ambient.pybullet.plugin_path())
        run = subprocess.run([sys.executable, "-c", script], capture_output=True)
        if run.returncode == 0:
            self.skipTest("this PyBullet has the bug no more")
        self.assertLess(run.returncode, 0)  # a signal

    def test_symbols_stay_inside(self):
        names = subprocess.run(["nm", "-D", "--defined-only", bullet_ambient.pybullet.plugin_path()], capture_output=True,
                               text=True, check=True).stdout.split("\n")
        names = [name.split()[-1] for name in names if name]
        self.assertEqual(len(names), 5, names)
        self.assertTrue(all(name.endswith("_ambient") for name in names), names)

    def test_changed_mass(self):
        body = self.box(0.5, 1000)
        added = self.fluid.inertia(body)[3, 3] - 1000
        p.changeDynamics(body, -1, mass=3000, physicsClientId=self.client)
        place = p.getBasePositionAndOrientation(body, physicsClientId=self.client)[0]
        p.applyExternalForce(body, -1, [100, 0, 0], place, p.WORLD_FRAME, physicsClientId=self.client)
        self.steps(1)
        self.assertAlmostEqual(self.speed(body) / (100 / 240 / (3000 + added)), 1, delta=2e-3)

    def test_exclude(self):
        self.gravity()
        bodies = [self.box() for _ in range(2)]
        self.fluid.exclude(bodies[1])
        self.steps(60)
        self.assertGreater(self.height(bodies[0]), -1)
        self.assertLess(self.height(bodies[1]), -1.25)

    def catamaran(self, folder):
        """Files of two pontoons of 2 x 0.2 x 0.2 m, 0.8 m apart, as a mesh and as a URDF of 20 kg."""
        vertices, faces = [], []
        for y in (-0.4, 0.4):
            first = len(vertices) + 1
            vertices += [(x, y + v, z) for x in (-1, 1) for v in (-0.1, 0.1) for z in (-0.1, 0.1)]
            for a, b, c in ((0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
                            (0, 6, 4), (1, 5, 7), (1, 7, 3)):
                faces.append((first + a, first + b, first + c))
        lines = ["o cat", *("v %g %g %g" % v for v in vertices), *("f %d %d %d" % f for f in faces)]
        (folder / "cat.obj").write_text("\n".join(lines) + "\n")
        (folder / "cat.urdf").write_text(
            '<robot name="cat"><link name="hull"><ambient fluid_body="cat.ambient"/><inertial><origin xyz="0 0 0.05"/>'
            '<mass value="20"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
            '<collision><geometry><mesh filename="cat.obj"/></geometry></collision></link></robot>')
        return {"type": "mesh", "file": str(folder / "cat.obj")}

    def test_a_hull_is_made_once(self):
        """For all clients of a process, which reset their worlds, and by the folder for the next process."""
        with tempfile.TemporaryDirectory() as folder:
            for expected in ({"made": 1, "read": 0}, {"made": 0, "read": 1}):
                run = subprocess.run([sys.executable, "-c", HULLS, folder], capture_output=True, text=True, check=True)
                self.assertEqual(run.stdout.strip().splitlines()[-1], str(expected), run.stderr)

    def test_a_link_gets_the_fluid_body_of_choice(self):
        self.fluid.water(level=0, density=1000)
        self.gravity()
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            mesh = self.catamaran(folder)
            body = p.loadURDF(str(folder / "cat.urdf"), [0, 0, 0.05], physicsClientId=self.client)
            self.steps(1)
            (as_hull,) = self.fluid.status()["bodies"]
            self.assertAlmostEqual(as_hull["volume"], 2 * 1.0 * 0.2, delta=1e-6)
            self.assertTrue(any("convex hull" in said for said in self.fluid.status()["said"]))
            FluidBody.from_shape(mesh, origin=(0, 0, 0), panels=400).write(folder / "cat.ambient")
            self.fluid.read_urdf(body, folder / "cat.urdf")
        (chosen,) = self.fluid.status()["bodies"]
        self.assertAlmostEqual(chosen["volume"], 0.16, delta=1e-6)
        self.assertAlmostEqual(chosen["density"], 125, delta=0.01)
        self.steps(240 * 10)
        self.assertAlmostEqual(self.fluid.wet(body)["draught"], 20 / 0.8 / 1000, delta=5e-4)
        self.fluid.body(body, -1, {"type": "box", "size": [1, 1, 0.1]}, density=400)
        self.assertAlmostEqual(self.fluid.status()["bodies"][0]["volume"], 0.05, delta=1e-6)
        with self.assertRaisesRegex(ValueError, "no such file"):
            self.fluid.body(body, -1, "nothing.ambient")

    def test_a_rudder_in_the_wash_of_a_screw_turns_a_boat(self):
        """That of data/scenes/rudder_and_screw.json, of which docs/wings.md has the numbers."""
        self.fluid.water(level=0)
        self.gravity()
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[2, 0.6, 0.4], physicsClientId=self.client)
        boat = p.createMultiBody(1600, shape, basePosition=[0, 0, 0.066], baseInertialFramePosition=[0, 0, -0.2], physicsClientId=self.client)
        p.changeDynamics(boat, -1, linearDamping=0, angularDamping=0, physicsClientId=self.client)
        scene = json.loads((Path(__file__).parents[3] / "data/scenes/rudder_and_screw.json").read_text())
        without_on = [[{key: value for key, value in entry.items() if key != "on"} for entry in scene[kind]] for kind in ("foils", "thrusters")]
        self.fluid.equip(boat, foils=without_on[0])
        self.fluid.equip(boat, thrusters=without_on[1])
        self.fluid.drive(rudder=0)
        self.fluid.drive(rudder=-0.8)
        self.steps(240 * 6)
        place, turn = p.getBasePositionAndOrientation(boat, physicsClientId=self.client)
        self.assertAlmostEqual(abs(p.getEulerFromQuaternion(turn)[2]), 1.02, delta=0.03)  # the lag of the first substep, few faces
        self.assertGreater(place[0], 0.5)
        drives = self.fluid.drives()
        self.assertAlmostEqual(drives["foils"]["rudder"]["angle"], 0.48, delta=1e-4)
        self.assertAlmostEqual(drives["thrusters"]["screw"]["drive"], 10, delta=1e-4)
        with self.assertRaisesRegex(ValueError, "there is no foil or thruster"):
            self.fluid.drive(sail=1)

    def test_a_thruster_on_a_link_turns_its_joint(self):
        self.fluid.region(density=1000, viscosity=0)
        arm = self.arm(controlMode=p.VELOCITY_CONTROL, force=0)
        self.fluid.equip(arm, 0, thrusters=[{"name": "jet", "position": [0.8, 0, 0], "axis": [0, 1, 0], "curve": [[0, 0], [1, 10]]}])
        for refused, words in (
            (lambda: self.fluid.equip(arm, 5, foils=[{"span": 1, "chord": 0.1}]), f"equip: there is no body {arm} with link 5"),
            (lambda: self.fluid.body(arm, 5, {"type": "sphere", "radius": 1}), f"body: there is no body {arm} with link 5"),
            (lambda: self.fluid.equip(arm, 0, foils=[{"name": "jet", "span": 1, "chord": 0.1}]), "a foil and a thruster are called"),
            (lambda: self.fluid.equip(arm, 0, thrusters=[{"curve": [[0, 0], [1, 1]], "propeller": {"diameter": 0.1, "washes_bodies": True}}]), "is for scenes"),
        ):
            with self.assertRaisesRegex(ValueError, words):
                refused()
        inertia = self.fluid.mass_matrix(arm)[-1, -1]
        self.fluid.drive(jet=1)
        self.steps(1)
        self.assertAlmostEqual(p.getJointState(arm, 0, physicsClientId=self.client)[1] / (10 * 0.8 / inertia / 240), 1, delta=1e-3)

    def test_elements_of_links_say_how_rough_they_are(self):
        self.fluid.water(level=0, density=1000)
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=self.client)
        body = p.createMultiBody(4, box, physicsClientId=self.client)
        base = p.getBodyInfo(body, physicsClientId=self.client)[0].decode()
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "box.urdf"
            for inside, error in (('roughness="0.01"/>', None), ('roughness="9"/>', "roughness .m. is 9, must be from 0 to 0.489"),
                                  ("><roughness/></ambient>", "<ambient> has <roughness>; known are: fluid_body, law, medium, roughness"),
                                  ('rough="1"/>', "<ambient> has rough; known are")):
                file.write_text(f'<robot name="r"><link name="{base}"><ambient {inside}</link></robot>')
                if error is None:
                    self.fluid.read_urdf(body, file)
                    continue
                with self.assertRaisesRegex(ValueError, error):
                    self.fluid.read_urdf(body, file)
        self.assertEqual(len(self.fluid.status()["bodies"]), 1)

    def test_a_hull_without_mass_floats_the_link_that_has_it(self):
        self.fluid.water(level=0, density=1000)
        self.gravity()
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.4, 0.2], physicsClientId=self.client)
        boat = p.createMultiBody(
            80, -1, basePosition=[0, 0, 0], linkMasses=[0], linkCollisionShapeIndices=[box], linkVisualShapeIndices=[-1],
            linkPositions=[[0, 0, 0.1]], linkOrientations=[[0, 0, 0, 1]], linkInertialFramePositions=[[0, 0, 0]],
            linkInertialFrameOrientations=[[0, 0, 0, 1]], linkParentIndices=[0], linkJointTypes=[p.JOINT_FIXED],
            linkJointAxis=[[0, 0, 1]], physicsClientId=self.client)
        p.changeDynamics(boat, -1, localInertiaDiagonal=[8, 8, 8], physicsClientId=self.client)
        self.steps(240 * 20)
        self.assertAlmostEqual(self.height(boat), 0, delta=0.01)  # 0.1 m under water of 0.4 m
        self.assertEqual([body["link"] for body in self.fluid.status()["bodies"]], [-1])

    def test_save_and_restore(self):
        self.gravity()
        bodies = [self.box(0.1, 4, (0.05 * i, 0, -0.1 + 0.25 * i)) for i in range(3)]
        self.steps(100)
        state = self.fluid.save()
        ends = []
        for _ in range(2):
            self.steps(100)
            ends.append([p.getBasePositionAndOrientation(body, physicsClientId=self.client) for body in bodies])
            self.fluid.restore(state)
        self.assertEqual(ends[0], ends[1])

    def test_a_state_that_is_not_restored_bit_for_bit_is_told(self):
        self.fluid.remove()
        self.fluid.air()
        self.gravity()
        p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, physicsClientId=self.client), physicsClientId=self.client)
        self.box(position=(0, 0, 0.1))
        self.steps(10)
        for sorts in (1, 0, 0):
            p.setPhysicsEngineParameter(deterministicOverlappingPairs=sorts, physicsClientId=self.client)
            self.fluid.save()
            said = [line for line in self.fluid.status()["said"] if "deterministicOverlappingPairs=1" in line]
            self.assertEqual(len(said), 1 - sorts, said)

    def test_a_state_with_contacts_of_several_shapes_is_told(self):
        self.fluid.remove()
        self.fluid.air()
        self.gravity()
        p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, physicsClientId=self.client), physicsClientId=self.client)
        p.setPhysicsEngineParameter(deterministicOverlappingPairs=1, physicsClientId=self.client)
        for boxes in (1, 2):
            shape = p.createCollisionShapeArray(
                [p.GEOM_BOX] * boxes, halfExtents=[[0.1] * 3] * boxes,
                collisionFramePositions=[[0.2 * i, 0, 0] for i in range(boxes)], physicsClientId=self.client)
            p.createMultiBody(1, shape, basePosition=(boxes, 0, 0.1), physicsClientId=self.client)
            self.steps(10)
            self.fluid.save()
            said = [line for line in self.fluid.status()["said"] if "several collision shapes" in line]
            self.assertEqual(len(said), boxes - 1, said)

    def test_a_tray_floats_by_each_way_in_until_it_is_awash(self):
        boxes = list(zip(TRAY_HALVES, TRAY_PLACES))
        text = [{"place": " ".join(map(str, place)), "half": " ".join(map(str, half)), "size": " ".join(str(2 * x) for x in half)} for half, place in boxes]
        urdf = "".join('<collision><origin xyz="{place}"/><geometry><box size="{size}"/></geometry></collision>'.format(**box) for box in text)
        mjcf = "".join('<geom type="box" size="{half}" pos="{place}"/>'.format(**box) for box in text)
        inertia = '<inertia ixx="4" iyy="8" izz="10" ixy="0" ixz="0" iyz="0"/>'
        files = {
            "tray.urdf": f'<robot name="tray"><link name="tray"><inertial><origin xyz="0 0 0.1"/><mass value="60"/>{inertia}</inertial>{urdf}</link></robot>',
            "tray.xml": f'<mujoco><worldbody><body pos="0 0 0.1"><inertial pos="0 0 0.1" mass="60" diaginertia="4 8 10"/>{mjcf}</body></worldbody></mujoco>',
        }
        with tempfile.TemporaryDirectory() as folder:
            for name, content in files.items():
                (Path(folder) / name).write_text(content)
            for name in (*files, ""):
                p.resetSimulation(physicsClientId=self.client)
                self.gravity()
                fluid = Fluid(self.client)
                fluid.water(level=0)
                if name.endswith("urdf"):
                    tray = p.loadURDF(f"{folder}/{name}", [0, 0, 0.1], physicsClientId=self.client)
                elif name:
                    (tray,) = p.loadMJCF(f"{folder}/{name}", physicsClientId=self.client)
                else:
                    shape = p.createCollisionShapeArray([p.GEOM_BOX] * 5, halfExtents=TRAY_HALVES, collisionFramePositions=TRAY_PLACES, physicsClientId=self.client)
                    tray = p.createMultiBody(60, shape, basePosition=[0, 0, 0.1], baseInertialFramePosition=[0, 0, 0.1], physicsClientId=self.client)
                p.changeDynamics(tray, -1, linearDamping=0, angularDamping=0, physicsClientId=self.client)
                self.steps(240 * 10)
                draught = 60 / RHO / 0.6
                height = p.getBasePositionAndOrientation(tray, physicsClientId=self.client)[0][2]
                self.assertAlmostEqual(0.1 - height, draught, delta=0.005 * draught, msg=name)
                # Held under and let go, it fills and sinks.
                for _ in range(240 * 3):
                    p.resetBasePositionAndOrientation(tray, [0, 0, -0.5], [0, 0, 0, 1], physicsClientId=self.client)
                    self.steps(1)
                self.steps(240 * 3)
                self.assertLess(p.getBasePositionAndOrientation(tray, physicsClientId=self.client)[0][2], -1, name)

    def test_what_is_said_of_shapes_comes_to_each_client_that_has_them(self):
        """The hold of a tray of five boxes."""
        for client in (self.client, self.client, p.connect(p.DIRECT)):
            p.resetSimulation(physicsClientId=client)
            fluid = Fluid(client)
            fluid.water(level=0)
            shape = p.createCollisionShapeArray([p.GEOM_BOX] * 5, halfExtents=TRAY_HALVES, collisionFramePositions=TRAY_PLACES,
                                                physicsClientId=client)
            p.createMultiBody(60, shape, physicsClientId=client)
            p.stepSimulation(physicsClientId=client)
            status = fluid.status()
            (own,) = status["bodies"][0]["said"]
            self.assertRegex(own, r"hold of 0\.204\d* m\^3")
            self.assertEqual([line for line in status["said"] if "hold" in line], ["bullet_ambient: " + own])
        p.disconnect(client)

    def test_long_commands(self):
        self.fluid.water(level=0, waves=[Wave(1e-4, 2 + 0.01 * i, phase=1e5) for i in range(200)])
        self.assertTrue(self.floats())

    def test_names_may_have_spaces_and_pools_open_sides(self):
        self.fluid.off()
        self.fluid.water(level=0, bounds=(-math.inf, -math.inf, -math.inf, 1e3, 1e3, math.inf), name="a pool")
        self.assertEqual(self.fluid.status()["regions"], ["a pool"])
        self.assertTrue(self.floats())
        self.fluid.remove("a pool")
        self.assertFalse(self.floats())

    def test_bad_values(self):
        for call in (lambda: self.fluid.water(density=-1), lambda: self.fluid.water(level=math.nan),
                     lambda: self.fluid.inertia(77), lambda: self.fluid.settings(law="any"), lambda: self.fluid.restore(0),
                     lambda: self.fluid.remove("pool"), lambda: self.fluid.water(waves=[Wave(-1, 2)]),
                     lambda: self.fluid.water(spectrum=Spectrum(1, 5, components=1.5)), lambda: self.fluid.air(bounds=[0, 1])):
            with self.assertRaises(ValueError) as caught:
                call()
            self.assertNotIn("\n", str(caught.exception))

    def test_reports_name_body_and_link(self):
        corner = p.createCollisionShape(p.GEOM_MESH, vertices=[[0, 0, 0], [1, 0, 0], [0, 1, 0]], indices=[0, 1, 2],
                                        physicsClientId=self.client)
        body = p.createMultiBody(1, corner, physicsClientId=self.client)
        self.steps(1)
        self.assertTrue(any(f"body 'PyBullet {body}" in said for said in self.fluid.status()["said"]), self.fluid.status())


if __name__ == "__main__":
    unittest.main()
