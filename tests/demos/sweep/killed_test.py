#!/usr/bin/python3
"""Cases of ambient_demo that are killed in the midst, again and again, end with the results of a run that was not."""

import json
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = sys.argv.pop(1)
CASES = 60


def scene():
    ball = {"name": "ball", "mass": 1, "position": [0, 0, 10], "shape": {"type": "sphere", "radius": 0.1, "faces": 80}}
    return {"duration": 2, "time_step": 0.001, "output_step": 0.1, "bodies": [ball]}


def done(out):
    return len(list(out.glob("*/summary.json")))


class KilledTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.cases = self.folder / "cases.jsonl"
        lines = [{"scene": scene(), "set": {"bodies.0.mass": 1 + i / 8}} for i in range(CASES)]
        self.cases.write_text("".join(json.dumps(line) + "\n" for line in lines))

    def command(self, out, *more):
        return [PROGRAM, "--cases", self.cases, "--out", out, "--quiet", *more]

    def table(self, out):
        file = self.folder / f"{out.name}.csv"
        subprocess.run(self.command(out, "--collect", file), check=True)
        return file.read_text()

    def kill_after(self, out, more, shard="0/1"):
        """Ends two threads without warning when some more cases are done; whether there was need to."""
        before = done(out)
        process = subprocess.Popen(self.command(out, "--threads", "2", "--shard", shard))
        while process.poll() is None and done(out) < before + more:
            time.sleep(0.002)
        process.kill()
        return process.wait() != 0

    def test_ends_with_the_same_results(self):
        whole, killed = self.folder / "whole", self.folder / "killed"
        subprocess.run(self.command(whole), check=True)
        kills = 0
        while self.kill_after(killed, 9):
            kills += 1
        self.assertGreaterEqual(kills, 3)
        self.assertEqual(done(killed), CASES)
        self.assertEqual(self.table(killed), self.table(whole))
        self.assertEqual(self.table(whole).count("\n"), 1 + CASES)
        for file in whole.glob("*/*"):
            if file.name != "summary.json":  # which tells how long the run took
                self.assertEqual((killed / file.relative_to(whole)).read_bytes(), file.read_bytes())

    def test_what_a_kill_leaves_is_no_result(self):
        killed = self.folder / "killed"
        self.kill_after(killed, 5)
        for summary in killed.glob("*/summary.json"):
            json.loads(summary.read_text())
            self.assertTrue((summary.parent / "trajectory.csv").read_text().endswith("\n"))


if __name__ == "__main__":
    unittest.main()
