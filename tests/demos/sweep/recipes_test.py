#!/usr/bin/python3
"""The recipes of docs/sweeps.md, each with two workers that are killed in the midst, end with the right results."""

import importlib.util
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from sweep_cases import SWEEP, done, kill_after, write_cases

BIN = Path(sys.argv.pop(1)).resolve()
ROOT = Path(__file__).resolve().parents[3]
RECIPES = ROOT / "demos/sweep/recipes"
CASES = 96
ENVIRONMENT = {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}", "PYTHONDONTWRITEBYTECODE": "1"}


def has(*modules):
    return all(importlib.util.find_spec(module) for module in modules)


def children(pid):
    """Processes below one, by /proc."""
    found = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in map(int, task.read_text().split()):
            found += [child, *children(child)]
    return found


def named(pid, word):
    try:
        return word in Path(f"/proc/{pid}/cmdline").read_text()
    except OSError:
        return False


class RecipesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.cases, self.out = self.folder / "cases.jsonl", self.folder / "out"
        write_cases(self.cases, CASES)

    def table(self, out):
        file = self.folder / "table.csv"
        subprocess.run([*SWEEP, "--cases", self.cases, "--out", out, "--collect", file, "--quiet"], check=True)
        return file.read_text()

    def assertResultsAreRight(self):
        whole = self.folder / "whole"
        subprocess.run([*SWEEP, "--cases", self.cases, "--out", whole, "--quiet"], check=True)
        self.assertEqual(done(self.out), CASES)
        self.assertEqual(self.table(self.out), self.table(whole))

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_parallel(self):
        command = [RECIPES / "parallel.sh", self.cases, self.out, "-j2"]
        options = {"env": ENVIRONMENT, "cwd": self.folder, "stderr": subprocess.DEVNULL}
        self.assertTrue(kill_after(command, lambda: done(self.out) >= CASES // 3, **options))
        self.assertLess(done(self.out), CASES)
        # One worker is killed under the next start, which says so; the third ends it.
        process = subprocess.Popen(command, **options)
        while not (workers := [pid for pid in children(process.pid) if named(pid, "bullet_ambient\0--cases")]):
            time.sleep(0.001)
        os.kill(workers[-1], signal.SIGKILL)
        self.assertNotEqual(process.wait(), 0)
        subprocess.run(command, check=True, **options)
        self.assertResultsAreRight()

    @unittest.skipUnless(shutil.which("snakemake"), "Snakemake is not installed")
    def test_snakemake(self):
        for i in range(6):
            shutil.copy(ROOT / "data/meshes/plate_8cm.obj", self.folder / f"plate {i}.obj")
        command = ["snakemake", "-j2", "--rerun-incomplete", "--nolock", "--quiet", "all", "-s", RECIPES / "Snakefile"]
        options = {"env": {**ENVIRONMENT, "XDG_CACHE_HOME": str(self.folder)}, "cwd": self.folder, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        made = lambda: sorted(self.folder.glob("*.ambient"))  # noqa: E731
        self.assertTrue(kill_after(command, lambda: len(made()) >= 2, **options))
        self.assertLess(len(made()), 6)
        subprocess.run(command, check=True, **options)
        self.assertEqual(len(made()), 6)
        stamps = [file.stat().st_mtime_ns for file in made()]
        shutil.copy(ROOT / "data/meshes/plate_9cm.obj", self.folder / "plate 3.obj")
        subprocess.run(command, check=True, **options)
        changed = [file.name for file, stamp in zip(made(), stamps) if file.stat().st_mtime_ns != stamp]
        self.assertEqual(changed, ["plate 3.ambient"])

    @unittest.skipUnless(has("distributed") and has("bullet_ambient"), "dask.distributed or the module is not there")
    def test_dask(self):
        command = [sys.executable, RECIPES / "with_dask.py", self.cases, self.out]
        process = subprocess.Popen(command, env=ENVIRONMENT, cwd=self.folder, stderr=subprocess.DEVNULL)
        while process.poll() is None and done(self.out) < CASES // 3:
            time.sleep(0.002)
        workers = [pid for pid in children(process.pid) if named(pid, "spawn_main")]
        self.assertEqual(len(workers), 2)
        os.kill(workers[0], signal.SIGKILL)
        self.assertLess(done(self.out), CASES)
        self.assertEqual(process.wait(), 0)
        self.assertResultsAreRight()


if __name__ == "__main__":
    unittest.main()
