#!/usr/bin/python3
"""Times the paper's experiments and writes OUT/cost.json: measure_cost.py BIN OUT SCENES

Per scene: processor time of preparing its shape on one thread, and time per step in the fluid and without one (density 0,
the same integrator), the least of several takes each, so that others who use the machine do not show. All on one core.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SCENES = (
    "plate_10cm",
    "soccer_curl",
    "basketball_drop",
    "golf_smooth",
    "golf_dimpled_spin",
    "football",
    "underwater_bunny",
    "toy_propeller",
    "balloon",
    "paper_copter",
)
TAKES = 15


def processor_seconds(command):
    """User and system time of a command."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"failed: {' '.join(map(str, command))}")
    process.returncode = 0
    return usage.ru_utime + usage.ru_stime


class Measurement:
    def __init__(self, programs, scene_file, folder):
        self.demo, self.preprocess = programs / "ambient_demo", programs / "ambient_preprocess"
        self.scene_file, self.folder = scene_file, folder
        # One body: basketballs drop in fours and stand on nothing.
        scene = json.loads(scene_file.read_text())
        self.body = next(i for i, body in enumerate(scene["bodies"]) if body["mass"] > 0)
        self.shape = scene["bodies"][self.body]["shape"]
        self.duration = scene["duration"]
        self.bodies = sum(body["mass"] > 0 for body in scene["bodies"])

    def preparation(self):
        """Seconds to turn the shape into a fluid body."""
        shape = dict(self.shape)
        if "file" in shape:
            shape["file"] = str((self.scene_file.parent / shape["file"]).resolve())
        shape_file = self.folder / "shape.json"
        shape_file.write_text(json.dumps(shape))
        command = [self.preprocess, "build", shape_file, "-o", self.folder / "shape.ambient", "--rebuild", "--threads", "1"]
        return min(processor_seconds(command) for _ in range(2))

    def step(self, *changes):
        """Seconds and substeps per step and body."""
        out = self.folder / "run"
        # Nothing is written between steps.
        command = [self.demo, self.scene_file, "--out", out, "--quiet", "--set", f"output_step={self.duration}"]
        for change in changes:
            command += ["--set", change]
        least = float("inf")
        for _ in range(TAKES):
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            summary = json.loads((out / "summary.json").read_text())
            least = min(least, summary["wall_seconds_simulation"] / summary["steps"] / self.bodies)
        body = summary["bodies"][self.body]
        return least, body["work"]["substeps"] / summary["steps"], body["fluid_body"]["faces"]

    def entry(self):
        fluid, substeps, faces = self.step()
        empty, _, _ = self.step("medium.density=0")
        return {
            "faces": faces,
            "preparation": self.preparation(),
            "step": fluid,
            "step_without_fluid": empty,
            "substeps": substeps,
        }


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    programs, out, scenes = (Path(argument).resolve() for argument in sys.argv[1:])
    costs = {}
    for name in SCENES:
        with tempfile.TemporaryDirectory() as folder:
            costs[name] = Measurement(programs, scenes / f"{name}.json", Path(folder)).entry()
        print(f"{name}: timed", flush=True)
    out.mkdir(parents=True, exist_ok=True)
    (out / "cost.json").write_text(json.dumps(costs, indent=2) + "\n")


if __name__ == "__main__":
    main()
