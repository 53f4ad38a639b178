"""Reads what ambient_demo writes: DIR/trajectory.csv and DIR/summary.json."""

import csv
import json
from pathlib import Path

import numpy as np
from files import reading


class Track:
    """Motion of one body: arrays over its rows, and its entry of summary.json."""

    def __init__(self, entry, rows):
        self.entry = entry
        self.name = entry["name"]
        self.time = rows[:, 0]
        self.position = rows[:, 1:4]
        self.orientation = rows[:, 4:8]  # w, x, y, z
        self.spin = rows[:, 8:11]
        self.velocity = rows[:, 11:14]

    def rotations(self):
        """Shape's axes to world axes, one 3 x 3 matrix per row."""
        w, x, y, z = self.orientation.T
        return np.moveaxis(
            np.array(
                [
                    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
                ]
            ),
            2,
            0,
        )


class Run:
    """One folder of results."""

    def __init__(self, folder):
        with reading(folder, "a folder of results of ambient_demo"):
            self.read(Path(folder))

    def read(self, folder):
        self.summary = json.loads((folder / "summary.json").read_text())
        self.name = self.summary["scene"]
        rows = {}
        with open(folder / "trajectory.csv", newline="") as stream:
            reader = csv.reader(stream)
            next(reader)
            for row in reader:
                rows.setdefault(row[1], []).append([float(row[0]), *map(float, row[2:15])])
        self.tracks = [Track(entry, np.array(rows[entry["name"]])) for entry in self.summary["bodies"]]

    def up(self):
        """Unit vector against gravity; +z without gravity."""
        gravity = np.array(self.summary["gravity"], float)
        strength = np.linalg.norm(gravity)
        return -gravity / strength if strength > 0 else np.array([0.0, 0.0, 1.0])

    def falling_plate(self):
        """The first track that was classified as a fall; None if there is none."""
        return next((track for track in self.tracks if track.entry.get("fall")), None)
