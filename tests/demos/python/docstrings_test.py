#!/usr/bin/python3
"""Runs the examples in the docstrings of the module, and checks that everything public has a docstring."""

import contextlib
import doctest
import os
import tempfile
import unittest
from pathlib import Path

import numpy as np

import bullet_ambient as ba

ROOT = Path(__file__).resolve().parents[3]


def documented():
    """Names and docstrings of what the module offers."""
    for name in ba.__all__:
        thing = getattr(ba, name)
        if not callable(thing):
            continue
        yield name, thing.__doc__
        if isinstance(thing, type):
            for part, value in vars(thing).items():
                if not part.startswith("_"):
                    yield f"{name}.{part}", getattr(value, "__func__", value).__doc__


class DocstringsTest(unittest.TestCase):
    def test_everything_has_one(self):
        for name, text in documented():
            if name not in ("Rollout.motion", "Rollout.summary", "Rollout.errors") and not name.startswith("CaseCounts."):
                self.assertTrue(text and len(text.split()) > 0, name)

    def test_examples_are_true(self):
        runner, parser = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS), doctest.DocTestParser()
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            os.symlink(ROOT / "data", "data")
            for name, text in documented():
                runner.run(parser.get_doctest(text or "", {**vars(ba), "np": np}, name, None, 0))
        self.assertEqual(runner.failures, 0)
        self.assertGreaterEqual(runner.tries, 8)


if __name__ == "__main__":
    unittest.main()
