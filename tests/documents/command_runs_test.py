#!/usr/bin/python3
"""Runs the commands of the pages: command_runs_test.py BUILD_DIR

The blocks of a page run one after the other in one folder, which looks like the checkout after a build.
"""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from blocks import COMMANDS, ROOT, all_blocks

BUILD = None


class CommandRunTest(unittest.TestCase):
    def test_the_other_commands_run(self):
        runs = [block for block in all_blocks(COMMANDS) if not block.notes.keys() & {"not run", "usage"}]
        for page in dict.fromkeys(block.page for block in runs):
            self.run_in_turn([block for block in runs if block.page == page])

    def run_in_turn(self, blocks):
        with tempfile.TemporaryDirectory() as folder:
            options = {"cwd": folder, "env": make_checkout(Path(folder)), "capture_output": True, "text": True}
            for block in blocks:
                with self.subTest(block=str(block)):
                    shown, _, quicker = block.notes.get("quicker", "").partition(" -> ")
                    self.assertIn(shown, block.text)
                    script = f"{block.notes.get('given', '')}\n{block.text.replace(shown, quicker) if shown else block.text}"
                    run = subprocess.run(["bash", "-euo", "pipefail", "-c", script], **options)
                    self.assertEqual(run.returncode, 0, run.stderr)


def make_checkout(folder):
    """Makes the folder look like the checkout after a build; returns the environment of commands."""
    for file in ROOT.iterdir():
        if file.name not in ("build", "docs", "out", ".git"):
            (folder / file.name).symlink_to(file)
    (folder / "build").mkdir()
    (folder / "build/release").symlink_to(BUILD)
    path = f"{BUILD / 'bin'}:{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "PYTHONPATH": str(BUILD / "python"), "MPLCONFIGDIR": str(folder / "build")}


if __name__ == "__main__":
    BUILD = Path(sys.argv.pop(1)).resolve()
    unittest.main()
