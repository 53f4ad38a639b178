"""Programs that are tested from outside, and the files that they are given."""

import json
import math
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from types import SimpleNamespace


class ProgramTest(unittest.TestCase):
    """Runs a program, the first argument of the test, in a temporary folder. Its messages begin with its name."""

    program = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.begin = Path(self.program).name + ": "

    def path(self, name):
        return str(self.folder / name)

    def write(self, name, text):
        """Writes a file of text, bytes or JSON; returns its path."""
        text = text if isinstance(text, (str, bytes)) else json.dumps(text)
        Path(self.path(name)).write_bytes(text if isinstance(text, bytes) else text.encode())
        return self.path(name)

    def bytes_of(self, name):
        return Path(self.path(name)).read_bytes()

    def run_program(self, *arguments, interrupt_after=(), **more):
        """Returns status, output and errors without lines of progress, which long work prints; sends SIGINT after each
        of the delays [s], and then waits for the end."""
        words = [self.program, *map(str, arguments)]
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more) as process:
            for delay in interrupt_after:
                time.sleep(delay)
                process.send_signal(signal.SIGINT)
            output, errors = process.communicate()
        errors = re.sub(r"^(building |solving |.*: simulating).*, \d+ s\n", "", errors.decode(), flags=re.MULTILINE)
        return SimpleNamespace(status=process.returncode, output=output.decode(), errors=errors)

    def run_well(self, *arguments):
        result = self.run_program(*arguments)
        self.assertEqual(result.status, 0, result.errors)
        return result

    def result_of(self, *arguments):
        """The JSON that a program prints, without a word to standard error."""
        result = self.run_well(*arguments)
        self.assertEqual(result.errors, "")
        return json.loads(result.output)

    def refusal(self, *arguments, status=1):
        """The one line on standard error of bad input, or of bad usage (2), which prints nothing else and leaves no file."""
        before = sorted(self.folder.rglob("*"))
        result = self.run_program(*arguments)
        self.assertEqual((result.status, result.output), (status, ""), result.errors)
        self.assertEqual(result.errors.count("\n"), 1, result.errors)
        self.assertTrue(result.errors.startswith(self.begin), result.errors)
        self.assertEqual(sorted(self.folder.rglob("*")), before)
        return result.errors[len(self.begin):-1]

    def expect_message(self, message, expected):
        """In which "..." at the beginning or end of what is expected stands for any text."""
        words = expected.removeprefix("...").removesuffix("...")
        begins, ends = expected.startswith("..."), expected.endswith("...")
        self.assertIn(words, message)
        self.assertTrue(begins or message.startswith(words), message)
        self.assertTrue(ends or message.endswith(words), message)

    def expect_close(self, found, expected, tolerance):
        self.assertLessEqual(abs(found - expected), tolerance, f"{found}, not {expected}")


def main(options=()):
    """Runs the tests of a script whose first argument is a program, followed by the values of options."""
    ProgramTest.program = sys.argv.pop(1)
    for name in options:
        options[name] = sys.argv.pop(1)
    unittest.main()


# Meshes are lists of vertices and of triangles.


def obj_text(mesh):
    vertices, triangles = mesh
    return "".join("v %r %r %r\n" % tuple(map(float, v)) for v in vertices) + "".join(
        "f " + " ".join(str(i + 1) for i in t) + "\n" for t in triangles)


def grid(point, columns, rows):
    """Two triangles for each cell of a grid of points, counter-clockwise if columns run to the right and rows upwards."""
    vertices = [point(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            triangles += [(a, b, c), (a, c, d)]
    return vertices, triangles


def joined(*meshes):
    vertices, triangles = [], []
    for own, of_own in meshes:
        triangles += [tuple(i + len(vertices) for i in t) for t in of_own]
        vertices += own
    return vertices, triangles


def moved(mesh, by):
    return [tuple(x + d for x, d in zip(v, by)) for v in mesh[0]], mesh[1]


def inside_out(mesh):
    return mesh[0], [(a, c, b) for a, b, c in mesh[1]]


def sheet(x, y, cells):
    return grid(lambda s, t: ((s - 0.5) * x, (t - 0.5) * y, 0), cells, cells)


def box(half_sizes, cells=1):
    """A closed box with so many cells along each edge; its side at +z comes last."""
    numbers, vertices, triangles = {}, [], []
    for axis in range(3):
        for side in (-1, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3

            def point(s, t):
                place = [0, 0, 0]
                place[axis] = side * half_sizes[axis]
                place[u], place[v] = (2 * s - 1) * half_sizes[u], (2 * t - 1) * half_sizes[v]
                return tuple(place)

            own, of_own = grid(point, cells, cells)
            for corner in own:
                if corner not in numbers:
                    numbers[corner] = len(vertices)
                    vertices.append(corner)
            ordered = of_own if side > 0 else [(a, c, b) for a, b, c in of_own]
            triangles += [tuple(numbers[own[i]] for i in t) for t in ordered]
    return vertices, triangles


def cone(radius, height, sides):
    """A cone with its base at z = 0."""
    ring = [(radius * math.cos(2 * math.pi * i / sides), radius * math.sin(2 * math.pi * i / sides), 0) for i in range(sides)]
    around = [(i, (i + 1) % sides) for i in range(sides)]
    triangles = [t for i, j in around for t in ((i, j, sides), (j, i, sides + 1))]
    return ring + [(0, 0, height), (0, 0, 0)], triangles


# .ambient files, docs/file_format.md.

HEADER_SIZE = 32


def sealed(payload, like):
    """An .ambient file of this payload, its version that of another one."""
    checksum = 0xCBF29CE484222325
    for byte in payload:
        checksum = ((checksum ^ byte) * 0x100000001B3) % 2**64
    return like[:HEADER_SIZE - 16] + struct.pack("<QQ", len(payload), checksum) + payload


def without_fields(ambient, fields):
    """An .ambient file whose fluid body lacks some fields, numbered as in fluid_body.fbs."""
    payload = bytearray(ambient[HEADER_SIZE:])
    (root,) = struct.unpack_from("<I", payload)
    (back,) = struct.unpack_from("<i", payload, root)
    for field in fields:
        struct.pack_into("<H", payload, root - back + 4 + 2 * field, 0)
    return sealed(bytes(payload), ambient)
