#!/usr/bin/python3
"""Worlds at once from Python, and VectorEnv against Gymnasium's rules, by a plain loop over single worlds."""

import subprocess
import sys
import threading
import unittest
from pathlib import Path

import numpy as np

import bullet_ambient as ba

sys.path.append(str(Path(__file__).resolve().parents[3] / "demos/python/examples"))
import glide_to_target  # noqa: E402
import keep_heading  # noqa: E402
import station_keeping  # noqa: E402
from cma import Cma  # noqa: E402

SCENE = {
    "duration": 1, "time_step": 0.01, "medium": {"density": 1000, "viscosity": 1e-3},
    "bodies": [{"name": "hull", "mass": 31, "shape": {"type": "box", "size": [0.5, 0.3, 0.2]}, "position": [0, 0, 1]}],
    "thrusters": [{"on": "hull", "position": [-0.2, y, 0], "curve": [[-1, -30], [1, 40]], "lag": 0.1} for y in (0.1, -0.1)],
}
MORE = {"substeps": 2, "most_steps": 7, "actions": ["thrusters"], "observations": ["position", "twist"],
        "vary": {"mass": (0.8, 1.2), "position": (-1, 1)}}
WORLDS = 5


class Drift(ba.VectorEnv):
    """Ends above a height, which some worlds reach."""

    def reward(self, batch):
        return batch["position"][:, 0]

    def ended(self, batch):
        return batch["position"][:, 0] > 0.9

    def info(self, batch):
        return {"speed": batch["twist"][:, 3]}


class Loop:
    """Single worlds, one after another, by the rules of gymnasium.vector.SyncVectorEnv."""

    def __init__(self, mode):
        self.mode, self.done = mode, np.zeros(WORLDS, bool)

    def reset(self, seed):
        self.worlds = [ba.WorldBatch(SCENE, 1, seed=seed + i, threads=1, **MORE) for i in range(WORLDS)]
        return np.array([world.observations[0] for world in self.worlds], np.float32)

    def step(self, actions):
        observations, rewards, ends, cuts, finals = [], [], [], [], [None] * WORLDS
        for i, world in enumerate(self.worlds):
            reward, ended, cut = 0.0, False, False
            if self.mode == "next_step" and self.done[i]:
                world.reset()
            else:
                world.actions[:] = actions[i]
                world.step()
                reward, ended, cut = world["position"][0, 0], world["position"][0, 0] > 0.9, bool(world.truncated[0])
            self.done[i] = ended or cut
            if self.mode == "same_step" and self.done[i]:
                finals[i] = world.observations[0].astype(np.float32)
                world.reset()
            if self.mode == "disabled" and self.done[i]:
                observations.append(world.observations[0].astype(np.float32))
                world.reset()  # reset() comes before the next step
            else:
                observations.append(world.observations[0].astype(np.float32))
            rewards.append(reward), ends.append(ended), cuts.append(cut)
        return np.array(observations), np.array(rewards), np.array(ends), np.array(cuts), finals


class VectorEnvTest(unittest.TestCase):
    def compare(self, mode):
        env, loop = Drift(SCENE, WORLDS, autoreset=mode, **MORE), Loop(mode)
        observations, infos = env.reset(seed=3)
        np.testing.assert_array_equal(observations, loop.reset(3))
        random, ends = np.random.default_rng(2), 0
        for _ in range(60):
            actions = random.uniform(-1, 1, (WORLDS, 2))
            observations, rewards, terminated, truncated, infos = env.step(actions)
            expected, pay, ended, cut, finals = loop.step(actions)
            np.testing.assert_array_equal(observations, expected)
            np.testing.assert_array_equal(rewards, pay)
            np.testing.assert_array_equal(terminated, ended)
            np.testing.assert_array_equal(truncated, cut)
            done = ended | cut
            ends += done.sum()
            self.assertEqual(infos["speed"].shape, (WORLDS,))
            if mode == "same_step" and done.any():
                np.testing.assert_array_equal(infos["_final_obs"], done)
                for i in np.flatnonzero(done):
                    np.testing.assert_array_equal(infos["final_obs"][i], finals[i])
                    self.assertEqual(np.float32(infos["final_info"]["speed"][i]), finals[i][6])
            else:
                self.assertNotIn("final_obs", infos)
            if mode == "disabled" and done.any():
                with self.assertRaisesRegex(ValueError, "has ended"):
                    env.step(actions)
                env.reset(options={"reset_mask": done})
        self.assertGreater(ends, 20)

    def test_next_step(self):
        self.compare("next_step")

    def test_same_step(self):
        self.compare("same_step")

    def test_disabled(self):
        self.compare("disabled")

    def test_spaces_and_refusals(self):
        env = Drift(SCENE, WORLDS, **MORE)
        self.assertEqual(env.single_action_space.shape, (2,))
        self.assertEqual(env.observation_space.shape, (WORLDS, 9))
        self.assertTrue(env.single_action_space.contains(np.float32([1, -1])))
        self.assertFalse(env.single_action_space.contains(np.float32([1, -1.1])))
        self.assertEqual(env.action_space.sample().shape, (WORLDS, 2))
        with self.assertRaisesRegex(ValueError, r"shape \(5, 3\); must be \(5, 2\)"):
            env.step(np.zeros((5, 3)))
        for mask in (np.zeros(WORLDS, bool), np.ones(WORLDS), [True] * WORLDS, np.ones(3, bool)):
            with self.assertRaisesRegex(ValueError, "reset_mask"):
                env.reset(options={"reset_mask": mask})
        batch = ba.WorldBatch(SCENE, 3, **MORE)
        self.assertEqual(Drift(batch).num_envs, 3)
        for wrong in ({"worlds": 4}, {"substeps": 5}):
            with self.assertRaisesRegex(ValueError, f"a WorldBatch has .*{next(iter(wrong))}"):
                Drift(batch, **wrong)
        with self.assertRaisesRegex(ValueError, "autoreset"):
            Drift(SCENE, WORLDS, autoreset="never", **MORE)
        with self.assertRaisesRegex(ValueError, "waves"):
            Drift(SCENE, WORLDS, render_mode="lines", drawing=["waves"], **MORE)

    def test_a_task_says_one_number_of_each_world(self):
        for name in ("reward", "ended"):
            env = Drift(SCENE, WORLDS, **MORE)
            env.reset(seed=1)
            setattr(env, name, lambda batch: np.zeros((WORLDS, 2)))
            with self.assertRaisesRegex(ValueError, rf"^{name}\(batch\) has shape \(5, 2\); must be \(5,\)$"):
                env.step(np.zeros((WORLDS, 2)))

    def test_commands_of_foils_are_bounded(self):
        env = Drift("rudder_and_screw", 1, actions=["foils", "wrench"], observations=["position", "twist"])
        space = env.single_action_space
        self.assertEqual((space.low[0], space.high[0], space.high[1]), (-1, 1, np.inf))
        self.assertIn("(7,)", repr(space))

    def test_pictures(self):
        env = Drift(SCENE, 2, render_mode="rgb_array", drawing=["buoyancy"], **MORE)
        self.assertEqual(env.metadata["render_modes"], ["rgb_array", "lines"])
        env.reset(seed=1)
        env.step(np.ones((2, 2)))
        first, second = env.render()
        self.assertEqual((first.shape, first.dtype), ((360, 480, 3), np.uint8))
        self.assertTrue(100 < (first < 255).any(2).sum() < 20000)
        self.assertTrue((first != second).any())  # at other places
        for _ in range(5):
            env.step(np.ones((2, 2)))
        self.assertTrue((env.render()[0] != first).any())  # the camera stays
        env.render_mode = "lines"
        np.testing.assert_array_equal(env.render()[1][0], env.batch.lines(1, ["buoyancy"])[0])
        self.assertIsNone(Drift(SCENE, 1, **MORE).render())
        with self.assertRaisesRegex(ValueError, "render_mode is 'human'"):
            Drift(SCENE, 1, render_mode="human", **MORE)

    # Gymnasium itself is not needed: a double of the parts that the package asks for.
    def test_gymnasium_finds_the_station(self):
        program = """
import sys, types, importlib
import numpy as np

known = {}
gymnasium, vector, spaces = (types.ModuleType(name) for name in ("gymnasium", "gymnasium.vector", "gymnasium.spaces"))
class Box:
    def __init__(self, low, high, shape=None, dtype=np.float32):
        self.shape = np.shape(low) if shape is None else shape
vector.VectorEnv, vector.AutoresetMode, spaces.Box = type("VectorEnv", (), {}), (lambda word: "mode " + word), Box
gymnasium.register = lambda id, entry_point=None, vector_entry_point=None: known.__setitem__(id, vector_entry_point)
def make_vec(id, num_envs=1, **settings):
    module, _, name = known[id].partition(":")
    return getattr(importlib.import_module(module), name)(num_envs=num_envs, **settings)
sys.modules.update({"gymnasium": gymnasium, "gymnasium.vector": vector, "gymnasium.spaces": spaces})
import bullet_ambient
env = make_vec("bullet_ambient/Station-v0", num_envs=3, most_steps=5, seed=4)
assert isinstance(env, vector.VectorEnv) and isinstance(env.single_action_space, Box)
assert env.metadata["autoreset_mode"] == "mode NextStep"
observations, infos = env.reset(seed=1)
assert observations.shape == (3, 12), observations.shape
for n in range(5):
    observations, rewards, terminated, truncated, infos = env.step(np.zeros((3, 6)))
assert truncated.all() and (rewards < 1).all()
assert env.step(np.zeros((3, 6)))[1].tolist() == [0, 0, 0]
"""
        ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stderr)

    def test_a_world_that_fails_is_terminated(self):
        env = Drift(SCENE, 3, actions=["wrench_world"], observations=["position", "twist"])
        env.reset(seed=1)
        actions = np.zeros((3, 6))
        actions[1, 3] = np.nan
        observations, rewards, terminated, _, infos = env.step(actions)
        self.assertEqual(terminated.tolist(), [False, True, False])
        self.assertEqual(infos["failed"].tolist(), [False, True, False])
        self.assertIn("is not finite", infos["fault"][1])
        self.assertEqual(infos["fault"][0], "")
        self.assertEqual((rewards[1], *observations[1]), (0,) * 10)
        self.assertFalse(env.step(0 * np.nan_to_num(actions))[2].any())
        self.assertFalse(env.batch.failed.any())


class WorldBatchTest(unittest.TestCase):
    def test_memory_is_the_worlds_own(self):
        batch = ba.WorldBatch(SCENE, 2, **MORE)
        actions, seen = batch.action("thrusters"), batch["position"]
        actions[0] = 1
        before = seen.copy()
        for _ in range(5):
            batch.step()
        self.assertGreater(seen[0, 0], before[0, 0])
        self.assertTrue(np.shares_memory(seen, batch.observations))
        with self.assertRaises(ValueError):
            batch.failed[0] = True
        del batch
        self.assertTrue(np.isfinite(seen).all())  # the view keeps the worlds alive

    def test_parameters_can_be_written(self):
        batch = ba.WorldBatch(SCENE, 2, **MORE)
        batch.parameter("position")[:] = [[1, 2, 3], [4, 5, 6]]
        batch.reset(draws=False)
        np.testing.assert_array_equal(batch["position"], [[1, 2, 4], [4, 5, 7]])

    def test_run_and_states(self):
        batch, other = (ba.WorldBatch(SCENE, 2, **MORE) for _ in range(2))
        actions = np.random.default_rng(1).uniform(-1, 1, (2, 6, 2))
        out = batch.run(actions)
        self.assertEqual(out.shape, (2, 6, 9))
        for t in range(6):
            other.actions[:] = actions[:, t]
            other.step()
            np.testing.assert_array_equal(other.observations, out[:, t])
        state = batch.state(1)
        batch.step()
        expected = batch.observations[1].copy()
        batch.restore(1, state)
        batch.step()
        np.testing.assert_array_equal(batch.observations[1], expected)

    def test_a_world_of_its_own(self):
        vary = {"mass": (0.8, 1.2), "centre_of_mass": (-0.02, 0.02), "thrust": (0.5, 2), "lag": (0.5, 2), "current": (-0.3, 0.3)}
        batch = ba.WorldBatch(SCENE, 2, actions=["thrusters"], observations=["position", "twist_world"], vary=vary)
        batch.actions[:] = [[1, -0.5], [0.5, 1]]
        for _ in range(10):
            batch.step()
        with batch.world(1) as world:
            np.testing.assert_array_equal(world.commands, [0.5, 1])
            world.step(20)
            for _ in range(20):
                batch.step()
            np.testing.assert_array_equal(world.position[0], batch["position"][1])
            np.testing.assert_array_equal(world.twist[0], batch["twist_world"][1])
            points, colours = world.lines()
            np.testing.assert_array_equal(points, batch.lines(1)[0])
            self.assertEqual((points.shape[1:], colours.shape[1:], len(points)), ((2, 3), (3,), len(colours)))
            more, paint = world.lines(["buoyancy", "total_wrench"])
            self.assertGreater(len(more), len(points))
            self.assertIn([0, 1, 1], paint.tolist())
            self.assertEqual(len(world.lines()[0]), len(points))
        with self.assertRaisesRegex(ValueError, "drawing has \"smoke\""):
            batch.lines(0, ["smoke"])
        with self.assertRaisesRegex(IndexError, "no world 2"):
            batch.world(2)
        batch.actions[0] = np.nan
        batch.step()
        with self.assertRaisesRegex(ValueError, "world 0 has failed: the action thrusters"):
            batch.world(0)

    def test_seeds_of_numpy(self):
        batch, other = ba.WorldBatch(SCENE, 2, **MORE), ba.WorldBatch(SCENE, 2, seed=np.int64(3), **MORE)
        for seed in (3, np.int64(3), np.array([3, 4])):
            batch.reset(seed=seed)
            np.testing.assert_array_equal(batch.parameters, other.parameters)
            batch.reset()

    def test_refusals(self):
        batch = ba.WorldBatch(SCENE, 2, **MORE)
        for call, error, words in (
            (lambda: batch.step(np.ones(3, bool)), ValueError, r"reset has shape \(3,\); must be \(2,\)"),
            (lambda: batch.reset(seed=[1]), ValueError, "1 seeds; must be one for each world, 2"),
            (lambda: batch.reset(seed=-1), ValueError, r"^seed is -1; must be from 0 to 2\^64 - 1$"),
            (lambda: batch.reset(seed=[1, -2]), ValueError, r"^seed is -2; must be"),
            (lambda: ba.WorldBatch(SCENE, seed=-1), ValueError, r"^seed is -1; must be"),
            (lambda: batch.run(np.zeros((2, 3, 1))), ValueError, r"must be \(2, steps, 2\)"),
            (lambda: batch.state(2), IndexError, "no world 2; there are 0 to 1"),
            (lambda: batch.restore(0, b""), ValueError, "is not one of a world of this batch"),
            (lambda: ba.WorldBatch(SCENE, 0), ValueError, "worlds: is 0; must be >= 1"),
            (lambda: ba.WorldBatch(SCENE, vary={"mass": 3}), ValueError, r"^vary\['mass'\] is 3; must be \(lowest, highest\)"),
            (lambda: ba.WorldBatch(SCENE, 1.5), TypeError, "^worlds is 1.5; must be a whole number of at most 2147483647$"),
            (lambda: ba.WorldBatch(SCENE, substeps=10**12), TypeError, "^substeps is 1000000000000; must be a whole number"),
            (lambda: ba.WorldBatch(SCENE, threads=-4), ValueError, "^threads: is -4; must be >= 0"),
            (lambda: ba.WorldBatch(SCENE, actions=[3]), TypeError, r"^actions\[0\] is 3; must be a word or what act\(\) returns"),
            (lambda: ba.WorldBatch(SCENE, vary=[1]), TypeError, r"^vary is \[1\]; must be a dict"),
            (lambda: ba.WorldBatch(SCENE, 2).reset(np.zeros(2)), TypeError, "^mask has numbers of the type float64; must be bool"),
            (lambda: ba.WorldBatch(SCENE, gust=0.3), TypeError, r"^gust is 0.3; must be a Gust"),
            (lambda: batch["target"], KeyError, "target is not observed here; there are"),
            (lambda: ba.WorldBatch(SCENE, observations=["smell"]), ValueError, "must be one of position"),
        ):
            with self.assertRaisesRegex(error, words):
                call()

    def test_a_second_thread_is_refused(self):
        batch = ba.WorldBatch(SCENE, 64, actions=["thrusters"], threads=1)
        running = threading.Thread(target=batch.run, args=(np.zeros((64, 400, 2)),))
        running.start()
        refused = 0
        while running.is_alive() and not refused:
            try:
                batch.observations
            except RuntimeError as error:
                self.assertIn("in use by another thread", str(error))
                refused += 1
        running.join()
        self.assertTrue(refused)

    def test_turns_and_angles_are_those_of_a_world(self):
        scene = ba.Scene("rudder_and_screw", {"foils.0.command": 0.5})
        batch = ba.WorldBatch(scene, 2, substeps=3, observations=["turns", "foil_angle"])
        batch.step()
        with ba.World(scene) as world:
            world.step(3)
            for i in range(2):
                self.assertEqual(batch["turns"][i].tolist(), world.turns.tolist())
                self.assertEqual(batch["foil_angle"][i].tolist(), world.foil_angles.tolist())

    def test_thrusters_of_a_world(self):
        with ba.World(ba.Scene(SCENE)) as world:
            self.assertEqual(world.thrusters, ["thruster_0", "thruster_1"])
            world.commands = [1, 0]
            world.step(3)
            self.assertAlmostEqual(world.thrusts[0], 40 * (1 - (0.1 / 0.11) ** 3), places=12)
            self.assertEqual(world.commands.tolist(), [1, 0])
            with self.assertRaisesRegex(ValueError, r"shape \(3,\); must be one for each of 2"):
                world.commands = [1, 0, 0]
            with self.assertRaisesRegex(ValueError, "\"thruster_1\" is not finite"):
                world.commands = [0, np.nan]

    def test_screw_and_rudder_of_a_world(self):
        with ba.World(ba.Scene("rudder_and_screw")) as world:
            self.assertEqual((world.thrusters, world.foils), (["screw"], ["rudder"]))
            self.assertEqual((world.commands.tolist(), world.foil_commands.tolist()), ([1], [-0.8]))
            world.foil_commands = [1]
            world.step(240)
            self.assertAlmostEqual(world.turns[0], 10, places=4)
            self.assertAlmostEqual(world.foil_angles[0], -0.6, places=3)
            self.assertGreater(world.powers[0], world.thrusts[0] * world.twist[0, 3])
            self.assertGreater(world.twist[0, 2], 0.1)  # to its left
            with self.assertRaisesRegex(ValueError, r"shape \(2,\); must be one for each of 1 foils"):
                world.foil_commands = [1, 0]
            with self.assertRaisesRegex(ValueError, "\"rudder\" is not finite"):
                world.foil_commands = [np.nan]


class LearningTest(unittest.TestCase):
    def test_the_strategy_finds_a_minimum(self):
        search = Cma(np.ones(6), 0.5, 12)
        for _ in range(250):
            tried = search.ask()
            search.tell(((tried - np.arange(6)) ** 2 * 10.0 ** np.arange(6)).sum(1))
        np.testing.assert_allclose(search.mean, np.arange(6), atol=1e-5)

    def test_the_vehicle_begins_to_hold_its_place(self):
        _, costs = station_keeping.learn(8, population=16, each=2, say=lambda *_: None)
        self.assertLess(np.mean(costs[-3:]), 0.8 * np.mean(costs[:2]))

    def test_the_sheet_begins_to_land_near_its_target(self):
        _, misses = glide_to_target.learn(7, population=12, each=3, say=lambda *_: None)
        self.assertGreater(misses[0], 2)
        self.assertLess(np.mean(misses[-2:]), 1.8)

    def test_the_boat_begins_to_keep_its_heading(self):
        _, rewards = keep_heading.learn(5, say=lambda *_: None)
        self.assertLess(rewards[0], -0.7)
        self.assertGreater(np.mean(rewards[-2:]), -0.1)


if __name__ == "__main__":
    unittest.main()
