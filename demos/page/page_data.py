"""What the page needs of the runs: bodies, shapes and motion, packed."""

import base64
import csv
import json
import math
import re
import sys
from pathlib import Path

import numpy as np
from files import reading

# Samples per second that the page interpolates between.
RATE = 60
# Columns of trajectory.csv: time, position, orientation, angular velocity, velocity.
MOTION = [0, *range(2, 15)]
# Parts of a wrench, as `ambient_demo --log wrench` names them.
FORCES = ("pressure", "friction", "buoyancy", "waves", "wind", "added_mass", "constraints")


def encode(values, kind):
    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode()


def read_motion(file):
    """Rows of trajectory.csv by body, of the columns MOTION and then of those of the forces [N] and of the water in holds, if there
    are any, whose names are the other result."""
    motion = {}
    with open(file, newline="") as stream:
        reader = csv.reader(stream)
        names = next(reader)
        more = [f"{part}_f{axis}" for part in FORCES if f"{part}_fx" in names for axis in "xyz"]
        more += [name for name in names if re.fullmatch(r"hold\d+_(volume|level_[xyz]|normal_[xyz])", name)]
        columns = MOTION + [names.index(name) for name in more]
        for row in reader:
            motion.setdefault(row[1], []).append([float(row[i] or "nan") for i in columns])
    return {name: np.array(rows) for name, rows in motion.items()}, more


def thin_out(rows, output_step):
    """Every so many rows that RATE is about kept, and the last one."""
    stride = max(1, round(1 / (RATE * output_step)))
    kept = np.arange(0, len(rows), stride)
    return rows[kept if kept[-1] == len(rows) - 1 else np.append(kept, len(rows) - 1)]


class Shapes:
    """Distinct shapes in the order of their first use."""

    def __init__(self):
        self.indices = {}
        self.packed = []

    def add(self, body):
        triangles = np.reshape(body["triangles"], (-1, 3))
        if body.get("sheet"):
            triangles = np.concatenate([triangles, triangles[:, ::-1]])
        packed = {"vertices": encode(body["vertices"], "<f4"), "triangles": encode(triangles, "<u4")}
        index = self.indices.setdefault(tuple(packed.values()), len(self.packed))
        if index == len(self.packed):
            self.packed.append({**packed, "sheet": body.get("sheet", False)})
        return index


def pack_bodies(folder, summary, geometry, shapes):
    motion, more = read_motion(folder / "trajectory.csv")
    forces = [len(MOTION) + i for i, name in enumerate(more) if not name.startswith("hold")]
    bodies = []
    for body in geometry["bodies"]:
        rows = motion[body["name"]]
        rows = thin_out(rows, summary["output_step"]) if body["mass"] > 0 else rows[:1]
        packed = {
            "name": body["name"],
            "mass": body["mass"],
            # The default law has the whole lee in the wake.
            "separation_angle": body["separation_angle"] if body["law"] == "published" else math.pi / 2,
            "shape": shapes.add(body),
            "samples": encode(rows[:, : len(MOTION)], "<f4"),
        }
        if forces and body["mass"] > 0:
            packed["forces"] = {"parts": FORCES, "samples": encode(rows[:, forces], "<f4")}
        for i, hold in enumerate(body.get("holds", [])):
            levels = [len(MOTION) + k for k, name in enumerate(more) if name.startswith(f"hold{i}_")]
            if levels and body["mass"] > 0:
                packed.setdefault("holds", []).append({"shape": shapes.add(hold), "samples": encode(rows[:, levels], "<f4")})
        bodies.append(packed)
    return bodies


def read_run(folder, shapes):
    with reading(folder, "a folder of results of ambient_demo"):
        summary = json.loads((folder / "summary.json").read_text())
        geometry = json.loads((folder / "geometry.json").read_text())
        return summary, geometry, pack_bodies(folder, summary, geometry, shapes)


def pack(folders):
    """Runs of scenes in the order given; a folder SCENE-MODEL is a rival of that scene's run."""
    shapes, runs, rivals = Shapes(), {}, []
    for folder in map(Path, folders):
        summary, geometry, bodies = read_run(folder, shapes)
        scene, model = summary["scene"], summary["model"]
        if folder.name == f"{scene}-{model}":
            rivals.append((scene, {"model": model, "bodies": bodies}))
            continue
        runs[scene] = {
            "name": scene,
            "description": summary["description"],
            "model": model,
            "duration": summary["duration"],
            "gravity": summary["gravity"],
            "medium_velocity": geometry["medium_velocity"],
            "joints": geometry["joints"],
            "water": geometry["water"],
            "bodies": bodies,
            "rivals": [],
        }
    for scene, rival in rivals:
        if scene not in runs:
            sys.exit(f"{scene}-{rival['model']}: there is no run of {scene} beside it")
        runs[scene]["rivals"].append(rival)
    return {"shapes": shapes.packed, "runs": list(runs.values())}
