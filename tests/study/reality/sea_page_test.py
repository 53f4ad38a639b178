#!/usr/bin/python3
"""docs/reality_at_sea.md is what the program makes now: sea_page_test.py REALITY."""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path += [str(ROOT / "tests/study/reality"), str(ROOT / "demos/plot")]
sys.dont_write_bytecode = True

import matplotlib

matplotlib.use("Agg")

import sea_page
from reality_numbers import Sea

PAGE = ROOT / "docs/reality_at_sea.md"
DATA = ROOT / "data/reality/measurements_at_sea.json"
NUMBER = r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?"


class PageTest(unittest.TestCase):
    program = ""

    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([cls.program, DATA, "--out", folder], check=True, stdout=subprocess.DEVNULL)
            (Path(folder) / "images").mkdir()
            sea_page.write(Sea(DATA, Path(folder)), Path(folder))
            cls.made = (Path(folder) / PAGE.name).read_text(encoding="utf-8")

    def test_words_are_those_of_the_program(self):
        bare = [re.sub(NUMBER, "#", text) for text in (PAGE.read_text(encoding="utf-8"), self.made)]
        self.assertEqual(*bare)

    def test_numbers_are_those_of_the_library(self):
        shown, made = (re.findall(NUMBER, text) for text in (PAGE.read_text(encoding="utf-8"), self.made))
        for number, now in zip(shown, made):
            # One unit of the last digit.
            digit = 10.0 ** -len(number.partition(".")[2]) if "e" not in number else abs(float(number)) / 100
            self.assertAlmostEqual(float(number), float(now), delta=1.01 * digit)


if __name__ == "__main__":
    PageTest.program = sys.argv.pop()
    unittest.main()
