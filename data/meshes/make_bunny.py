#!/usr/bin/python3
"""Writes bunny.obj next to this file from the npm package `bunny`: make_bunny.py PACKAGE/index.js

    npm pack bunny@1.0.1 && tar xzf bunny-1.0.1.tgz && data/meshes/make_bunny.py package/index.js

The package's mesh (1839 vertices, 3674 triangles, in public domain) is closed and of genus 0. Edges are collapsed, that
which changes the surface least first (quadric error metrics, Garland and Heckbert 1997), while the mesh stays a closed
surface without flipped or needle-like triangles; then the bunny is turned upright along z and scaled to metres. The
result is checked: every edge between two triangles of one sense, positive volume, no two triangles that cross.
Needs numpy. Same input, same output.
"""

import hashlib
import heapq
import json
import sys
from itertools import combinations
from pathlib import Path

import numpy as np

PACKAGE_SHA256 = "4c428649f2cabf3c11a0225f58367c503d181b7e2a59223a610c88a5308412b3"
VERTICES = 466  # 928 triangles; the paper's bunny has 468 and 932
HEIGHT = 0.1  # [m]
LEAST_HEIGHT = 0.15  # of a triangle over its longest edge


def read_package(path):
    data = Path(path).read_bytes()
    if hashlib.sha256(data).hexdigest() != PACKAGE_SHA256:
        sys.exit(f"{path}: not the index.js of bunny 1.0.1")
    arrays = {}
    for line in data.decode().splitlines():
        name, _, value = line.rstrip(";").partition("=")
        if value:
            arrays[name] = json.loads(value)
    return np.array(arrays["exports.positions"]), arrays["exports.cells"]


def normal_of(a, b, c):
    return np.cross(b - a, c - a)


class Decimation:
    """Collapses edges of a closed mesh until so many vertices are left."""

    def __init__(self, points, triangles):
        self.points = list(points)
        self.triangles = {i: list(t) for i, t in enumerate(triangles)}
        self.around = [set() for _ in points]  # triangles at each vertex
        for i, triangle in self.triangles.items():
            for v in triangle:
                self.around[v].add(i)
        self.quadrics = [np.zeros((4, 4)) for _ in points]
        for triangle in triangles:
            self.add_quadric(triangle)
        self.version = [0] * len(points)
        self.queue = []
        for v in range(len(points)):
            for w in self.neighbours(v):
                if v < w:
                    self.offer(v, w)

    def add_quadric(self, triangle):
        a, b, c = (self.points[v] for v in triangle)
        normal = normal_of(a, b, c)
        twice_area = np.linalg.norm(normal)
        plane = np.append(normal, -normal @ a) / twice_area
        for v in triangle:
            self.quadrics[v] += twice_area * np.outer(plane, plane)

    def neighbours(self, v):
        return {w for i in self.around[v] for w in self.triangles[i]} - {v}

    def offer(self, v, w):
        """Puts an edge into the queue with the best place for its ends."""
        quadric = self.quadrics[v] + self.quadrics[w]
        middle = (self.points[v] + self.points[w]) / 2
        # Where the quadric says little, near the middle.
        weight = 1e-3 * np.trace(quadric[:3, :3])
        matrix = quadric[:3, :3] + weight * np.eye(3)
        place = np.linalg.solve(matrix, weight * middle - quadric[:3, 3])
        extended = np.append(place, 1)
        cost = extended @ quadric @ extended
        heapq.heappush(self.queue, (cost, v, w, self.version[v], self.version[w], tuple(place)))

    def may_collapse(self, v, w, place):
        shared = self.around[v] & self.around[w]
        opposite = {u for i in shared for u in self.triangles[i]} - {v, w}
        if len(shared) != 2 or self.neighbours(v) & self.neighbours(w) != opposite:
            return False
        # The two outer vertices lose a triangle each.
        if any(len(self.around[u]) <= 3 for u in opposite):
            return False
        for i in (self.around[v] | self.around[w]) - shared:
            old = [self.points[u] for u in self.triangles[i]]
            new = [place if u in (v, w) else self.points[u] for u in self.triangles[i]]
            before, after = normal_of(*old), normal_of(*new)
            longest = max((p - q) @ (p - q) for p, q in combinations(new, 2))
            if before @ after < 0.3 * np.linalg.norm(before) * np.linalg.norm(after):
                return False
            if np.linalg.norm(after) < LEAST_HEIGHT * longest:
                return False
        return True

    def collapse(self, v, w, place):
        for i in self.around[v] & self.around[w]:
            for u in self.triangles.pop(i):
                self.around[u].discard(i)
        for i in self.around[w]:
            self.triangles[i] = [v if u == w else u for u in self.triangles[i]]
        self.around[v] |= self.around[w]
        self.around[w] = set()
        self.points[v] = place
        self.quadrics[v] = self.quadrics[v] + self.quadrics[w]
        self.version[v] += 1
        self.version[w] = -1
        for u in self.neighbours(v):
            self.offer(min(u, v), max(u, v))

    def run(self, vertices):
        left = len(self.points)
        while left > vertices:
            _, v, w, age_v, age_w, place = heapq.heappop(self.queue)
            place = np.array(place)
            current = self.version[v] == age_v and self.version[w] == age_w
            if current and self.may_collapse(v, w, place):
                self.collapse(v, w, place)
                left -= 1

    def result(self):
        used = sorted({v for t in self.triangles.values() for v in t})
        number = {v: k for k, v in enumerate(used)}
        triangles = [[number[v] for v in self.triangles[i]] for i in sorted(self.triangles)]
        return np.array([self.points[v] for v in used]), np.array(triangles)


def volume_of(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def check_closed(triangles):
    edges = [(t[k], t[(k + 1) % 3]) for t in triangles.tolist() for k in range(3)]
    if len(set(edges)) != len(edges) or {(b, a) for a, b in edges} != set(edges):
        sys.exit("the result is not closed")


def crossing_pairs(points, triangles):
    """Pairs of triangles without a common vertex of which an edge of one pierces the other."""
    found = []
    corners = points[triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    for i in range(len(triangles)):
        near = np.flatnonzero(((low <= high[i]) & (high >= low[i])).all(axis=1))
        for j in near[near != i]:
            if set(triangles[i]) & set(triangles[j]):
                continue
            if any(pierces(corners[i][k], corners[i][(k + 1) % 3], corners[j]) for k in range(3)):
                found.append((i, j))
    return found


def pierces(start, end, triangle):
    a, b, c = triangle
    direction = end - start
    matrix = np.stack([b - a, c - a, -direction], axis=1)
    if np.linalg.matrix_rank(matrix) < 3:
        return False
    s, t, along = np.linalg.solve(matrix, start - a)
    return s >= 0 and t >= 0 and s + t <= 1 and 0 <= along <= 1


def main():
    points, cells = read_package(sys.argv[1])
    decimation = Decimation(points, cells)
    decimation.run(VERTICES)
    points, triangles = decimation.result()
    # The package's y axis is up.
    points = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
    low, high = points.min(axis=0), points.max(axis=0)
    points = (points - (low + high) / 2) * HEIGHT / (high[2] - low[2])
    points = points.round(7)
    check_closed(triangles)
    if volume_of(points, triangles) <= 0 or crossing_pairs(points, triangles):
        sys.exit("the result is inside out or crosses itself")
    lines = ["# The Stanford bunny, 10 cm high, metres, z up; written by make_bunny.py from the npm package bunny 1.0.1"]
    lines += ["v " + " ".join(f"{x + 0:.7f}" for x in point) for point in points]
    lines += ["f " + " ".join(str(v + 1) for v in triangle) for triangle in triangles]
    (Path(__file__).resolve().parent / "bunny.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
