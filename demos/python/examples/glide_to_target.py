#!/usr/bin/python3
"""A sheet of paper with a moment about its span learns to land on a point: docs/worlds.md."""

import argparse

import numpy as np
from cma import Cma

import bullet_ambient as ba

HEIGHT, MOST = 3.0, 320  # [m], env steps of six steps of 1/240 s


def make(worlds, seed, cache=None):
    vary = {"target": ((2, 0, 0), (6, 0, 0)), "current": ((-0.3, 0, 0), (0.3, 0, 0))}
    scene = ba.Scene("glider", {"time_step": 1 / 240, "bodies.0.position": [0, 0, HEIGHT]})
    return ba.WorldBatch(scene, worlds, substeps=6, most_steps=MOST, seed=seed, vary=vary, cache=cache,
                         actions=[ba.act("wrench", rows=[1], scale=6e-5)], observations=["position", "rotation", "twist_world"])


def features(batch):
    """Constant, attitude, rate, velocity, and the way to go, (N, 8)."""
    place, turn, twist = batch["position"], batch["rotation"], batch["twist_world"]
    way = batch.parameter("target")[:, 0] - place[:, 0]
    return np.stack([np.ones(len(way)), turn[:, 6], turn[:, 0], twist[:, 1] / 5, twist[:, 3] / 3, twist[:, 5] / 3, way / 3,
                     way / (np.maximum(place[:, 2], 0) + 0.3)], axis=1)


def misses(batch, weights):
    """Flies one episode. `weights`: (N, 8). Returns how far from their targets the sheets land, (N,) [m]."""
    landed, x = np.zeros(batch.worlds, bool), batch["position"][:, 0].copy()
    for _ in range(MOST):
        before = batch["position"].copy()
        batch.actions[:, 0] = np.tanh((features(batch) * weights).sum(1))
        batch.step()
        now = batch["position"]
        share = np.clip(before[:, 2] / np.maximum(before[:, 2] - now[:, 2], 1e-9), 0, 1)
        x = np.where(landed, x, before[:, 0] + share * (now[:, 0] - before[:, 0]))
        landed |= now[:, 2] < 0
        if landed.all():
            break
    miss = np.abs(x - batch.parameter("target")[:, 0])
    return np.where(batch.failed | ~landed, 10, miss)


def learn(generations, population=16, each=6, cache=None, say=print):
    """Returns the weights (8,) and the misses of the generations [m], by CMA-ES: `each` worlds try one set of weights."""
    batch, search, found = make(population * each, 0, cache), Cma(np.zeros(8), 0.5, population), []
    for generation in range(generations):
        batch.reset(seed=[1000 * generation + i % each for i in range(batch.worlds)])
        miss = misses(batch, np.repeat(search.ask(), each, axis=0))
        search.tell(miss.reshape(population, each).mean(1))
        found.append(float(np.median(miss)))
        if generation % 5 == 0:
            say(f"generation {generation}: {found[-1]:.2f} m")
    return search.mean, found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--generations", type=int, default=40, help="default: %(default)s")
    parser.add_argument("--cache", metavar="DIR", help="folder that keeps the solved flow")
    arguments = parser.parse_args()
    weights, _ = learn(arguments.generations, cache=arguments.cache)
    for name, of in (("with what was learnt", weights), ("untrimmed", 0 * weights)):
        miss = misses(make(64, 10**6, arguments.cache), np.broadcast_to(of, (64, 8)))
        print(f"{name}: {100 * miss.mean():.0f} cm from its target in the mean of 64 that it has not met, {100 * miss.max():.0f} cm at most")


if __name__ == "__main__":
    main()
