#!/usr/bin/env python3
"""Counts the instructions of a step by valgrind, per body, and compares them with recorded ones.

Where shapes differ it counts lines of 64 bytes that come from memory, in a simulated cache too small for the data of all
bodies: those of different shapes and of equal ones. What is between them is what a step reads of a shape. The first steps do not count. The count is that of the kernels for AVX2, whatever the processor: valgrind knows no AVX-512. Those of stock Bullet are counted when they are recorded."""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# Functions of the C library that do not depend on the processor: its fills by "rep stosb" count each byte.
FIXED = {"BULLET_AMBIENT_KERNELS": "avx2", "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-ERMS,-FSRM,-AVX2,-FMA,-AVX512F,-AVX512VL"}
# Bodies, steps that do not count, and all steps.
SCENES = {
    "boxes_under_water": (64, 20, 60), "plates_under_water": (64, 20, 60), "capsules_under_water": (64, 20, 60),
    "balls_under_water": (64, 20, 60),
    "boxes_afloat": (64, 20, 60), "capsules_afloat": (64, 20, 60), "balls_afloat": (64, 20, 60),
    "barges_closed": (64, 20, 60), "barges_dry": (64, 20, 60), "barges_with_water": (64, 20, 60),
    "multibodies_under_water": (64, 20, 40), "multibodies_afloat": (64, 20, 40), "pairs_under_water": (64, 20, 40),
    "robots_in_ideal_fluid": (8, 20, 40), "robots_under_water": (8, 20, 40), "robots_afloat": (8, 20, 40),
    "pile_in_water": (64, 30, 60), "block_in_water": (64, 30, 60), "stacks_in_water": (91, 30, 60),
    "figures_in_water": (44, 30, 60),
    "flight_without_faces": (100, 20, 60), "flight_with_500_faces": (24, 20, 60),
    "flight_with_5120_faces": (24, 20, 60),
    "scaled_in_each_step": (4, 4, 12)}
DIFFERENT = {f"different_{shapes}_300": (12, 4, 8) for shapes in ("boxes", "capsules", "cylinders", "cones", "balls")}

# Batches of worlds, by batch_cost beside the program: scene, worlds, env steps of four steps as above, and its last argument.
BATCHES = {"batch_of_rovs": ("rov_station", 16, 2, 6), "batch_of_rigid_rovs": ("rov_station", 16, 2, 6, "rigid"),
           "batch_of_rovs_afloat": ("rov_station", 16, 2, 6, "afloat"), "batch_of_sheets": ("glider", 16, 2, 6)}

KINDS = {"different": "fluid", "equal": "beside"}


class Counter:
    """Runs the program under valgrind."""

    def __init__(self, program: str, shapes: str) -> None:
        self.command = ["valgrind", "--tool=callgrind", "--collect-atstart=no", "--callgrind-out-file=/dev/null", program,
                        shapes]
        self.shapes, self.batches = shapes, str(Path(program).with_name("batch_cost"))
        subprocess.run([program, shapes, "shapes"], check=True)

    def counted(self, what: str, options: list[str], arguments: tuple) -> int:
        """Makes the steps; returns the number that stands behind `what` for those that count."""
        command = self.command[:2] + options + self.command[2:] + [str(argument) for argument in arguments]
        run = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **FIXED})
        counted = re.search(what + r"\s*:\s+([\d,]+)", run.stderr)
        if run.returncode != 0 or not counted:
            sys.exit(f"step_cost.py: {' '.join(command)} failed: {run.stderr.strip().splitlines()[-1]}")
        return int(counted.group(1).replace(",", ""))

    def per_body_and_step(self, scene: str, world: str) -> int:
        bodies, before, steps = SCENES[scene]
        counted = self.counted("Collected", [], (scene, world, bodies, before, steps - before))
        return round(counted / (bodies * (steps - before)))

    def lines_per_body_and_step(self, scene: str, world: str) -> int:
        bodies, before, steps = DIFFERENT[scene]
        cache = ["--cache-sim=yes", "--D1=32768,8,64", "--LL=131072,16,64"]
        counted = self.counted("LLd misses", cache, (scene, world, bodies, before, steps - before))
        return round(counted / (bodies * (steps - before)))

    def per_world_and_step(self, batch: str, kind: str) -> int:
        scene, worlds, before, steps, *change = BATCHES[batch]
        bodies = f"{self.shapes}/{scene}"
        subprocess.run([self.batches, bodies, scene, kind, "1", "0", "0", *change], check=True, stderr=subprocess.DEVNULL)
        self.command[-2:] = [self.batches, bodies]
        counted = self.counted("Collected", [], (scene, kind, worlds, before, steps - before, *change))
        return round(counted / (4 * worlds * (steps - before)))


def count(program: str, part: str, recorded: dict) -> dict[str, dict[str, int]]:
    """Counts all scenes whose names have the part; in stock Bullet only what is not recorded."""
    counts = {}
    with tempfile.TemporaryDirectory() as shapes:
        counter = Counter(program, shapes)
        for scene in SCENES:
            if part not in scene:
                continue
            stock = recorded[scene]["stock"] if scene in recorded else counter.per_body_and_step(scene, "stock")
            fluid = counter.per_body_and_step(scene, "fluid") - stock
            counts[scene] = {"stock": stock, "fluid": fluid}
            print(f"{scene:24s} stock {stock:6d}, fluid +{fluid:6d}: {1 + fluid / stock:.2f}", flush=True)
        for scene in DIFFERENT:
            if part not in scene:
                continue
            lines = {kind: counter.lines_per_body_and_step(scene, world) for kind, world in KINDS.items()}
            counts[scene] = lines
            print(f"{scene:24s} lines from memory: different {lines['different']}, equal {lines['equal']}", flush=True)
        for batch in BATCHES:
            if part not in batch:
                continue
            counts[batch] = {kind: counter.per_world_and_step(batch, kind) for kind in ("alone", "together")}
            print(f"{batch:24s} a world alone {counts[batch]['alone']:6d}, eight together {counts[batch]['together']:6d}")
    return counts


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="step_cost")
    parser.add_argument("--scene", default="", help="only scenes whose names contain this")
    parser.add_argument("--recorded", type=Path, default=Path(__file__).with_name("instructions.json"))
    parser.add_argument("--record", action="store_true", help="write the counts instead of comparing them")
    parser.add_argument("--within", type=float, default=0.05, help="largest relative difference (default: 0.05)")
    arguments = parser.parse_args()
    recorded = json.loads(arguments.recorded.read_text()) if arguments.recorded.exists() else {}
    counts = count(arguments.program, arguments.scene, {} if arguments.record else recorded)
    if arguments.record:
        arguments.recorded.write_text(json.dumps({**recorded, **counts}, indent=1) + "\n")
        return 0
    far = [scene for scene, found in counts.items()
           if scene not in recorded or
           any(abs(found[key] - recorded[scene][key]) > arguments.within * abs(recorded[scene][key]) for key in found)]
    for scene in far:
        print(f"{scene}: {counts[scene]} per body and step, recorded are {recorded.get(scene)}; "
              f"if that is meant, run {sys.argv[0]} {arguments.program} --record", file=sys.stderr)
    return 1 if far else 0


if __name__ == "__main__":
    sys.exit(main())
