#!/usr/bin/python3
"""Cases of a file: what a line may be, keys, shards, failures, the table, and the command line."""

import json
import math
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import bullet_ambient as ba
from bullet_ambient.cases import failed_file, write_table
from bullet_ambient.sweeps import _COLUMNS, _rows
from sweep_cases import SWEEP

BALL = {"name": "ball", "mass": 0.43, "position": [0, 0, 1], "shape": {"type": "sphere", "radius": 0.11, "faces": 80}}
FLIGHT = {"duration": 0.1, "time_step": 0.01, "output_step": 0.05, "bodies": [{**BALL, "linear_velocity": [30, 0, 0]}]}
TORN = {"bodies.0.linear_velocity": [1e200, 0, 0]}


def line(scene=FLIGHT, **changes):
    return json.dumps({"scene": scene, "set": {path.replace("__", "."): value for path, value in changes.items()}})


class Cases(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.cases, self.out = self.folder / "cases.jsonl", self.folder / "out"

    def write(self, *lines):
        self.cases.write_text("\n".join(lines) + "\n")

    def write_masses(self, *masses):
        self.write(*(line(bodies__0__mass=mass) for mass in masses))

    def run_cases(self, out="out", **more):
        return ba.run_cases(self.cases, self.folder / out, **more)

    def results(self, out="out"):
        """Contents of all result files by path, without run times."""
        contents = {}
        for file in (self.folder / out).glob("*/*"):
            if file.parent.name != "fluid_bodies":
                text = file.read_text()
                if file.name == "summary.json":
                    text = {**json.loads(text), "wall_seconds_simulation": 0}
                contents[str(file.relative_to(self.folder / out))] = text
        return contents


class FileTest(Cases):
    def complaint(self, text):
        self.write("", text)
        counts = self.run_cases()
        self.assertEqual((counts.cases, list(counts.failures)), (1, [0]))
        start = f"{self.cases}:2: "
        self.assertTrue(counts.failures[0].startswith(start), counts.failures[0])
        return counts.failures[0][len(start):]

    def test_what_is_no_case_is_refused(self):
        self.assertEqual(self.complaint("[]"), "a case must be an object")
        self.assertEqual(self.complaint('{"set": {}}'), '"scene" is missing')
        self.assertEqual(self.complaint('{"scene": 3}'), '"scene" must be a name, a path or a scene')
        self.assertEqual(self.complaint('{"scene": "plate_8cm", "set": []}'), '"set" must be an object of paths and values')
        unknown = 'unknown key "sets" in a case, which has scene and set'
        self.assertEqual(self.complaint('{"scene": "plate_8cm", "sets": {}}'), unknown)
        self.assertIn("gone.json", self.complaint('{"scene": "gone.json"}'))
        self.assertIn("is not known", self.complaint('{"scene": "gone"}'))
        self.assertIn("is not valid JSON: Expecting", self.complaint('{"scene": '))
        self.assertIn('key "set" is given twice', self.complaint('{"scene": "plate_8cm", "set": {}, "set": {}}'))
        self.assertEqual("duration is nan; must be finite", self.complaint(line(duration=math.nan)))
        self.assertIn("bodies[0].mass is -1", self.complaint(line(bodies__0__mass=-1)))

    def test_bytes_that_are_no_text_are_a_fault_of_their_case_alone(self):
        no_text = line("\xff").encode().replace(b"\\u00ff", b"\xff")
        self.cases.write_bytes(b"\xef\xbb\xbf" + line().encode() + b"\r\n" + no_text)  # a mark of UTF-8 before the first
        self.assertEqual(list(self.run_cases().failures), [1])

    def test_a_scene_is_whole_a_path_from_the_file_or_a_name(self):
        (self.folder / "fall.json").write_text(json.dumps(FLIGHT))
        self.write(line(), line("fall.json"), line("plate_8cm", duration=0.02))
        self.assertEqual(self.run_cases().failures, {})
        names = {json.loads(file.read_text())["scene"] for file in self.out.glob("*/summary.json")}
        self.assertLessEqual({"plate_8cm"}, names)
        self.assertEqual(len(names), 2)  # the first two are one case
        self.assertEqual(ba.collect(self.cases, self.out)["case"].tolist(), [0, 1, 2])


class KeyTest(Cases):
    def key(self, changes=None):
        return ba.Scene(FLIGHT, changes or {}, folder=self.folder).key

    def test_a_key_is_of_what_the_run_depends_on(self):
        self.assertEqual(len(self.key()), 16)
        self.assertEqual(self.key({"bodies.0.mass": 0.43}), self.key())  # as it is
        self.assertEqual(self.key({"description": "a ball", "threads": 3}), self.key())
        self.assertEqual(self.key({"bodies.0.position": [0.0, 0.0, 1.0]}), self.key())
        self.assertNotEqual(self.key({"bodies.0.mass": 0.44}), self.key())

    def test_a_key_is_of_the_bytes_of_a_mesh(self):
        def key(text):
            (self.folder / "body.obj").write_text(text)
            return self.key({"bodies.0.shape": {"type": "mesh", "file": "body.obj"}})

        first = key("v 0 0 0\n")
        self.assertEqual(key("v 0 0 0\n"), first)
        self.assertNotEqual(key("v 0 0 1\n"), first)


class RunTest(Cases):
    def test_shards_make_the_results_of_the_whole(self):
        self.write_masses(0.1, 0.2, 0.3, 0.4, 0.5)
        self.assertEqual(self.run_cases("whole"), (5, 0, {}))
        self.assertEqual(self.run_cases(shard=(1, 2)).cases, 2)
        self.assertEqual(self.run_cases(shard=(0, 2)).cases, 3)
        self.assertEqual(len(self.results()), 5 * 3)
        self.assertEqual(self.results(), self.results("whole"))

    def test_what_is_done_is_not_run_again(self):
        self.write_masses(0.1, 0.2, 0.2)
        self.assertEqual(self.run_cases().done_before, 0)
        self.assertEqual(len(self.results()), 2 * 3)  # equal cases share one result
        told = []
        self.assertEqual(self.run_cases(progress=lambda *counts: told.append(counts)).done_before, 3)
        self.assertEqual(told, [(0, 0)])

    def test_a_result_without_a_whole_summary_is_made_again(self):
        self.write_masses(0.1, 0.2)
        self.run_cases()
        results = self.results()
        first, second = sorted(self.out.glob("*/summary.json"))
        first.unlink()
        second.write_text("garbage")
        (first.parent / "trajectory.csv").write_text("time,bo")
        (first.parent / ".torn.partial").write_text("{")
        self.assertEqual(ba.collect(self.cases, self.out).size, 0)
        self.assertEqual(self.run_cases().done_before, 0)
        self.assertEqual(self.results(), results)

    def test_failures_are_listed_until_they_are_mended(self):
        good = line(bodies__0__mass=0.2)
        self.write(good, json.dumps({"scene": FLIGHT, "set": TORN}), '{"scene": 1}')
        failures = self.run_cases().failures
        self.assertEqual(sorted(failures), [1, 2])
        self.assertIn("not finite", failures[1])
        listed = [json.loads(text) for text in failed_file(self.out).read_text().splitlines()]
        self.assertEqual(listed, [{"case": i, "error": failures[i]} for i in (1, 2)])
        self.assertTrue(failed_file(self.out).read_text().startswith('{"case":1,"error":"'))
        self.assertEqual(ba.collect(self.cases, self.out)["case"].tolist(), [0])
        self.write(good)
        self.assertEqual(self.run_cases().done_before, 1)
        self.assertFalse(failed_file(self.out).exists())

    def test_a_result_that_cannot_be_written_is_a_failure(self):
        self.write_masses(0.1)
        self.out.mkdir()
        (self.out / ba.Scene(FLIGHT, {"bodies.0.mass": 0.1}).key).write_text("in the way")
        self.assertEqual(list(self.run_cases().failures), [0])

    def test_the_summary_alone_may_be_kept(self):
        self.write_masses(0.1)
        self.run_cases(motion=False)
        self.assertEqual([Path(name).name for name in self.results()], ["summary.json"])


class TableTest(Cases):
    def test_a_table_has_the_order_of_the_file_and_the_overrides(self):
        self.write(line(bodies__0__mass=2), line(model="vacuum", bodies__0__mass=1))
        self.run_cases()
        table = ba.collect(self.cases, self.out)
        self.assertEqual(table.dtype.names[:6], ("case", "key", "bodies.0.mass", "model", "body", "mass"))
        self.assertEqual(table["bodies.0.mass"].tolist(), [2, 1])
        self.assertEqual(table["mass"].tolist(), [2, 1])
        self.assertEqual(table["model"].tolist(), ["", "vacuum"])
        self.assertAlmostEqual(table["end_position_x"][1], 3, delta=1e-12)  # vacuum: x = 30 t
        with self.assertRaises(NotADirectoryError):
            ba.collect(self.cases, self.folder / "elsewhere")

    def test_a_summary_has_a_place_for_every_column(self):
        end = {"time": 2, "position": [1, 2, 3], "orientation": [1, 0, 0, 0]}
        end |= {"linear_velocity": [4, 5, 6], "angular_velocity": [7, 8, 9]}
        body = {"name": "plate", "mass": 0.1, "end": end, "path": {"length": 11, "landing": None}}
        body["fall"] = {"mode": "flutter", "swings": 4}
        (row,) = _rows(json.dumps({"bodies": [body]}))
        row = dict(zip(_COLUMNS, row))
        self.assertEqual((row["body"], row["mode"], row["swings"]), ("plate", "flutter", 4.0))
        self.assertEqual((row["end_position_z"], row["end_angular_velocity_x"]), (3.0, 7.0))
        self.assertTrue(math.isnan(row["landing_time"]))
        self.assertTrue(math.isnan(row["substeps"]))

    def test_a_file_keeps_all_digits_and_quotes_commas(self):
        write_table(self.out, ["a", "b"], [[0.1, "plain"], [float("nan"), '[1,"x"]']])
        self.assertEqual(self.out.read_text(), 'a,b\n0.10000000000000001,plain\nnan,"[1,""x""]"\n')
        os.mkfifo(self.folder / "pipe")
        with self.assertRaises(OSError):
            write_table(self.folder / "pipe", ["a"], [])

    def test_what_is_neither_number_nor_word_is_json_without_spaces(self):
        self.write(line(medium={"viscosity": 0, "density": 1.5}))
        self.run_cases()
        self.assertEqual(ba.collect(self.cases, self.out)["medium"].tolist(), ['{"density":1.5,"viscosity":0}'])


class CommandTest(Cases):
    def sweep(self, *arguments):
        command = [*SWEEP, "--cases", self.cases, *arguments]
        return subprocess.run(command, capture_output=True, text=True, cwd=self.folder)

    def test_cases_are_run_and_collected(self):
        self.write(line(), json.dumps({"scene": FLIGHT, "set": TORN}))
        failed = self.sweep("--out", self.out)
        self.assertEqual(failed.returncode, 1)
        self.assertIn("2 cases, 0 done before, 2 run in ", failed.stdout)
        self.assertIn("bullet_ambient: 1 of 2 cases failed", failed.stderr)
        shard = self.sweep("--out", self.out, "--shard", "0/2", "--quiet")
        self.assertEqual((shard.returncode, shard.stdout, shard.stderr), (0, "", ""))
        table = self.folder / "table.csv"
        self.assertEqual(self.sweep("--out", self.out, "--collect", table, "--quiet").returncode, 0)
        self.assertTrue(table.read_text().startswith("case,key,body,mass,end_time,"))
        self.assertEqual(table.read_text().count("\n"), 2)

    def test_summaries_are_all_that_is_kept_where_asked_for(self):
        self.write(line())
        self.assertEqual(self.sweep("--out", self.out, "--summaries", "--quiet").returncode, 0)
        self.assertEqual([file.name for file in self.out.glob("*/*") if file.suffix != ".ambient"], ["summary.json"])

    def test_an_interrupt_says_so(self):
        for stop in (signal.SIGINT, signal.SIGTERM):
            out = self.folder / stop.name
            self.write(line(model="vacuum", duration=1e7, output_step=1e7))
            process = subprocess.Popen([*SWEEP, "--cases", self.cases, "--out", out], stderr=subprocess.PIPE, text=True)
            while not out.exists():
                time.sleep(0.01)
            time.sleep(0.3)
            process.send_signal(stop)
            self.assertEqual(process.communicate()[1], "bullet_ambient: interrupted\n")
            self.assertEqual(process.returncode, 1)
            self.assertEqual([file.name for file in out.glob("*/*") if file.suffix != ".ambient"], [])

    def test_bad_usage_exits_with_two(self):
        self.write(line())
        for arguments in ((), ("--out", "out", "--shard", "2/2"), ("--out", "out", "--shard", "1/2x"),
                          ("--out", "out", "--shard", "-1/2"), ("--out", "out", "plate_8cm"), ("--out", "out", "--threads", "-1")):
            result = self.sweep(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertTrue(result.stderr.startswith("bullet_ambient: "), result.stderr)
        self.assertEqual(self.sweep("--help").returncode, 0)
        self.cases.unlink()
        gone = self.sweep("--out", "out")
        self.assertEqual((gone.returncode, gone.stderr), (1, f"bullet_ambient: {self.cases}: no such file or directory\n"))


if __name__ == "__main__":
    unittest.main()
