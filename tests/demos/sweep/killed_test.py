#!/usr/bin/python3
"""Cases that are killed in the midst, again and again, end with the results of a run that was not."""

import json
import subprocess
import tempfile
import unittest
from pathlib import Path

from sweep_cases import SWEEP, done, kill_after, write_cases

CASES = 60


class KilledTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.cases = self.folder / "cases.jsonl"
        write_cases(self.cases, CASES)

    def command(self, out, *more):
        return [*SWEEP, "--cases", self.cases, "--out", out, "--quiet", *more]

    def table(self, out):
        file = self.folder / f"{out.name}.csv"
        subprocess.run(self.command(out, "--collect", file), check=True)
        return file.read_text()

    def kill(self, out, more):
        """Two threads, until some more cases are done."""
        enough = done(out) + more
        return kill_after(self.command(out, "--threads", "2"), lambda: done(out) >= enough)

    def test_ends_with_the_same_results(self):
        whole, killed = self.folder / "whole", self.folder / "killed"
        subprocess.run(self.command(whole), check=True)
        kills = 0
        while self.kill(killed, 9):
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
        self.kill(killed, 5)
        for summary in killed.glob("*/summary.json"):
            json.loads(summary.read_text())
            self.assertTrue((summary.parent / "trajectory.csv").read_text().endswith("\n"))


if __name__ == "__main__":
    unittest.main()
