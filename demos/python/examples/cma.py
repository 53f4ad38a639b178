"""The CMA evolution strategy: minimises a function of some numbers without derivatives.

After N. Hansen, "The CMA Evolution Strategy: A Tutorial", arXiv 1604.00772 (2016), figure 6, with its default parameters.
"""

import numpy as np


class Cma:
    """ask() gives points (population, n) to try, tell() takes their costs."""

    def __init__(self, start, sigma, population, seed=0):
        self.mean, self.sigma, self.random = np.array(start, float), sigma, np.random.default_rng(seed)
        n, parents = len(start), population // 2
        weights = np.log(parents + 0.5) - np.log(np.arange(1, parents + 1))
        self.weights, self.population = weights / weights.sum(), population
        self.effective = 1 / (self.weights**2).sum()
        mu = self.effective
        self.pull_c, self.pull_s = (4 + mu / n) / (n + 4 + 2 * mu / n), (mu + 2) / (n + mu + 5)
        self.rate_1 = 2 / ((n + 1.3) ** 2 + mu)
        self.rate_mu = min(1 - self.rate_1, 2 * (mu - 2 + 1 / mu) / ((n + 2) ** 2 + mu))
        self.damping = 1 + 2 * max(0, np.sqrt((mu - 1) / (n + 1)) - 1) + self.pull_s
        self.length = np.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n**2))  # of a normal vector, in the mean
        self.covariance, self.path_c, self.path_s, self.told = np.eye(n), np.zeros(n), np.zeros(n), 0

    def ask(self):
        squares, self.axes = np.linalg.eigh(self.covariance)
        self.lengths = np.sqrt(np.maximum(squares, 1e-20))
        normal = self.random.standard_normal((self.population, len(self.mean)))
        self.steps = normal * self.lengths @ self.axes.T
        return self.mean + self.sigma * self.steps

    def tell(self, costs):
        best = self.steps[np.argsort(costs)[: len(self.weights)]]
        step = self.weights @ best
        self.mean, self.told = self.mean + self.sigma * step, self.told + 1
        whitened = self.axes @ (self.axes.T @ step / self.lengths)
        self.path_s = (1 - self.pull_s) * self.path_s + np.sqrt(self.pull_s * (2 - self.pull_s) * self.effective) * whitened
        length = np.linalg.norm(self.path_s)
        is_calm = length / np.sqrt(1 - (1 - self.pull_s) ** (2 * self.told)) < (1.4 + 2 / (len(step) + 1)) * self.length
        self.path_c = (1 - self.pull_c) * self.path_c + is_calm * np.sqrt(self.pull_c * (2 - self.pull_c) * self.effective) * step
        forgotten = 1 - self.rate_1 - self.rate_mu + (1 - is_calm) * self.rate_1 * self.pull_c * (2 - self.pull_c)
        self.covariance = forgotten * self.covariance + self.rate_1 * np.outer(self.path_c, self.path_c)
        self.covariance += self.rate_mu * (best.T * self.weights) @ best
        self.sigma *= np.exp(self.pull_s / self.damping * (length / self.length - 1))
