#!/usr/bin/python3
"""A vehicle with six thrusters learns to hold its place in a current that it does not know: docs/worlds.md."""

import argparse

import numpy as np
from cma import Cma

import bullet_ambient as ba

STEPS = 200  # env steps of 0.05 s
# Published drags of nearly this vehicle differ by 5 to 10 times, and added masses by 2 to 3 times: docs/worlds.md.
VARY = {"loads": (0.5, 1.5), "added_mass": (0.5, 1.3), "mass": (0.98, 1.02), "position": (-1, 1), "attitude": (-0.3, 0.3),
        "current": ((-0.4, -0.4, -0.1), (0.4, 0.4, 0.1))}


def make(worlds, seed, cache=None):
    observations = ["target", ba.observe("rotation", rows=[3, 6, 7]), "twist"]
    return ba.WorldBatch("rov_station", worlds, substeps=10, most_steps=STEPS, seed=seed, actions=["thrusters"],
                         observations=observations, vary=VARY, gust=ba.Gust(0.05, 3.0), cache=cache)


def features(batch):
    return np.concatenate([batch.observations, np.ones((batch.worlds, 1))], axis=1)


def play(batch, weights):
    """Flies one episode. `weights`: (N, 13, 6). Returns costs and distances from the place in the second half, (N,)."""
    cost, distance = np.zeros(batch.worlds), np.zeros(batch.worlds)
    for n in range(STEPS):
        batch.actions[:] = np.tanh(np.einsum("nf,nfa->na", features(batch), weights))
        batch.step()
        away = np.linalg.norm(batch["target"], axis=1)
        cost += away + 0.5 * np.abs(batch["rotation"][:, 0]) + 0.02 * (batch.actions**2).mean(1)
        if n >= STEPS // 2:
            distance += away
    return np.where(batch.failed, 100, cost / STEPS), distance / (STEPS - STEPS // 2)


def learn(generations, population=32, each=4, cache=None, say=print):
    """Returns the weights (13, 6), and the costs of the generations, by CMA-ES: `each` worlds try one set of weights."""
    batch, search, costs = make(population * each, 0, cache), Cma(np.zeros(78), 0.3, population), []
    for generation in range(generations):
        # All sets of weights meet the same worlds.
        batch.reset(seed=[1000 * generation + i % each for i in range(batch.worlds)])
        tried = search.ask()
        cost, _ = play(batch, np.repeat(tried.reshape(-1, 13, 6), each, axis=0))
        search.tell(cost.reshape(population, each).mean(1))
        costs.append(float(np.median(cost)))
        if generation % 5 == 0:
            say(f"generation {generation}: cost {costs[-1]:.2f}")
    return search.mean.reshape(13, 6), costs


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--generations", type=int, default=60, help="default: %(default)s")
    parser.add_argument("--cache", metavar="DIR", help="folder that keeps the solved flow")
    arguments = parser.parse_args()
    weights, _ = learn(arguments.generations, cache=arguments.cache)
    for name, with_weights in (("with what was learnt", weights), ("without thrust", 0 * weights)):
        test = make(64, 10**6, arguments.cache)
        _, distance = play(test, np.broadcast_to(with_weights, (64, 13, 6)))
        print(f"{name}: {100 * distance.mean():.1f} cm from its place in the mean of 64 worlds that it has not met")


if __name__ == "__main__":
    main()
