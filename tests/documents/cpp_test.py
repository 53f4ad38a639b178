#!/usr/bin/python3
"""Compiles the C++ of the pages, as a reader would paste it: cpp_test.py [COMPILER
--precision OPTION... [--precision OPTION...]]; by default with Debian's Bullet in float.

Each page is one source, in which every block is a function; a block sees what those above it include, and Bullet.
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from blocks import ROOT, all_blocks

COMPILERS = []
DEBIAN = ["c++", "-std=c++17", "-Wall", "-Wextra", "-Werror", f"-I{ROOT}", "-isystem/usr/include/bullet", "-isystem/usr/include/eigen3",
          "-DBULLET_AMBIENT_FLOAT64=0"]
INCLUDE = re.compile(r"^#include .*$", re.MULTILINE)


def source_of(blocks):
    parts = ["#include <btBulletDynamicsCommon.h>\n"]
    for block in blocks:
        place = f'#line {block.line} "{block.page.relative_to(ROOT)}"\n'
        includes = "\n".join(INCLUDE.findall(block.text))
        parameters = block.notes.get("given", "")
        body = place + INCLUDE.sub("", block.text)
        parts.append(f"{place}{includes}\nvoid block_{block.line}({parameters});\nvoid block_{block.line}({parameters}) {{\n{body}}}\n")
    return "".join(parts)


class CppTest(unittest.TestCase):
    def test_every_block_compiles(self):
        blocks = all_blocks("cpp")
        self.assertTrue(blocks)
        with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
            sources = []
            for page in dict.fromkeys(block.page for block in blocks):
                sources.append(Path(folder) / f"{page.stem}.cpp")
                sources[-1].write_text(source_of([block for block in blocks if block.page == page and "not run" not in block.notes]))
            commands = [[*compiler, "-fsyntax-only", source] for source in sources for compiler in COMPILERS]
            runs = pool.map(lambda command: subprocess.run(command, capture_output=True, text=True), commands)
            for command, run in zip(commands, runs):
                with self.subTest(page=command[-1].name):
                    self.assertEqual(run.returncode, 0, run.stderr)


if __name__ == "__main__":
    for argument in sys.argv[2:]:
        if argument == "--precision":
            COMPILERS.append([sys.argv[1]])
        else:
            COMPILERS[-1].append(argument)
    COMPILERS = COMPILERS or [DEBIAN]
    unittest.main(argv=sys.argv[:1])
