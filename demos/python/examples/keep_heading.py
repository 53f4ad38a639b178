#!/usr/bin/python3
"""A boat with two propellers learns to keep its heading in waves from abeam: docs/worlds.md."""

import argparse

import numpy as np
from cma import Cma

import bullet_ambient as ba

STEPS = 200  # env steps of 0.1 s
HULL = ba.Scene("boat_in_waves").document["bodies"][0]["shape"]
SCENE = ba.Scene({
    "duration": 20, "time_step": 1 / 60,
    "water": {"level": 0, "spectrum": {"significant_height": 0.3, "peak_period": 2.5, "direction": [0, 1, 0]}},
    "bodies": [{"name": "boat", "shape": HULL, "mass": 70, "centre_of_mass": [0, 0, -0.02], "position": [0, 0, 0.02]}],
    "thrusters": [{"on": "boat", "name": name, "position": [-0.8, y, -0.1], "curve": [[-1, -30], [1, 30]], "lag": 0.2, "radius": 0.06}
                  for name, y in (("port", 0.2), ("starboard", -0.2))],
}, folder=ba.Scene("boat_in_waves").file.rpartition("/")[0])


class KeepHeading(ba.VectorEnv):
    """Along the x axis, and on."""

    def __init__(self, worlds, seed, cache=None):
        observations = ["heading", ba.observe("twist", noise=0.01), "up"]
        super().__init__(SCENE, worlds, substeps=6, most_steps=STEPS, seed=seed, autoreset="disabled", cache=cache,
                         actions=["thrusters"], observations=observations,
                         vary={"heading": (-0.7, 0.7), "mass": (0.9, 1.1), "loads": (0.7, 1.4)})

    def reward(self, batch):
        return batch["heading"][:, 0] + 0.2 * batch["twist"][:, 3] - 0.1 * (batch.actions**2).mean(1)

    def ended(self, batch):
        return batch["up"][:, 2] < 0


def play(env, weights):
    """Sails one episode from the last reset. `weights`: (N, 4, 2). Returns sums of rewards, and headings (T, N) [rad]."""
    seen, headings, rewards = np.asarray(env.batch.observations), [], 0
    for _ in range(STEPS):
        features = np.stack([seen[:, 1], seen[:, 4], seen[:, 6], np.ones(len(seen))], axis=1)  # sine, rate of turn, leeway
        seen, reward, *_ = env.step(np.tanh(np.einsum("nf,nfa->na", features, weights)))
        headings.append(np.arctan2(seen[:, 1], seen[:, 0]))
        rewards = rewards + reward
    return rewards, np.array(headings)
