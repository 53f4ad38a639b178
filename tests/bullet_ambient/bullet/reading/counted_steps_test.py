"""A body whose wrench is not read pays nothing for it: its steps under valgrind's counter of instructions.
Usage: counted_steps_test.py PROGRAM"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop()


def counted(how):
    """Instructions of all steps, and the functions that they have called."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "counts")
        subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}",
                        "--toggle-collect=btDiscreteDynamicsWorld::stepSimulation(*)", PROGRAM, how],
                       check=True, capture_output=True)
        text = out.read_text()
    functions = set(re.findall(r"^c?fn=\(\d+\) (.+)$", text, re.MULTILINE))
    return int(re.search(r"^(?:totals|summary): (\d+)", text, re.MULTILINE)[1]), functions


def of_readings(functions):
    return {name for name in functions if re.search(r"(begin|finish)(Body)?Reading|readRows", name)}


class CountedSteps(unittest.TestCase):
    def test_what_is_not_read_costs_nothing(self):
        never, called = counted("unread")
        stopped, _ = counted("stopped")
        read, called_to_read = counted("read")
        self.assertEqual(of_readings(called), set())
        self.assertGreaterEqual(len(of_readings(called_to_read)), 2)
        self.assertLess(abs(stopped - never), 1e-3 * never)
        self.assertGreater(read, 1.1 * never)


if __name__ == "__main__":
    unittest.main()
