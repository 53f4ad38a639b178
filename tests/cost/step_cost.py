#!/usr/bin/env python3
"""Counts the instructions of a step by valgrind, per body, and compares them with recorded ones.

A count is the difference between two runs of unequal length, so that start and end do not count. It is that of the kernels
for AVX2, whatever the processor: valgrind knows no AVX-512."""
import argparse
import json
import os
import re
import subprocess
import sys
from pathlib import Path

BODIES, FEW, MANY = 64, 20, 60
# Functions of the C library that do not depend on the processor: its fills by "rep stosb" count each byte.
FIXED = {"BULLET_AMBIENT_KERNELS": "avx2", "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-ERMS,-FSRM,-AVX2,-FMA,-AVX512F,-AVX512VL"}
SCENES = ("boxes_under_water", "plates_under_water", "capsules_under_water", "balls_under_water", "boxes_afloat",
          "capsules_afloat", "balls_afloat")


def instructions(program: str, scene: str, world: str, steps: int) -> int:
    """Runs the steps; returns the number of instructions of the whole run."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, scene, world, str(BODIES),
               str(steps)]
    run = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **FIXED})
    counted = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or not counted:
        sys.exit(f"step_cost.py: {' '.join(command)} failed: {run.stderr.strip().splitlines()[-1]}")
    return int(counted.group(1))


def per_body_and_step(program: str, scene: str, world: str) -> int:
    difference = instructions(program, scene, world, MANY) - instructions(program, scene, world, FEW)
    return round(difference / (BODIES * (MANY - FEW)))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="step_cost")
    parser.add_argument("--recorded", type=Path, default=Path(__file__).with_name("instructions.json"))
    parser.add_argument("--record", action="store_true", help="write the counts instead of comparing them")
    parser.add_argument("--within", type=float, default=0.05, help="largest relative difference (default: 0.05)")
    arguments = parser.parse_args()
    counts = {}
    for scene in SCENES:
        stock = per_body_and_step(arguments.program, scene, "stock")
        counts[scene] = per_body_and_step(arguments.program, scene, "fluid") - stock
        print(f"{scene:22s} stock {stock:6d}, fluid +{counts[scene]:6d}", flush=True)
    if arguments.record:
        arguments.recorded.write_text(json.dumps(counts, indent=1) + "\n")
        return 0
    recorded = json.loads(arguments.recorded.read_text())
    far = [scene for scene, count in counts.items() if abs(count / recorded[scene] - 1) > arguments.within]
    for scene in far:
        print(f"{scene}: {counts[scene]} instructions per body and step, recorded are {recorded[scene]}; "
              f"if that is meant, run {sys.argv[0]} {arguments.program} --record", file=sys.stderr)
    return 1 if far else 0


if __name__ == "__main__":
    sys.exit(main())
