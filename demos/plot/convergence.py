#!/usr/bin/python3
"""The gated numbers under half the time step and half the mesh size: convergence.py BIN OUT SCENES

Runs each scene as it is, with half its step, and with four times its faces, and writes OUT/convergence.json. Shapes that
have a key `faces` are meshed anew, those of more than 2000 with a quarter of them; the triangles of mesh files are
divided into four.
"""

import json
import subprocess
import sys
from pathlib import Path

from experiment_numbers import Numbers

GOLF = ("golf_dimpled_spin", "golf_smooth_spin", "golf_dimpled", "golf_smooth")
PLATES = ("plate_8cm", "plate_9cm", "plate_10cm")
# Faces of shapes that do not say how many.
DEFAULT_FACES = 1280
# The flow around finer meshes takes minutes.
MOST_DIVIDED = 2000


def gated_numbers():
    """Scene, name, function of Numbers, unit, the test's tolerance: a share, or a string of what is compared instead."""
    for scene in GOLF:
        yield scene, "carry", lambda n, scene=scene: n.carry(scene), "m", 0.01
    yield "soccer_curl", "drift at 20 m", lambda n: n.drift_at(20), "m", 0.02
    for turns in (1, 2, 3):
        name = f"drift, {turns} turns per second"
        yield "basketball_drop", name, lambda n, i=turns - 1: n.drops()[i], "m", 0.02
    yield "football", "range", lambda n: n.throw("football")[0], "m", 0.01
    yield "football", "axis off the path", lambda n: n.axis_angle("football"), "°", "< 10°"
    for scene in PLATES:
        tolerance = 0.15 if scene == "plate_9cm" else 0.05  # it is chaotic
        yield scene, "descent", lambda n, scene=scene: n.fall(scene)["descent_speed"], "m/s", tolerance
    yield "toy_propeller", "climb", lambda n: n.height("toy_propeller"), "m", "> 0.3 m"
    yield "paper_copter", "spin", lambda n: n.copter()[1], "rad/s", 0.05
    yield "paper_copter", "descent", lambda n: n.end_speed("paper_copter"), "m/s", 0.02


class Study:
    def __init__(self, programs, out, scenes):
        self.programs, self.out, self.scenes = programs, out, scenes

    def read(self, scene):
        return json.loads((self.scenes / f"{scene}.json").read_text())

    def run(self, kind, scene, changes):
        folder = self.out / kind / scene
        command = [self.programs / "ambient_demo", self.scenes / f"{scene}.json", "--out", folder, "--quiet"]
        for change in changes:
            command += ["--set", change]
        subprocess.run(command, check=True)

    def half_step(self, scene):
        return [f"time_step={self.read(scene)['time_step'] / 2!r}"]

    def half_mesh(self, scene):
        changes = []
        for i, body in enumerate(self.read(scene)["bodies"]):
            if body["mass"] == 0:
                continue
            if "file" in body["shape"]:
                changes.append(f"bodies.{i}.shape={self.divided(scene, body)}")
            else:
                faces = body["shape"].get("faces", DEFAULT_FACES)
                changes.append(f"bodies.{i}.shape.faces={4 * faces if faces <= MOST_DIVIDED else faces // 4}")
        return changes

    def divided(self, scene, body):
        """The shape of a mesh file as a fluid body with four times the faces, in the frame of the file."""
        file = self.scenes / body["shape"]["file"]
        target = (self.out / f"{scene}.ambient").resolve()
        sheet = body["shape"]["type"] == "sheet"
        triangles = sum(line.startswith("f ") for line in file.read_text().splitlines())
        command = [self.programs / "ambient_preprocess", "build", file, "-o", target, "--origin", "0,0,0"]
        command += ["--least-faces", str(4 * triangles)] + ["--sheet"] * sheet
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return json.dumps({"type": "fluid_body", "file": str(target)})

    def study(self):
        entries = list(gated_numbers())
        self.out.mkdir(parents=True, exist_ok=True)
        for scene in dict.fromkeys(entry[0] for entry in entries):
            self.run("as_it_is", scene, [])
            self.run("half_step", scene, self.half_step(scene))
            self.run("half_mesh", scene, self.half_mesh(scene))
            print(f"{scene}: run with half the step and half the mesh size", flush=True)
        kinds = {kind: Numbers(self.out / kind) for kind in ("as_it_is", "half_step", "half_mesh")}
        rows = []
        for scene, name, value, unit, tolerance in entries:
            row = {"scene": scene, "name": name, "unit": unit, "tolerance": tolerance}
            row.update({kind: float(value(numbers)) for kind, numbers in kinds.items()})
            if scene in PLATES:
                row["modes"] = [numbers.fall(scene)["mode"] for numbers in kinds.values()]
            rows.append(row)
        return rows


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    programs, out, scenes = (Path(argument) for argument in sys.argv[1:])
    rows = Study(programs, out / "convergence", scenes).study()
    (out / "convergence.json").write_text(json.dumps(rows, indent=2) + "\n")


if __name__ == "__main__":
    main()
