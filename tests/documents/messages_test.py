#!/usr/bin/python3
"""Looks for the messages of docs/troubleshooting.md in the sources: for all between their placeholders, `...` and single
capitals, in one file. Words in italics are of other programs."""

import re
import unittest
from functools import cache

from blocks import ROOT

PAGE = ROOT / "docs/troubleshooting.md"
SOURCES = [f"{box}/**/*.{kind}" for box in ("bullet_ambient", "preprocess", "demos") for kind in ("h", "cpp", "cmake")]


@cache
def sources():
    """Of each source its text, with literals that stand side by side joined."""
    files = [file for pattern in SOURCES for file in ROOT.glob(pattern)]
    return [re.sub(r'"\s*\n?\s*"', "", file.read_text()).replace('\\"', '"') for file in files]


def messages():
    rows = re.findall(r"^\| (.*?) \|", PAGE.read_text(), re.MULTILINE)
    return [row for row in rows if row != "message"]


def parts_of(message):
    parts = re.split(r"\.\.\.|\b[A-Z]\b|\*.*?\*", message)
    return [part.strip(" ,:()") for part in parts if part.strip(" ,:()")]


class MessagesTest(unittest.TestCase):
    def test_every_message_is_one_of_the_library(self):
        self.assertTrue(messages())
        for message in messages():
            with self.subTest(message=message):
                parts = parts_of(message)
                self.assertTrue(any(all(part in text for part in parts) for text in sources()), parts)


if __name__ == "__main__":
    unittest.main()
