#!/usr/bin/python3
"""A vehicle with six thrusters learns to hold its place in a current that it does not know: docs/worlds.md."""

import argparse

import numpy as np
from cma import Cma

import bullet_ambient as ba
from bullet_ambient.tasks import STATION, station_cost

STEPS = STATION["most_steps"]


def make(worlds, seed, cache=None):
    return ba.WorldBatch("rov_station", worlds, seed=seed, cache=cache, **STATION)


def features(batch):
    return np.concatenate([batch.observations, np.ones((batch.worlds, 1))], axis=1)


def play(batch, weights):
    """Flies one episode. `weights`: (N, 13, 6). Returns costs and distances from the place in the second half, (N,)."""
    cost, distance = np.zeros(batch.worlds), np.zeros(batch.worlds)
    for n in range(STEPS):
        batch.actions[:] = np.tanh(np.einsum("nf,nfa->na", features(batch), weights))
        batch.step()
        cost += station_cost(batch)
        if n >= STEPS // 2:
            distance += np.linalg.norm(batch["target"], axis=1)
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
