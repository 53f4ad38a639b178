#!/usr/bin/python3
"""ambient_demo as a program: command_line_test.py PROGRAM FOLDER_OF_DATA HAS_PYTHON"""

import copy
import csv
import json
import os
import shutil
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "support"))

import programs
from programs import ProgramTest

BALL = {"duration": 0.1, "time_step": 0.01, "output_step": 0.05,
        "bodies": [{"name": "ball", "mass": 0.43, "shape": {"type": "sphere", "radius": 0.11, "faces": 80}}]}
OPTIONS = {"data": "", "has_python": ""}


class DemoTest(ProgramTest):
    def scene(self, shape=None, body={}, **changes):
        """Writes a scene of a small ball, or of another shape, with changes; returns its file."""
        scene = copy.deepcopy(BALL) | changes
        scene["bodies"][0] |= body | ({"shape": shape} if shape else {})
        return self.write("ball.json", scene)

    def expect_no_trace(self):
        self.assertEqual(os.listdir(self.folder), ["ball.json"])

    def read_rows(self, folder):
        with open(self.path(folder + "/trajectory.csv"), encoding="utf-8") as file:
            return list(csv.reader(file))

    def test_lists_its_scenes(self):
        result = self.run_well("--list")
        self.assertIn("plate_8cm ", result.output)
        self.assertEqual(result.errors, "")

    def test_writes_trajectory_summary_and_fluid_bodies(self):
        result = self.run_well(self.scene(), "--quiet", "--out", self.path("out"), "--set", "model=vacuum")
        self.assertEqual(result.output + result.errors, "")
        summary = json.loads(self.bytes_of("out/summary.json"))
        self.assertEqual((summary["scene"], summary["model"]), ("ball", "vacuum"))
        self.assertEqual(",".join(self.read_rows("out")[0]), "time,body,px,py,pz,qw,qx,qy,qz,wx,wy,wz,vx,vy,vz")
        shutil.rmtree(self.path("out/fluid_bodies"), ignore_errors=True)
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["geometry.json", "summary.json", "trajectory.csv"])

    def test_logs_what_the_fluid_does(self):
        scene = self.scene(water={"level": 100})
        self.run_well(scene, "--quiet", "--out", self.path("out"), "--log", "wrench,wet")
        rows = self.read_rows("out")
        self.assertEqual({len(row) for row in rows}, {15 + 7 * 6 + 8})
        last = dict(zip(rows[0], rows[-1]))
        self.expect_close(float(last["wet_share"]), 1, 1e-12)
        self.expect_close(float(last["buoyancy_fz"]) / (998 * 9.81 * float(last["wet_volume"])), 1, 0.02)
        self.assertEqual(float(last["region"]), 0)
        self.run_well(scene, "--quiet", "--out", self.path("plain"))
        self.assertEqual([row[:15] for row in rows], self.read_rows("plain"))
        self.assertEqual(self.refusal("sphere_fall", "--log", "wrench,colour", status=2),
                         '--log: "colour" is none of wrench, wet, holds')

    def test_the_same_scene_gives_the_same_bytes(self):
        scene = self.scene()
        for threads in (1, 3):
            self.run_well(scene, "--quiet", "--out", self.path(f"out{threads}"), "--set", f"threads={threads}")
        self.assertGreater(len(self.bytes_of("out1/trajectory.csv")), 100)
        self.assertEqual(self.bytes_of("out1/trajectory.csv"), self.bytes_of("out3/trajectory.csv"))

    def test_refuses_bad_scenes_and_leaves_no_files(self):
        out = "--out", self.path("a/b")
        coloured = self.refusal(self.scene(body={"colour": "red"}), *out)
        self.assertIn('ball.json: unknown key "colour" in bodies[0], which has ', coloured)
        scene = self.scene()
        for change, message in (("medium.density=-1", "medium.density is -1"),
                                ("bodies.0.weight=1", 'unknown key "weight" in bodies[0], which has added_mass_factor, angular_velocity, '),
                                ("bodies.0.linear_velocity=[1e200, 0, 0]", 'body "ball": its state is not finite at t = 0.01 s')):
            self.assertIn(message, self.refusal(scene, *out, "--quiet", "--set", change))
        self.assertIn("plate_8cm", self.refusal("no_such_scene"))

    def test_leaves_nothing_when_it_is_interrupted(self):
        # Nothing to solve: the run starts at once.
        result = self.run_program(self.scene(model="vacuum", duration=1e7), "--out", self.path("a"), interrupt_after=[3])
        self.assertEqual(result.status, 1)
        self.assertIn("interrupted", result.errors)
        self.expect_no_trace()

    def test_a_second_signal_ends_it_within_a_step_and_leaves_nothing(self):
        # Known added mass needs no solver; the run then is one step of a million substeps.
        egg = {"type": "ellipsoid", "semi_axes": [1, 0.6, 0.3], "faces": 20000}
        scene = self.scene(egg, integrator={"method": "symplectic_euler", "max_substeps": 1000000}, time_step=1e-3, duration=1e-3)
        self.assertLess(self.run_program(scene, "--out", self.path("a/b"), interrupt_after=[1.5, 1.5]).status, 0)
        self.expect_no_trace()

    def test_a_signal_while_a_flow_is_solved_leaves_nothing(self):
        bunny = {"type": "mesh", "file": OPTIONS["data"] + "/meshes/bunny.obj"}
        scene = self.scene(bunny, {"waterline_table": 4})  # minutes of flows
        self.assertLess(self.run_program(scene, "--out", self.path("a/b"), interrupt_after=[0.5]).status, 0)
        self.expect_no_trace()

    def test_escapes_in_names_do_not_reach_the_terminal(self):
        escape = "\033[2J\u009b2J"
        runs = [(1, ["no" + escape]), (2, ["plate_8cm", "--set", escape]), (2, ["plate_8cm", "--no" + escape]),
                (0, [self.scene(), "--out", self.path(escape), "--set", "model=vacuum"])]
        for status, arguments in runs:
            result = self.run_program(*arguments)
            self.assertEqual(result.status, status, result.errors)
            self.assertNotRegex(result.output + result.errors, "[\033\u0080-\u009f]")

    def test_says_that_its_folder_cannot_be_made_before_it_reads_a_mesh(self):
        scene = self.scene()
        mesh = "--set", 'bodies.0.shape={"type": "mesh", "file": "gone.obj"}'
        for out in (scene, scene + "/below"):
            self.expect_message(self.refusal(scene, "--out", out, *mesh), f"{out}: cannot be made: ...")
        os.mkdir(self.path("out"))
        os.symlink("/dev/null", self.path("out/summary.json"))
        self.assertIn("summary.json: is not a regular file", self.refusal(scene, "--out", self.path("out"), *mesh))

    def test_runs_cases_by_the_python_module(self):
        cases = self.write("cases.jsonl", {"scene": self.scene(), "set": {"duration": 0.1}})
        arguments = "--cases", cases, "--shard", "0/1", "--out", self.path("out")
        if OPTIONS["has_python"] == "1":
            self.run_well(*arguments)
            self.assertNotEqual(os.listdir(self.path("out")), [])
        else:
            self.assertIn("BULLET_AMBIENT_PYTHON=ON", self.refusal(*arguments))

    def test_bad_usage_exits_with_two(self):
        for arguments in ([], ["plate_8cm", "--no-such-option"], ["plate_8cm", "--set", "duration"], ["plate_8cm", "plate_9cm"],
                          ["plate_8cm", "--shard", "0/2"]):
            result = self.run_program(*arguments)
            self.assertEqual(result.status, 2)
            self.assertTrue(result.errors.startswith(self.begin), result.errors)
        self.run_well("--help")


if __name__ == "__main__":
    programs.main(OPTIONS)
