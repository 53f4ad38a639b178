#!/usr/bin/python3
"""Numbers that a page repeats are those of the table that has them."""

import re
import unittest

from blocks import ROOT


def text_of(page):
    return re.sub(r"\s+", " ", (ROOT / page).read_text())


def rows_below(page, heading):
    """Cells of the first table below a heading, without its head."""
    section = re.search(rf"^#+ {re.escape(heading)}\n(.*)", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)[1]
    table = re.search(r"^\|.*?(?=^[^|]|\Z|^$)", section, re.MULTILINE | re.DOTALL)[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()[2:]]


def percent(cell):
    return float(cell.removesuffix(" %"))


class ReadmeTest(unittest.TestCase):
    def numbers(self, pattern):
        return [float(number) for number in re.search(pattern, text_of("README.md")).groups()]

    def test_cost_of_bullets_examples(self):
        rows = rows_below("docs/existing_scenes.md", "Bullet's own examples")
        ratios = [float(row[8]) for row in rows if row[0].startswith(("Basic", "Benchmark"))]
        self.assertEqual(self.numbers(r"\[([\d.]+) to ([\d.]+) times\]"), [round(min(ratios), 1), round(max(ratios), 1)])
        self.assertEqual(self.numbers(r"(\d+) of Bullet's own examples"), [sum(row[7] == "yes" for row in rows)])

    def test_error_of_simple_shapes(self):
        errors = [percent(cell) for row in rows_below("docs/accuracy.md", "Tables") for cell in row[1:3]]
        self.assertEqual(self.numbers(r"simple shapes within ([\d.]+) %"), [max(errors)])

    def test_runs_whose_energy_never_rises(self):
        text = (ROOT / "docs/stability.md").read_text()
        rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith(("| free |", "| falling |"))]
        self.assertEqual([row[4] for row in rows], ["0", "0"])
        self.assertAlmostEqual(self.numbers(r"\[(\d+) runs\]")[0], sum(int(row[1]) for row in rows), delta=50)

    def test_form_law(self):
        rows = {row[0]: row for row in rows_below("docs/reality.md", "Sums")}
        everything = rows["all coefficients"]
        self.assertEqual(self.numbers(r"over \[(\d+) measured"), [float(everything[1])])
        off = self.numbers(r"off by ([\d.]+) \(rms of the logarithm\) where the published one is by ([\d.]+)")
        self.assertEqual(off, [float(everything[3]), float(everything[2])])
        shares = re.search(r"(\d+) % of runs by the published law and (\d+) % by the form law", text_of("docs/reality.md"))
        right = self.numbers(r"has (\d+) % of \d+ regimes of falling right, where the published one has (\d+) %")
        self.assertEqual(right, [float(shares[2]), float(shares[1])])


class ExperimentsTest(unittest.TestCase):
    def test_the_convergence_is_that_of_the_same_runs(self):
        page = "docs/experiments.md"
        carries = {row[0]: row[2] for row in rows_below(page, "Convergence") if row[1] == "carry"}
        shown = {row[0].removesuffix(", carry"): row[2] for row in rows_below(page, "The paper's experiments") if row[0].endswith("carry")}
        self.assertEqual(carries, shown)


if __name__ == "__main__":
    unittest.main()
