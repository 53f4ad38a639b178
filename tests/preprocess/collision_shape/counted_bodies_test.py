"""What it takes to choose the few faces of a fluid body, by valgrind's counter of instructions.
Usage: counted_bodies_test.py PROGRAM"""
import os
import re
import subprocess
import sys
import unittest

PROGRAM = sys.argv.pop()
KERNELS = {"BULLET_AMBIENT_KERNELS": "avx2"}  # whatever the processor: valgrind knows no AVX-512


def counted(function):
    run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", f"--toggle-collect={function}",
                          PROGRAM], check=True, capture_output=True, text=True, env={**os.environ, **KERNELS})
    return int(re.search(r"Collected\s*:\s+(\d+)", run.stderr)[1])


class CountedBodies(unittest.TestCase):
    def test_few_faces_are_soon_chosen(self):
        self.assertLess(counted("ambient::smallestFormLevel(*)"), 1.1 * 8.79e8)


if __name__ == "__main__":
    unittest.main()
