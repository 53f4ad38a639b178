#!/usr/bin/python3
"""Runs the Python of each page as one program, and reads its scenes, by the module."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import bullet_ambient as ba
from blocks import ROOT, all_blocks


class PythonTest(unittest.TestCase):
    def test_the_blocks_of_a_page_run_in_turn(self):
        blocks = [block for block in all_blocks("python") if "not run" not in block.notes]
        for page in dict.fromkeys(block.page for block in blocks):
            program = ""
            for block in blocks:
                if block.page == page:
                    # Blank lines put a line of the program where the page has it.
                    given = block.notes.get("given", "")
                    program += given + "\n" * (block.line - 1 - (program + given).count("\n")) + block.text
            with self.subTest(page=page.name), tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / f"{page.stem}.py"
                file.write_text(program)
                run = subprocess.run([sys.executable, file], cwd=folder, capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, f"{page.relative_to(ROOT)}:\n{run.stderr}")

    def test_scenes_are_read(self):
        for block in all_blocks("json"):
            if "not run" not in block.notes:
                with self.subTest(block=str(block)):
                    self.assertGreater(ba.Scene(json.loads(block.text)).duration, 0)


if __name__ == "__main__":
    unittest.main()
