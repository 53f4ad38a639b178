#!/usr/bin/python3
"""Compiles the C++ of the pages, as a reader would paste it: cpp_test.py COMPILER
--precision OPTION... [--precision OPTION...]

Each page is one source, in which every block is a function; a block sees what those above it include, and Bullet.
"""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from blocks import ROOT, all_blocks

COMPILERS = []
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
        with tempfile.TemporaryDirectory() as folder:
            for page in dict.fromkeys(block.page for block in blocks):
                source = Path(folder) / f"{page.stem}.cpp"
                source.write_text(source_of([block for block in blocks if block.page == page and "not run" not in block.notes]))
                for compiler in COMPILERS:
                    with self.subTest(page=page.name):
                        run = subprocess.run([*compiler, "-fsyntax-only", source], capture_output=True, text=True)
                        self.assertEqual(run.returncode, 0, run.stderr)


if __name__ == "__main__":
    for argument in sys.argv[2:]:
        if argument == "--precision":
            COMPILERS.append([sys.argv[1]])
        else:
            COMPILERS[-1].append(argument)
    unittest.main(argv=sys.argv[:1])
