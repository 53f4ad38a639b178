#!/usr/bin/python3
"""A boat with two propellers learns to keep its heading in waves from abeam: docs/worlds.md."""

import argparse
from pathlib import Path

import numpy as np
from cma import Cma

import bullet_ambient as ba

STEPS, EACH, POPULATION = 200, 4, 8  # env steps of 0.1 s; worlds that try one set of weights; sets of weights
BOAT = ba.Scene("boat_in_waves")
SCENE = ba.Scene({
    "duration": 20, "time_step": 1 / 60,
    "water": {"level": 0, "spectrum": {"significant_height": 0.25, "peak_period": 2.5, "direction": [0, 1, 0]}},
    "bodies": [BOAT.document["bodies"][0]],
    "thrusters": [{"on": "boat", "name": name, "position": [-0.9, y, -0.15], "curve": [[-1, -25], [1, 25]], "lag": 0.2, "radius": 0.06}
                  for name, y in (("port", 0.25), ("starboard", -0.25))],
}, folder=Path(BOAT.file).parent)


class KeepHeading(ba.VectorEnv):
    """Along the x axis, and on. `batch["heading"]` has cosine and sine; of the twist 2 is the rate of turn, 3 the speed, 4 the leeway."""

    def reward(self, batch):
        cosine, sine = batch["heading"].T
        return 0.2 * batch["twist"][:, 3] - np.abs(np.arctan2(sine, cosine)) - 0.1 * (batch.actions**2).mean(1)


def make(worlds, seed, cache=None):
    # Places far from each other have other waves.
    vary = {"heading": (-0.7, 0.7), "position": ((-50, -50, 0), (50, 50, 0)), "mass": (0.9, 1.1), "loads": (0.7, 1.4)}
    return KeepHeading(SCENE, worlds, substeps=6, most_steps=STEPS, seed=seed, vary=vary, cache=cache, autoreset="disabled",
                       actions=["thrusters"], observations=["heading", ba.observe("twist", noise=0.01)])


def play(env, weights, seeds):
    """Sails one episode. `weights`: (N, 4), of sine, rate of turn and leeway for the helm, and the throttle. Returns sums of rewards (N,),
    and headings (T, N) [rad]."""
    seen, _ = env.reset(seed=seeds)
    headings, rewards = [], 0
    for _ in range(STEPS):
        helm, throttle = (seen[:, [1, 4, 6]] * weights[:, :3]).sum(1), weights[:, 3]
        seen, reward, *_ = env.step(np.tanh(np.stack([throttle + helm, throttle - helm], axis=1)))
        headings.append(np.arctan2(seen[:, 1], seen[:, 0]))
        rewards = rewards + reward
    return rewards, np.array(headings)


def learn(generations, cache=None, say=print):
    """Returns the weights (4,) and the median rewards of an env step over the generations, by CMA-ES."""
    env, search, found = make(POPULATION * EACH, 0, cache), Cma(np.zeros(4), 0.5, POPULATION), []
    for generation in range(generations):
        seeds = [1000 * generation + i % EACH for i in range(POPULATION * EACH)]
        rewards, _ = play(env, np.repeat(search.ask(), EACH, axis=0), seeds)
        search.tell(-rewards.reshape(POPULATION, EACH).mean(1))
        found.append(float(np.median(rewards)) / STEPS)
        if generation % 5 == 0:
            say(f"generation {generation}: {found[-1]:.2f} an env step")
    return search.mean, found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--generations", type=int, default=20, help="default: %(default)s")
    parser.add_argument("--cache", metavar="DIR", help="folder that keeps the solved flow")
    arguments = parser.parse_args()
    weights, _ = learn(arguments.generations, arguments.cache)
    for name, of in (("with what was learnt", weights), ("ahead, not steered", weights * [0, 0, 0, 1])):
        _, headings = play(make(32, 10**6, arguments.cache), np.broadcast_to(of, (32, 4)), 10**6)
        later = np.degrees(headings[STEPS // 2 :])
        print(f"{name}: {np.sqrt((later**2).mean()):.0f} degrees off in the root mean square of the second ten seconds of 32 boats")


if __name__ == "__main__":
    main()
