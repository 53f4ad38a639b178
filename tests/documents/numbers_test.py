#!/usr/bin/python3
"""Numbers that a page repeats are those of the table that has them."""

import re
import unittest

from blocks import ROOT


def rows_below(page, heading):
    """Cells of the first table below a heading, without its head."""
    section = re.search(rf"^#+ {re.escape(heading)}\n(.*)", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)[1]
    table = re.search(r"^\|.*?(?=^[^|]|\Z|^$)", section, re.MULTILINE | re.DOTALL)[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()[2:]]


class ExperimentsTest(unittest.TestCase):
    def test_the_convergence_is_that_of_the_same_runs(self):
        page = "docs/experiments.md"
        carries = {row[0]: row[2] for row in rows_below(page, "Convergence") if row[1] == "carry"}
        shown = {row[0].removesuffix(", carry"): row[2] for row in rows_below(page, "The paper's experiments") if row[0].endswith("carry")}
        self.assertEqual(carries, shown)


if __name__ == "__main__":
    unittest.main()
