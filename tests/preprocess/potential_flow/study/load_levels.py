#!/usr/bin/env python3
"""Errors of reduced loads over bodies as a Markdown table: load_levels.py AMBIENT_PREPROCESS [ALPHA], alpha in pi/2."""
import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

MESHES = Path(__file__).resolve().parents[4] / "data" / "meshes"
OBLATE = {"type": "ellipsoid", "semi_axes": [1, 1, 0.2]}
ELLIPSOID = {"type": "ellipsoid", "semi_axes": [0.5, 0.4, 0.3]}
PLATE = {"type": "box", "size": [1, 1, 0.02]}
BODIES = (
    ("oblate 5:1", dict(OBLATE, faces=1300)),
    ("oblate 5:1", dict(OBLATE, faces=10000)),
    ("ellipsoid 5:4:3", dict(ELLIPSOID, faces=10000)),
    ("box 50:1", dict(PLATE, faces=1300)),
    ("box 50:1", dict(PLATE, faces=10000)),
    ("propeller", MESHES / "propeller.obj"),
)
LEVEL = re.compile(
    r"(\d+) clusters +p99 (\S+) %, rms (\S+) %, largest found (\S+) %, broadside (\S+) % of itself, friction (\S+) %")


def build(program, body, alpha, folder):
    """What the preprocessor says of the body and its levels; the flow, which they do not need, is not refined."""
    source = body
    if isinstance(body, dict):
        source = folder / "body.json"
        source.write_text(json.dumps(body))
    command = [program, "build", source, "-o", folder / "body.ambient", "--panels", "0"]
    levels = ["--levels", "48,96,200", "--separation-angle", repr(alpha * math.pi / 2)]
    result = subprocess.run(command + levels, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(result.stderr.strip())
    return result.stdout


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    alpha = float(sys.argv[2]) if len(sys.argv) == 3 else 1
    print("| body | faces | clusters | p99 | rms | largest found | broadside | friction |")
    print("|---|---|---|---|---|---|---|---|")
    for name, body in BODIES:
        with tempfile.TemporaryDirectory() as folder:
            text = build(sys.argv[1], body, alpha, Path(folder))
        faces = re.search(r"(?m)^  faces +(\d+)", text)[1]
        for clusters, *errors in LEVEL.findall(text):
            print(f"| {name} | {faces} | {clusters} | " + " | ".join(f"{float(e):.2g}" for e in errors) + " |")
            name = faces = ""


if __name__ == "__main__":
    main()
