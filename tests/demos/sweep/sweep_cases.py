"""Cases for the tests of sweeps: a ball that falls for a second, in several masses; their results."""

import json
import os
import signal
import subprocess
import sys
import time

SWEEP = (sys.executable, "-m", "bullet_ambient")


def write_cases(file, count, duration=2):
    ball = {"name": "ball", "mass": 1, "position": [0, 0, 10], "shape": {"type": "sphere", "radius": 0.1, "faces": 80}}
    scene = {"duration": duration, "time_step": 0.001, "output_step": 0.1, "bodies": [ball]}
    lines = [{"scene": scene, "set": {"bodies.0.mass": 1 + i / 8}} for i in range(count)]
    file.write_text("".join(json.dumps(line) + "\n" for line in lines))


def done(out):
    return len(list(out.glob("*/summary.json")))


def kill_after(command, is_time, **options):
    """Starts a program in a session of its own and ends all of it without warning; whether there was need to."""
    process = subprocess.Popen(command, start_new_session=True, **options)
    while process.poll() is None and not is_time():
        time.sleep(0.002)
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass  # all have ended
    return process.wait() != 0
