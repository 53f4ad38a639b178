#!/usr/bin/python3
"""What the scripts of demos/plot and demos/page say of files that are missing or of another kind, and what
experiments.py keeps of the page that it rewrites."""

import runpy
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[3]
FOLDERS = ("demos/plot", "demos/page", "tests/study/reality", "tests/study/precision")
sys.path += [str(ROOT / folder) for folder in FOLDERS]

from experiments import Page, add_studies

RUNS = ("demos/plot/plot_runs.py", "demos/page/make_page.py")
TABLES = (
    "demos/plot/plot_polar.py",
    "tests/study/precision/plot_added_mass_cost.py",
    "tests/study/precision/plot_work_precision.py",
    "tests/study/stability/plot_atlas.py",
)
WORK_PRECISION = "case,method,microseconds_per_second,position_error\nplate,fast,10,0.1\n"


class ScriptsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def refusal(self, script, *arguments):
        """What a script that is run with these arguments ends with."""
        with mock.patch.object(sys, "argv", [script, *map(str, arguments)]), self.assertRaises(SystemExit) as end:
            runpy.run_path(str(ROOT / script), run_name="__main__")
        self.assertNotIn("\n", end.exception.code)
        return end.exception.code

    def write(self, name, text):
        file = self.folder / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        return file

    def test_missing_files_are_named(self):
        missing = self.folder / "nosuch"
        for script in RUNS:
            text = self.refusal(script, missing, "-o", self.folder / "out")
            self.assertEqual(text, f"{missing}/summary.json: No such file or directory")
        for script in TABLES:
            text = self.refusal(script, missing, "-o", self.folder / "out.png")
            self.assertEqual(text, f"{missing}: No such file or directory")

    def test_files_of_another_kind_are_named(self):
        other = self.write("other.csv", "a,b\n1,2\n")
        for script in TABLES:
            text = self.refusal(script, other, "-o", self.folder / "out.png")
            self.assertRegex(text, f"^{other}: is not a table of [a-z_]+")
        for name in ("summary.json", "geometry.json"):
            self.write(f"run/{name}", "{}")
        self.write("run/trajectory.csv", "")
        for script in RUNS:
            text = self.refusal(script, self.folder / "run", "-o", self.folder / "out")
            self.assertEqual(text, f"{self.folder / 'run'}: is not a folder of results of ambient_demo")

    def test_missing_measurements_and_results_are_named(self):
        measurements = ROOT / "data/reality/measurements.json"
        for arguments, missing in (
            ((self.folder / "nosuch", self.folder), self.folder / "nosuch"),
            ((measurements, self.folder), self.folder / "curves.csv"),
        ):
            text = self.refusal("tests/study/reality/plot_reality.py", *arguments, "-o", self.folder)
            self.assertEqual(text, f"{missing}: No such file or directory")

    def test_unwritable_pictures_are_named(self):
        table = self.write("table.csv", WORK_PRECISION)
        picture = self.folder / "nosuch" / "out.png"
        text = self.refusal("tests/study/precision/plot_work_precision.py", table, "-o", picture)
        self.assertEqual(text, f"{picture}: cannot be written: No such file or directory")
        picture = self.folder / "out.nokind"
        text = self.refusal("tests/study/precision/plot_work_precision.py", table, "-o", picture)
        self.assertRegex(text, f"^{picture}: cannot be written: ")

    def test_sections_without_new_data_stay(self):
        kept = "## Convergence\n\ntext\n\n| a |\n|---|\n| 1 |\n\n### More\n\ntext"
        self.write("experiments.md", f"# Experiments\n\n## Contacts\n\ngone\n\n{kept}\n\n## Last\n\ngone\n")
        page = Page(self.folder)
        add_studies(page, self.folder)
        page.write()
        self.assertEqual(page.file.read_text(), f"{kept}\n")


if __name__ == "__main__":
    unittest.main()
