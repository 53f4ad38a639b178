#!/usr/bin/python3
"""ambient_preprocess as a program: exit codes, standard output and standard error, files: command_line_test.py PROGRAM"""

import json
import math
import os
import re
import resource
import struct
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "support"))

import programs
from programs import ProgramTest, box, cone, inside_out, joined, moved, obj_text, sheet

BALL = {"type": "sphere", "radius": 0.5, "faces": 320}
TETRAHEDRON = ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
OPEN = (TETRAHEDRON[0], TETRAHEDRON[1][1:])
CUBE = box((1, 1, 1))
LIDLESS = (CUBE[0], CUBE[1][:-2])
FORM, VISCOUS = 18, 19  # fields of fluid_body.fbs


class CommandTest(ProgramTest):
    def expect_refusals(self, group, arguments, status=2):
        """Expects the messages of a group of refusals.json about options after these arguments."""
        for more, message in json.loads(Path(__file__).with_name("refusals.json").read_text())[group]:
            with self.subTest(more):
                self.expect_message(self.refusal(*arguments, *more, status=status), message)

    def build_arguments(self, source, *more):
        return "build", source, "-o", self.path("out.ambient"), *more

    def build_refusal(self, source, *more):
        return self.refusal(*self.build_arguments(source, *more))

    def build(self, source, name="out.ambient", *more):
        """Builds a JSON shape or the text of a mesh without solving more than its faces; returns its facts, and the file."""
        source = self.write("in." + ("json" if isinstance(source, dict) else "obj"), source)
        result = self.run_well("build", source, "-o", self.path(name), "--panels", "0", "--json", *more)
        return json.loads(result.output), self.path(name)


class UsageTest(CommandTest):
    def test_bad_usage_ends_with_two(self):
        ball = self.write("ball.json", BALL)
        loads = "loads", "x.ambient", "--density", "1", "--twist", "1", "2", "3", "4", "5"
        build = self.build_arguments(ball)
        for arguments in ([], ["bild"], ["build"], ["build", ball], build[:3], [*build, "--scael", "1"],
                          [*build, "--scale", "large"], [*build, "--threads", "1.5"], ["build", ball, *build[1:]],
                          [*build, "--threads", "99999999999999999999"], [*build, "--levels", "16,x"], ["inspect"],
                          [*build, "--opening", "0", "0", "0.1"], [*build, "--opening", *"00010x1"],
                          [*build, "--opening", *"00010012"], [*build, "--opening", *"0001001", "--opening", *"00"],
                          ["inspect", ball, "--jsn"], ["check", ball, "--panels", "many"], ["polar"],
                          ["polar", ball, "--speed", "fast"], loads[:2], loads[:4], loads, [*loads, "six"]):
            with self.subTest(arguments):
                result = self.run_program(*arguments)
                self.assertEqual((result.status, result.output), (2, ""), result.errors)
                self.assertTrue(result.errors.startswith(self.begin), result.errors)
                self.assertEqual(os.listdir(self.folder), ["ball.json"])

    def test_empty_arguments_are_not_zero(self):
        empty = "loads", "x.ambient", "--density", "", "--twist", 0, 0, 0, 1, 0, 0
        self.assertEqual(self.refusal(*empty, status=2), "argument 4 is empty")
        self.assertEqual(self.refusal("inspect", "", status=2), "argument 2 is empty")

    def test_mistyped_commands_are_corrected(self):
        for word, advice in (("bild", "did you mean 'build'?"), ("inpsect", "did you mean 'inspect'?"),
                             ("something", "--help lists them")):
            self.assertEqual(self.refusal(word, status=2), f"unknown command '{word}'; {advice}")

    def test_help_and_version_end_with_zero(self):
        for arguments in (["--help"], ["build", "--help"], ["--version"]):
            result = self.run_well(*arguments)
            self.assertNotEqual(result.output, "")
            self.assertEqual(result.errors, "")

    def test_bad_values_of_options_are_refused_by_name(self):
        self.expect_refusals("options of build", self.build_arguments(self.write("ball.json", BALL)))
        self.expect_refusals("options of build with a mesh", self.build_arguments(self.write("box.obj", obj_text(CUBE))))
        _, file = self.build(BALL, "ball.ambient")
        self.expect_refusals("options of loads", ["loads", file])
        self.expect_refusals("options of polar", ["polar", file])
        self.expect_refusals("options of export", ["export", file, "-o", self.path("out.x")])

    def test_escapes_in_names_do_not_reach_the_terminal(self):
        escape = "\033[2J\u009b2J\n"
        mesh = self.write(escape + ".obj", obj_text(inside_out(TETRAHEDRON)))
        ambient = self.path(escape + ".ambient")
        build = "build", mesh, "-o", ambient, "--panels", "100"
        for arguments in (build, build,  # which keeps the file
                          ["inspect", ambient], ["check", mesh, "--estimate", "--panels", "100"],
                          ["inspect", self.path(escape)], [escape], ["inspect", "--" + escape],
                          ["build", self.path(escape + ".bullet"), "-o", self.path("folder")]):
            result = self.run_program(*arguments)
            self.assertNotEqual(result.output + result.errors, "")
            self.assertNotRegex(result.output + result.errors, "[\033\u0080-\u009f]")


class FilesTest(CommandTest):
    """Output files: places, links, names, and existing files there."""

    def test_build_replaces_the_output_at_once_or_not_at_all(self):
        self.write("out.ambient", "something older")
        opened = self.write("open.obj", obj_text(OPEN))
        self.refusal(*self.build_arguments(opened, "--strict"))
        self.assertEqual(self.bytes_of("out.ambient"), b"something older")
        self.result_of(*self.build_arguments(self.write("ball.json", BALL), "--json"))
        self.assertEqual(self.result_of("inspect", self.path("out.ambient"), "--json")["name"], "ball")
        self.assertEqual(len(os.listdir(self.folder)), 3)

    def test_what_is_no_fluid_body_is_not_replaced(self):
        ball, other = self.write("ball.json", BALL), self.write("other.obj", obj_text(TETRAHEDRON))
        self.assertEqual(self.refusal("build", ball, "-o", other), other + ": not a .ambient file: it does not begin "
                         "with the mark of one, and is not replaced")
        self.assertEqual(self.bytes_of("other.obj").decode(), obj_text(TETRAHEDRON))
        self.write("ball.body", "")
        for scale in (1, 2):  # an empty file, then another name
            self.result_of("build", ball, "-o", self.path("ball.body"), "--json", "--scale", scale)

    def test_symbolic_links_are_written_through(self):
        ball, out = self.write("ball.json", BALL), Path(self.path("out.ambient"))
        inner = self.folder / "inner"
        inner.mkdir()
        out.symlink_to("inner/first")
        (inner / "first").symlink_to(inner / "ball.ambient")
        for scale in (1, 2):  # missing target, then existing target
            volume = self.result_of("build", ball, "-o", out, "--json", "--scale", scale)["volume"]
            self.assertTrue(out.is_symlink() and (inner / "first").is_symlink())
            self.assertFalse((inner / "ball.ambient").is_symlink())
            self.assertEqual(self.result_of("inspect", inner / "ball.ambient", "--json")["volume"], volume)
        lost = self.folder / "lost.ambient"
        lost.symlink_to("nowhere/ball.ambient")
        self.assertEqual(self.refusal("build", ball, "-o", lost),
                         f'{lost}: the directory "{self.path("nowhere")}" does not exist')

    def test_names_may_be_as_long_as_the_system_has_them(self):
        ball, name = self.write("ball.json", BALL), "x" * (255 - len(".ambient")) + ".ambient"
        self.result_of("build", ball, "-o", self.path(name), "--json")
        self.assertEqual(self.refusal("build", ball, "-o", self.path("x" + name)),
                         self.path("x" + name) + ": cannot be written: File name too long")

    def test_places_that_cannot_be_written_are_refused(self):
        ball, nowhere = self.write("ball.json", BALL), self.path("no folder/out.ambient")
        self.assertEqual(self.refusal("build", ball, "-o", nowhere),
                         f'{nowhere}: the directory "{self.path("no folder")}" does not exist')
        self.assertEqual(self.refusal("build", ball, "-o", ball), ball + ": the output would replace the input")
        self.assertEqual(json.loads(self.bytes_of("ball.json")), BALL)

    def test_a_limit_of_the_file_size_leaves_nothing(self):
        ball = self.write("ball.json", BALL)
        result = self.run_program(*self.build_arguments(ball),
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
        self.assertEqual(result.status, 1)
        self.assertEqual(result.errors, f"{self.begin}{self.path('out.ambient')}: cannot be written: File too large\n")
        self.assertEqual(os.listdir(self.folder), ["ball.json"])

    def test_interrupted_builds_leave_nothing(self):
        # Work of some seconds, interrupted early and late.
        source = self.write("box.json", {"type": "box", "size": [1, 2, 3]})
        for delay in (0.005, 0.15):
            result = self.run_program(*self.build_arguments(source, "--no-tables", "--panels", "8000"), interrupt_after=[delay])
            self.assertLess(result.status, 0)
            self.assertEqual(os.listdir(self.folder), ["box.json"])

    def test_build_keeps_a_file_that_is_still_right(self):
        build = self.build_arguments(self.write("ball.json", BALL), "--json")
        built = self.result_of(*build)
        time = os.stat(self.path("out.ambient")).st_mtime_ns
        kept = self.result_of(*build)
        self.assertEqual(os.stat(self.path("out.ambient")).st_mtime_ns, time)
        self.assertEqual({**kept, "seconds": 0}, {**built, "seconds": 0})
        self.write("ball.json", {**BALL, "radius": 0.6})
        self.assertGreater(self.result_of(*build)["volume"], 1.5 * built["volume"])

    def test_bad_ambient_files_are_refused_by_what_reads_them(self):
        _, file = self.build(BALL, "b.ambient")
        whole = self.bytes_of("b.ambient")
        middle = len(whole) // 2
        flipped = whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1:]
        for bad in (self.path("missing.ambient"), self.write("empty.ambient", ""), self.write("foreign.ambient", "solid x"),
                    self.write("short.ambient", whole[:middle]), self.write("flipped.ambient", flipped)):
            for command in (["inspect"], ["export", "--format", "sdf"], ["polar"],
                            ["loads", "--twist", 0, 0, 0, 1, 0, 0, "--density", 1]):
                self.assertIn(bad, self.refusal(command[0], bad, *command[1:]))

    def test_names_that_are_not_utf8_are_shown_with_replacements(self):
        _, file = self.build(BALL, "b.ambient")
        whole = self.bytes_of("b.ambient")
        payload = whole[programs.HEADER_SIZE:].replace(b"\x02\0\0\0in\0", b"\x02\0\0\0\xe9n\0", 1)
        self.write("b.ambient", programs.sealed(payload, whole))
        self.assertEqual(self.result_of("inspect", file, "--json")["name"], "\ufffdn")

    def test_upgrade_completes_files_in_place(self):
        # A file of an earlier version is written anew as prepare() completes it; one that cannot be read stays.
        _, file = self.build({"type": "box", "half_sizes": [1, 2, 3]}, "old.ambient")

        def upgrade(old):
            self.write("old.ambient", old)
            for said in (": upgraded\n", ": is up to date\n"):
                self.assertEqual(self.run_well("upgrade", file).output, file + said)
            return self.bytes_of("old.ambient")

        built = self.result_of("inspect", file, "--json")
        upgraded = upgrade(programs.without_fields(self.bytes_of("old.ambient"), [FORM, VISCOUS]))
        facts = self.result_of("inspect", file, "--json")
        self.assertEqual({**facts, "viscous_flow": 0}, {**built, "viscous_flow": 0})
        resistance = facts["viscous_flow"]["resistance"][3][3]
        self.expect_close(resistance / built["viscous_flow"]["resistance"][3][3], 1, 0.02)
        self.assertEqual(upgrade(programs.without_fields(upgraded, [FORM, VISCOUS])), upgraded)
        half = self.write("half.ambient", upgraded[:3000])
        self.assertIn("half.ambient", self.refusal("upgrade", half))
        self.assertEqual(self.bytes_of("half.ambient"), upgraded[:3000])

    def test_upgrade_says_which_bodies_keep_their_drag_at_any_speed(self):
        _, file = self.build({"type": "ellipsoid", "semi_axes": [1, 0.5, 0.5]}, "round.ambient")
        self.write("round.ambient", programs.without_fields(self.bytes_of("round.ambient"), [VISCOUS]))
        self.assertEqual(self.run_well("upgrade", file).output,
                         file + ": upgraded; it has no drag crisis: where the flow leaves its smooth sides only a new build finds\n")


class InputTest(CommandTest):
    """What is refused, mended and warned of."""

    def test_bad_meshes_are_refused_in_one_line_that_names_the_file(self):
        missing = self.path("no such.obj")
        self.assertEqual(self.build_refusal(missing), missing + ": no such file")
        opened = self.write("open.obj", obj_text(OPEN))
        self.expect_message(self.build_refusal(opened, "--strict"),
                            opened + ": not watertight: 3 boundary edges, for example from vertex ...")
        self.expect_message(self.build_refusal(opened, "--strict"), "...(build --wrap makes a closed surface around it)")
        closed = self.write("closed.obj", obj_text(TETRAHEDRON))
        self.assertIn("is closed: a sheet needs a boundary", self.build_refusal(closed, "--sheet"))

    def test_meshes_of_nothing_are_refused_strict_or_not(self):
        nan = obj_text(TETRAHEDRON).replace("v 1.0 0.0 0.0", "v 1 nan 0")
        for name, text in (("empty", ""), ("points", "v 0 0 0\nv 1 0 0\n"), ("nan", nan), ("sheet", obj_text(sheet(1, 1, 5)))):
            file = self.write(name + ".obj", text)
            for more in ([], ["--strict"]):
                self.expect_message(self.build_refusal(file, *more), file + ": ...")

    def test_broken_meshes_are_built_with_one_line_unless_strict(self):
        holed = (CUBE[0], CUBE[1][:5] + CUBE[1][6:])
        for mesh, volume in ((LIDLESS, 8), (holed, 8), (joined(moved(CUBE, (1.3, 0.4, 0.3)), holed), 16 - 0.7 * 1.6 * 1.7)):
            file = self.write("mesh.obj", obj_text(mesh))
            self.expect_message(self.build_refusal(file, "--strict"), file + ": not watertight: ...")
            built = self.run_well(*self.build_arguments(file, "--panels", "0", "--json"))
            self.assertEqual(built.errors.count("; holes filled: 1, of"), 1, built.errors)
            self.expect_close(json.loads(built.output)["volume"], volume, 1e-6 * volume)
            self.refusal(*self.build_arguments(file, "--strict"))  # the file of a laxer build is no answer
            os.remove(self.path("out.ambient"))

    def test_bad_shapes_are_refused_in_one_line_that_names_the_file(self):
        for shape, more, message in (
                ({"type": "sphere", "radius": -1}, [], "{file}: radius is -1; must be > 0"),
                ({"type": "mesh", "file": "lost.obj"}, [], "{folder}/lost.obj: no such file"),
                ({"type": "fluid_body", "file": "x.ambient"}, [], '{file}: a shape "fluid_body" is built already'),
                (BALL, ["--sheet"], '{file}: --sheet needs a shape of type "sheet"'),
                (BALL, ["--hull"], "{file}: --hull needs a mesh..."),
                (BALL, ["--drag", "0.2"], "{file}: --drag needs faces..."),
                ({"type": "box", "half_sizes": [1, 2, 2], "faces": 48}, ["--origin", "1e308,0,0"],
                 "{file}: the body reaches 1e+308 m from its origin, more than 1000000 times its size of 6 m"),
                ({"type": "box", "half_sizes": [1, 2, 2], "faces": 48}, ["--origin", "0,0,7e6"],
                 "{file}: the body reaches 7000002 m...")):
            file = self.write("shape.json", shape)
            self.expect_message(self.build_refusal(file, *more), message.format(file=file, folder=self.folder))

    def test_shapes_beyond_what_can_be_solved_are_refused(self):
        for shape, message in json.loads(Path(__file__).with_name("refusals.json").read_text())["shapes"]:
            file = self.write("shape.json", shape)
            self.expect_message(self.build_refusal(file, "--panels", "0"), file + ": " + message)

    def test_meshes_in_millimetres_are_warned_of_and_sizes_shown(self):
        mesh = self.write("box.obj", obj_text(box((400, 250, 100), 4)))
        build = self.build_arguments(mesh, "--panels", "0")
        warning = f"warning: {mesh}: its size is 800 x 500 x 200 m; lengths are metres: if the file is in " \
            "millimetres, give a scale of 0.001\n"
        for arguments in (build, ["check", mesh]):
            result = self.run_well(*arguments)
            self.assertEqual(result.errors, warning)
            self.assertIn("\nsize              800, 500, 200 m\n", result.output)
        size = self.result_of(*build, "--json", "--scale", "0.001")["size"]
        for found, expected in zip(size, (0.8, 0.5, 0.2)):
            self.expect_close(found, expected, 1e-6)
        self.assertEqual(self.run_well(*build, "--scale", "2").errors, "")  # whoever scales knows the unit
        self.assertEqual(self.run_well(*build, "--scale", "1e-8").errors, f"warning: {mesh}: its size is 8e-06 x 5e-06 x "
                         "2e-06 m; lengths are metres: if the file is in others, give a scale\n")
        for kind, faces in (("mesh", box((400, 250, 100), 4)), ("sheet", sheet(900, 600, 8))):  # a scale in a file of JSON, too
            file = self.write(f"{kind}.obj", obj_text(faces))
            shape = {"type": kind, "file": file}
            for scale, expected in ((None, True), (0.9, False)):
                told = self.run_well(*self.build_arguments(
                    self.write("s.json", {**shape, **({"scale": scale} if scale else {})}), "--panels", "0")).errors
                self.assertEqual("give a scale of 0.001" in told, expected, told)

    def test_slender_shapes_are_warned_of(self):
        def warnings_of(width):
            shape = self.write("s.json", {"type": "sheet", "size": [width, 1], "faces": 400})
            return self.run_well(*self.build_arguments(shape, "--panels", "0")).errors

        self.assertEqual(warnings_of(0.001), f"warning: {self.path('s.json')}: it is 1000 times as long as wide: the added "
                         "mass may be some per cent off\n")
        self.assertEqual(warnings_of(0.01), "")

    def test_long_triangles_get_more_panels_or_a_warning(self):
        def barrel(strips):  # in a CAD program's style: strips from rim to rim, caps as fans
            circle = [(0.5 * math.cos(2 * math.pi * i / strips), 0.5 * math.sin(2 * math.pi * i / strips)) for i in range(strips)]
            vertices = [(x, y, z) for z in (-0.5, 0.5) for x, y in circle] + [(0, 0, -0.5), (0, 0, 0.5)]
            around = [(i, (i + 1) % strips) for i in range(strips)]
            return vertices, [t for i, j in around for t in ((i, j, strips + j), (i, strips + j, strips + i),
                                                             (2 * strips, j, i), (2 * strips + 1, strips + i, strips + j))]

        strips = self.write("strips.obj", obj_text(barrel(24)))
        self.assertIn(f"warning: {strips}: its long triangles leave too few panels across its edges: the added mass may be some, "
                      "at worst tens of per cent off; cut them into shorter ones, or give more panels\n",
                      self.run_well(*self.build_arguments(strips, "--panels", "300")).errors)
        few = self.write("few.obj", obj_text(barrel(12)))
        built = self.run_well(*self.build_arguments(few, "--panels", "600", "--json"))
        self.assertNotIn("long triangles", built.errors)
        # Solved on 17 000 panels; 600 panels alone are 9 % off.
        self.expect_close(json.loads(built.output)["added_mass"][0][0], 0.023918, 0.02 * 0.023918)

    def test_sheets_are_built_from_open_meshes(self):
        facts, _ = self.build(obj_text(sheet(1, 1, 12)), "s.ambient", "--sheet")
        self.assertEqual((facts["volume"], facts["sheet"], facts["faces"]), (0, True, 288))
        self.assertGreater(facts["added_mass"][5][5], 0.4)
        self.assertRegex(self.build_refusal(self.path("in.obj")), "not watertight: 48 boundary edges.*--sheet")

    def test_hollow_meshes_displace_what_their_outside_encloses(self):
        hollow = joined(box((1, 1, 1), 5), inside_out(box((0.5, 0.5, 0.5), 2)))
        mesh = self.write("hollow.obj", obj_text(hollow))
        built = self.run_well(*self.build_arguments(mesh, "--panels", "0", "--json"))
        self.expect_message(built.errors, f"warning: {mesh}: 1 cavity of 12.5 % of the volume: ...")
        facts = json.loads(built.output)
        self.expect_close(facts["volume"], 8, 1e-5)
        # Uniform mass of the hollow cube; a full cube would have 2/3.
        self.expect_close(facts["uniform_mass"]["inertia"][0][0], (8 * 2 / 3 - 1 / 6) / 7, 1e-5)

    def test_hull_and_wrap_are_built_anew_when_they_change(self):
        mesh = self.write("l.obj", obj_text(joined(CUBE, moved(CUBE, (3, 0, 0)))))

        def volume_of(*more):
            return json.loads(self.run_well(*self.build_arguments(mesh, "--panels", "0", "--json", *more)).output)["volume"]

        self.expect_close(volume_of(), 16, 1e-9)
        self.expect_close(volume_of("--hull"), 20, 1e-6)
        self.expect_close(volume_of("--wrap=0.1"), 16, 0.05)
        self.expect_close(volume_of("--scale", "2", "--wrap", "0.2"), 128, 0.4)
        self.assertIn("give a larger size", self.refusal(*self.build_arguments(mesh, "--wrap", "1e-6")))
        self.assertEqual(self.refusal(*self.build_arguments(mesh, "--wrap", "--strict"), status=2), "--wrap: excludes --strict")


class CheckTest(CommandTest):
    def test_says_that_a_mesh_is_right(self):
        self.assertEqual(self.run_well("check", self.write("box.obj", obj_text(CUBE))).output,
                         "usable            yes\nfaces             12\nsize              2, 2, 2 m\n"
                         "volume            8 m^3\nwrapped           no\n")

    def test_finds_all_defects_and_what_mends_them(self):
        mesh = self.write("open.obj", obj_text(joined(LIDLESS, LIDLESS, moved(CUBE, (0.4, 0.55, 0.7)))))
        result = self.run_program("check", mesh, "--strict", "--json", "--obj", self.path("bad.obj"))
        self.assertEqual(result.status, 1)
        found = json.loads(result.output)
        self.assertFalse(found["usable"])
        self.assertLessEqual({"doubled triangles", "parts overlap"}, {defect["kind"] for defect in found["defects"]})
        self.assertGreaterEqual(len(found["defects"]), 3)
        for remedy in found["remedies"]:
            self.assertEqual(remedy["usable"], remedy["option"] != "--sheet", remedy)
        bad = self.bytes_of("bad.obj").decode()
        self.assertIn("o doubled_triangles\nv ", bad)
        self.assertIn("\nf 1 2 3\n", bad)
        self.assertEqual(self.refusal("check", mesh, "--obj", self.path("bad.txt"), status=2),
                         f'--obj: "{self.path("bad.txt")}" does not end in .obj')

    def test_says_what_build_would_do(self):
        opened = self.write("open.obj", obj_text(LIDLESS))
        closed = self.run_well("check", opened)
        for words in ("\n  text            not watertight: 4 boundary edges", "\nfaces             12\n",
                      "\nwrapped           no\n"):
            self.assertIn(words, closed.output)
        self.expect_message(closed.errors, f"warning: {opened}: not watertight: ...")
        broken = self.write("broken.obj", obj_text(joined(LIDLESS, LIDLESS, moved(CUBE, (0.4, 0.55, 0.7)))))
        self.assertIn("\nwrapped           yes\n", self.run_well("check", broken).output)
        refused = self.run_program("check", self.write("sheet.obj", obj_text(sheet(1, 1, 5))))
        self.assertEqual(refused.status, 1)
        self.assertIn("\n  option          --sheet\n  usable          yes\n", refused.output)

    def test_estimates_the_error_of_a_mesh(self):
        mesh = self.write("box.obj", obj_text(box((1, 2, 3))))
        report = self.result_of("check", mesh, "--scale", "0.1", "--estimate", "--panels", "800", "--json")
        estimate = report["estimate"]
        self.assertEqual(report["faces"], 12)
        self.assertGreater(estimate["panels"], estimate["other_panels"])
        self.assertTrue(1e-3 < estimate["rotation_error"] < 0.2, estimate)
        self.expect_close(estimate["thinnest"]["thickness"], 0.2, 1e-6)
        self.assertEqual(len(estimate["worst_triangles"]), 3)
        self.assertNotIn("estimate", self.result_of("check", mesh, "--json"))
        self.assertIn("\nestimate\n", self.run_well("check", mesh, "--estimate", "--panels", "800").output)
        refused = self.run_program("check", self.write("open.obj", obj_text(OPEN)), "--estimate", "--strict")
        self.assertEqual((refused.status, "estimate" in refused.output), (1, False), refused.output)
        self.assertEqual(self.refusal("check", mesh, "--estimate", "--panels", "-1", status=2),
                         "--panels: -1 is below 0 (0: no division)")


class FactsTest(CommandTest):
    """What build and inspect print."""

    def test_build_and_inspect_print_the_numbers_of_the_file_to_the_last_bit(self):
        built, file = self.build(obj_text(moved(cone(0.5, 1, 40), (1, 2, 3))))
        self.assertEqual((built["name"], built["faces"], built["vertices"]), ("in", 80, 42))
        self.assertGreater(built["seconds"], 0)
        self.expect_close(built["volume"], math.pi / 12, 0.02 * math.pi / 12)
        self.assertGreater(built["area"], 0)
        self.assertGreaterEqual(built["asymmetry"], 0)
        self.expect_close(built["origin"][0], 1, 1e-6)
        self.expect_close(built["origin"][2], 3.25, 2e-3)
        self.assertEqual(built["centre_of_volume"], [0, 0, 0])
        matrix = built["added_mass"]
        self.assertEqual(matrix, [list(row) for row in zip(*matrix)])
        inspected = self.result_of("inspect", file, "--json")
        for axis in inspected["viscous_flow"]["separation"]:
            axis.pop("leaves_at", None)
        self.assertEqual({**inspected, "seconds": built["seconds"]}, built)
        whole = self.bytes_of("out.ambient")
        for number in [built["volume"], built["area"], *(x for row in matrix for x in row)]:
            self.assertIn(struct.pack("<d", number), whole)

    def test_tables_say_what_the_json_says(self):
        built = self.run_well(*self.build_arguments(self.write("ball.json", BALL)))
        self.assertEqual(built.errors, "")
        for line in ("vertices          162", "faces             320", "volume            0.523598776 m^3", "\nadded mass "):
            self.assertIn(line, built.output)
        inspected = self.run_well("inspect", self.path("out.ambient")).output.splitlines()
        while (rows := [i for i, line in enumerate(inspected) if "leaves at" in line]):
            del inspected[rows[0] : rows[0] + 3]
        self.assertEqual(inspected, built.output.splitlines())

    def test_inspect_says_where_layers_leave_smooth_sides(self):
        ball = self.build({"type": "sphere", "radius": 0.1, "faces": 1280})[1]
        for axis in self.result_of("inspect", ball, "--json")["viscous_flow"]["separation"]:
            for laminar, turbulent in axis["leaves_at"]:
                self.expect_close(laminar, 0.617, 0.01)
                self.expect_close(turbulent, 0.816, 0.02)
        box_file = self.build({"type": "box", "size": [1, 2, 3]})[1]
        self.assertNotIn("leaves_at", self.run_well("inspect", box_file, "--json").output)

    def test_options_scale_shift_and_limit_threads(self):
        mesh = self.write("box.obj", obj_text(box((1, 2, 3), 4)))

        def built(*more):
            return self.result_of(*self.build_arguments(mesh, "--panels", "0", "--json", *more))

        plain = built()
        self.expect_close(plain["volume"], 48, 48e-6)
        self.expect_close(built("--scale", "0.1")["volume"], 0.048, 0.048e-6)
        shifted = built("--origin", "-1,0.5,0")
        self.assertEqual(shifted["origin"], [-1, 0.5, 0])
        self.expect_close(shifted["centre_of_volume"][0], 1, 1e-6)
        self.assertEqual(built("--origin", "centre-of-volume")["origin"], plain["origin"])
        self.assertEqual(built("--threads", "1", "--rebuild")["added_mass"], plain["added_mass"])
        self.assertGreaterEqual(built("--least-faces", 4 * plain["faces"])["faces"], 4 * plain["faces"])

    def test_levels_are_those_asked_for_with_their_errors(self):
        egg = {"type": "ellipsoid", "semi_axes": [0.2, 0.2, 0.1], "faces": 320}
        self.assertNotIn("form_levels", self.build(egg)[0])
        built, file = self.build(egg, "out.ambient", "--levels", "16,32")
        few, more = built["form_levels"]
        self.assertGreater(min(few["p99_error"], more["p99_error"]), 0)
        self.assertTrue(few["faces"] <= 16 and few["faces"] < more["faces"], built["form_levels"])
        self.assertEqual(self.result_of("inspect", file, "--json")["form_levels"], built["form_levels"])

    def test_without_tables_the_flow_around_a_box_is_solved(self):
        box_file = self.write("box.json", {"type": "box", "size": [1, 2, 3]})

        def settings_of(*more):
            return self.result_of(*self.build_arguments(box_file, "--json", "--panels", "1200", *more))["settings"]

        self.assertIn("added mass tables", settings_of())
        self.assertNotIn("added mass tables", settings_of("--no-tables"))
        self.assertIn("panels", settings_of("--no-tables"))


class LoadsTest(CommandTest):
    def loads(self, file, twist, *more, density=3):
        return self.result_of("loads", file, "--twist", *twist, "--density", density, *more, "--json")

    def test_options_reach_the_law(self):
        _, file = self.build({"type": "box", "half_sizes": [1, 2, 3], "faces": 300})
        for k in range(6):  # a box has planes of symmetry: it meets the fluid against its motion alone
            twist = [2 if i == k else 0 for i in range(6)]
            loads = self.loads(file, twist, "--viscosity", "1e-3")
            for part in ("pressure", "friction", "total"):
                self.assertLess(loads[part][k], 0)
                self.assertLess(sum(abs(x) for i, x in enumerate(loads[part]) if i != k), 1e-9 * -loads[part][k])
            self.expect_close(loads["total"][k], loads["pressure"][k] + loads["friction"][k], 1e-12 * -loads["total"][k])
            ideal, denser = self.loads(file, twist), self.loads(file, twist, density=6)
            self.expect_close(denser["pressure"][k] / ideal["pressure"][k], 2, 1e-12)
            self.assertEqual(denser["friction"], [0] * 6)
            self.assertEqual(self.loads(file, twist, "--viscosity", "1e-3", "--no-friction")["friction"], [0] * 6)

    def test_separate_at_a_right_angle_by_default(self):
        _, file = self.build({"type": "sphere", "radius": 0.5})
        loads = self.loads(file, (0, 0, 0, 0, 0, 2))
        # C_D = 1/2 on pi R^2, the integral of sin^4(alpha) / 2; facets have no influence.
        drag = 0.5 * 3 * 2 * 2 * 0.5 * math.pi * 0.25
        self.expect_close(loads["pressure"][5], -drag, 1e-12 * drag)
        self.assertEqual(self.loads(file, (0, 0, 0, 0, 0, 2), "--separation-angle", "1.5707963"), loads)
        later = self.loads(file, (0, 0, 0, 0, 0, 2), "--separation-angle", "2", "--law", "published")
        self.assertGreater(later["pressure"][5], loads["pressure"][5])

    def test_on_a_sphere_about_another_origin_are_those_at_its_centre(self):
        _, centred = self.build(BALL, "b.ambient")
        _, off = self.build(BALL, "off.ambient", "--origin", "0,0,-2")

        def total(file, vx):
            more = "--viscosity", "1e-3", "--roughness", "1e-3"
            return self.loads(file, (0, 3, 1, vx, 0, 5), *more, density=2)["total"]

        # Centre at (0, 0, 2): its velocity is v + w x r, 6 m/s more along x.
        at_centre, about_other = total(centred, 7), total(off, 1)
        torque, force = at_centre[:3], at_centre[3:]
        expected = [torque[0] - 2 * force[1], torque[1] + 2 * force[0], torque[2], *force]
        for found, wanted in zip(about_other, expected):
            self.expect_close(found, wanted, 1e-12)
        self.assertGreater(abs(force[0]), 1)

    def test_of_the_form_law_press_on_a_flat_face_or_have_the_measured_drag(self):
        cube = {"type": "box", "size": [1, 1, 1]}
        _, file = self.build(cube)
        loads = self.loads(file, (0, 0, 0, 0, 0, 2))
        self.expect_close(loads["total"][5], -1.17 * 0.5 * 3 * 2 * 2, 1e-12)
        self.assertEqual(self.loads(file, (0, 0, 0, 0, 0, 2), "--law", "form"), loads)
        self.assertEqual(self.loads(file, (0, 0, 0, 0, 0, 2), "--law", "published")["total"][5], 0)
        for given, coefficients in (("1.05", [1.05] * 3), ("0.5,1,1.5", [0.5, 1, 1.5])):
            _, measured = self.build(cube, "out.ambient", "--drag", given)
            for k, drag in enumerate(coefficients):
                twist = [2 if i == 3 + k else 0 for i in range(6)]
                self.expect_close(self.loads(measured, twist)["total"][3 + k], -drag * 0.5 * 3 * 2 * 2, 1e-12)

    def test_inspect_tells_where_the_drag_falls_where_it_does_alone(self):
        egg = {"type": "ellipsoid", "semi_axes": [2, 1, 1], "faces": 320}
        for more, share in ((), 1), (("--drag", "0.2"), 0):  # measured drag knows no layers
            _, file = self.build(egg, "egg.ambient", *more)
            for axis in self.result_of("inspect", file, "--json")["viscous_flow"]["separation"]:
                self.assertEqual((axis["smooth_share"], "drag_falls_at" in axis, "leaves_at" in axis), (share, share > 0, share > 0))

    def test_print_a_table_and_end_where_numbers_end(self):
        _, file = self.build(BALL)
        output = self.run_well("loads", file, "--twist", 0, 0, 0, 1, 0, 0, "--density", 1).output
        self.assertRegex(output, "^pressure (.|\n)*\ntotal ")
        fast = "loads", file, "--twist", 0, 0, 0, "1e200", 0, 0, "--density", 1
        self.assertIn("beyond the largest number", self.refusal(*fast))
        dense = "loads", file, "--twist", 0, 0, 0, 1, 0, 0, "--density", 1e150, "--viscosity", 1e-3
        self.assertIn("Reynolds number beyond 1e+60", self.refusal(*dense))


class ExportTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.ball = self.build(BALL, "ball.ambient")[1]

    def test_writes_to_standard_output_or_a_file(self):
        for kind in ("sdf", "mjcf", "fossen"):
            shown = self.run_well("export", self.ball, "--format", kind)
            written = self.run_well("export", self.ball, "--format", kind, "-o", self.path("out.x"))
            self.assertEqual(self.bytes_of("out.x").decode(), shown.output)
            self.assertEqual(written.output == "", kind != "mjcf")  # whose errors are shown beside the file, too

    def test_options_reach_the_file(self):
        options = {"density": 1000, "gravity": 10, "mass": 300, "draught": 0.6, "speed": 2}
        words = [word for name, value in options.items() for word in ("--" + name, value)]
        made = json.loads(self.run_well("export", self.ball, "--format", "fossen", *words, "--viscosity", 0, "--up", "y",
                                        "--forward", "-x", "--centre-of-mass", 0.1, 0.2, 0.3).output)
        self.assertEqual({name: made[name] for name in options}, options)
        # Forward -x, to starboard forward times up = -z, down -y.
        self.assertEqual(made["centre_of_gravity"], [-0.1, -0.3, -0.2])

    def test_bad_input_and_places_are_refused(self):
        def refusal(*more, file=self.ball):
            return self.refusal("export", file, "--format", "sdf", *more)

        self.assertEqual(refusal("--centre-of-mass", 0, "nan", 0), self.ball + ": fluid body 'in': distance of the centre of "
                         "mass [m] is nan, must be finite")
        nowhere = self.path("none/out.sdf")
        for place, words in ((nowhere, f'the directory "{self.path("none")}" does not exist'), (self.folder, "is a directory"),
                             (self.ball, "the output would replace the input"), ("/dev/full", "is not a regular file")):
            self.assertEqual(refusal("-o", place), f"{place}: {words}")


class FloatingTest(CommandTest):
    def barge(self):
        return self.build({"type": "box", "size": [2, 1, 0.5]}, "barge.ambient")[1]

    def floating(self, file, mass, *more):
        return self.result_of("inspect", file, "--mass", mass, *more, "--json")["floating"]

    def upright(self, *arguments):
        return max(self.floating(*arguments), key=lambda attitude: attitude["up"][2])

    def test_inspect_tells_how_a_barge_floats(self):
        # Half the water's density, low weight: T = 0.25, GM = B^2 / 12 T - KG + KB.
        file = self.barge()
        upright = self.floating(file, 500, "--density", 1000, "--centre-of-mass", 0, 0, -0.24)[0]
        self.expect_close(upright["draught"], 0.25, 1e-9)
        self.expect_close(upright["up"][2], 1, 1e-9)
        self.expect_close(upright["height_of_mass"], -0.24, 1e-9)
        self.expect_close(upright["metacentres"][0]["height"], 1 / (12 * 0.25) + 0.24 - 0.125, 1e-9)
        self.assertEqual(len(upright["modes"]), 3)
        table = self.run_well("inspect", file, "--mass", 500, "--density", 1000)
        self.assertEqual(table.errors, "", "either side is up")
        self.assertIn("\n  draught         0.25 m\n", table.output)

    def test_inspect_tells_what_is_odd_or_wrong(self):
        file = self.barge()

        def inspect(mass, height):
            return self.run_well("inspect", file, "--mass", mass, "--centre-of-mass", 0, 0, height)

        downwards = "\n  up              0, 0, -1\n"
        self.assertIn(downwards, inspect(500, 0.24).output)
        self.assertEqual(inspect(500, 0.24).errors, "it floats with its z axis downwards in the likeliest attitude\n")
        self.assertNotIn(downwards, inspect(500, -0.24).output)
        self.assertEqual(inspect(500, -0.24).errors, "")
        self.assertIn("it is lighter than the 1.2", inspect(0.5, 0).errors)
        self.assertEqual(self.floating(file, 1001), [])
        self.assertIn("it sinks: it displaces 998 kg", inspect(1001, 0).errors)
        self.assertIn("mass [kg] is -1, must be positive", self.refusal("inspect", file, "--mass", "-1"))
        self.assertIn("smallest principal moment", self.refusal("inspect", file, "--mass", 500, "--inertia", -1, 1, 1, 0, 0, 0))

    def test_periods_are_those_of_inertia_and_gravity_that_are_given(self):
        # Of body and water without waves: 2 pi sqrt(inertia / (density gravity geometry)).
        file = self.barge()

        def periods(*more):
            modes = self.floating(file, 500, "--centre-of-mass", 0, 0, -0.24, *more)[0]["modes"]
            return [mode["period"] for mode in modes]

        here = periods()
        even = [500 / 12 * squares for squares in (1.25, 4.25, 5)]  # 500 kg over a box of 2 m x 1 m x 0.5 m
        self.expect_close(periods("--inertia", *even, 0, 0, 0)[0] / here[0], 1, 1e-6)
        self.assertGreater(periods("--inertia", 400, 700, 800, 0, 0, 0)[0], 1.2 * here[0])
        self.assertEqual(periods("--gravity", 9.81), here)
        for moon, earth in zip(periods("--gravity", 1.62), here, strict=True):
            self.expect_close(moon / earth, math.sqrt(9.81 / 1.62), 1e-9)

    def expect_no_rounding(self, text):
        """No number that is not 0 and below 1e-9."""
        self.assertIsNone(re.search(r"e-(0[9]|[1-9][0-9]|[0-9]{3})", text), text)

    def test_inspect_tells_how_a_ball_floats(self):
        # Up to its middle in water: every turn is neutral.
        _, file = self.build(BALL)
        ball, = self.floating(file, 261.799387799149, "--density", 1000)
        self.expect_close(ball["draught"], 0.5, 1e-9)
        self.expect_close(ball["waterplane_area"], math.pi / 4, 1e-9)
        self.expect_close(ball["metacentres"][0]["height"], 0, 1e-9)
        self.assertEqual([mode["period"] for mode in ball["modes"]].count(None), 2)
        text = self.run_well("inspect", file, "--mass", 261.799387799149, "--density", 1000).output
        self.expect_no_rounding(text)
        self.assertIn("\n    heave         yes\n", text)
        self.assertNotIn("\n    heave         no\n", text)

    def test_inspect_shows_no_rounding_in_oblique_axes(self):
        box = {"shape": {"type": "box", "size": [1, 0.5, 0.25]}, "orientation": [0.8, 0.2, -0.4, 0.4]}
        box_file, file = self.write("box.json", {"type": "compound", "parts": [box]}), self.path("box.ambient")
        self.run_well("build", box_file, "-o", file, "--panels", "300")
        text = self.run_well("inspect", file, "--mass", 62.5, "--density", 1000).output
        self.expect_no_rounding(text)
        self.assertIn("height of mass  0 m", text)

    def test_wigleys_hull_of_quads_floats_as_its_formula_says(self):
        # 50 x 12 x 3.5 m in quads, with straight sides and a deck above the water: y = B/2 (1 - (2x/L)^2) (1 - (z/T)^2).
        # Where keel and stem meet, port and starboard have three corners in common, and quads of the deck have two.
        along, up = 36, 12
        levels = up + 2

        def point(side, i, j):
            s, t = 2 * i / along - 1, min(j / up - 1, 0)
            return 25 * s, side * 6 * (1 - s * s) * (1 - t * t), 2 if j > up else 3.5 * t

        vertices = [point(side, i, j) for side in (-1, 1) for i in range(along + 1) for j in range(levels)]
        port, quads = (along + 1) * levels, []
        for i in range(along):
            a, b = i * levels, (i + 1) * levels
            for j in range(up + 1):
                quads += [(a + j, b + j, b + j + 1, a + j + 1),
                          (port + a + j, port + a + j + 1, port + b + j + 1, port + b + j)]
            deck = levels - 1
            quads.append((a + deck, b + deck, port + b + deck, port + a + deck))
        file = self.path("wigley.ambient")
        built = self.run_well("build", self.write("wigley.obj", obj_text((vertices, quads))), "-o", file, "--origin", "0,0,0",
                              "--panels", "0", "--strict")
        self.assertIn("opposite triangles on the same corners, were left out: 2", built.errors)
        hull = self.upright(file, 956667, "--density", 1025, "--centre-of-mass", 0, 0, -1.75)
        # By the formulas GM is 3.964 m at 3.5 m; chords of the sides leave 0.4 % of the volume out.
        self.expect_close(hull["draught"], 3.508, 0.001)
        self.expect_close(hull["metacentres"][0]["height"], 3.96, 0.005)

    def test_a_tray_stays_dry_unless_it_is_told_not_to(self):
        # What is read of an .obj file has the rounding of float.
        outside, inside = box((0.5, 0.3, 0.2)), box((0.48, 0.28, 0.19))
        top = [(x, y, 0.2 if z > 0 else z + 0.01) for x, y, z in inside[0]]
        rim = len(outside[0])
        corners = [[next(i for i, v in enumerate(of) if v[0] * a > 0 and v[1] * b > 0 and v[2] == 0.2)
                    for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))] for of in (outside[0], top)]
        ring = [t for k in range(4) for o, p, q, r in [(corners[0][k], corners[0][(k + 1) % 4], rim + corners[1][(k + 1) % 4],
                                                        rim + corners[1][k])] for t in ((o, p, q), (o, q, r))]
        walls = joined((outside[0], outside[1][:-2]), inside_out((top, inside[1][:-2])))
        mesh = self.write("tray.obj", obj_text((walls[0], walls[1] + ring)))
        holds = json.loads(self.run_well("check", mesh, "--json").output)["holds"]
        self.assertEqual(len(holds), 1)
        self.expect_close(holds[0]["volume"], 0.96 * 0.56 * 0.38, 1e-8)
        self.expect_close(holds[0]["openings"][0]["rim"], 3.04, 1e-6)
        self.assertEqual(len(self.build(Path(mesh).read_text())[0]["holds"]), 1)
        file, draught = self.path("out.ambient"), 60 / (998 * 0.6)
        self.expect_close(self.upright(file, 60)["draught"], draught, 1e-7)
        self.expect_close(self.upright(file, 60)["freeboard"], 0.4 - draught, 1e-7)
        self.expect_close(self.upright(file, 60, "--water", 0.03)["draught"], draught + 0.05, 1e-4)
        # Upside down there is no room: the walls alone sink.
        for option in (["--holds", "none"], ["--up", 0, 0, -1]):
            self.assertNotIn("holds", self.build(Path(mesh).read_text(), "out.ambient", *option)[0])
            self.assertEqual(self.floating(file, 60), [])

    def test_tanks_and_openings_are_given_by_hand(self):
        hull, tank = obj_text(box((1, 0.5, 0.25))), self.write("tank.obj", obj_text(box((0.5, 0.3, 0.125))))
        hole = ["--opening", 0.1, 0, -0.125, 0.001, 0, 0, -2]
        for more, openings in (([], []), (hole, [-0.125]), (hole + ["--opening", 0.5, 0, 0, 0.002, 1, 0, 0], [-0.125, 0])):
            facts = self.build(hull, "out.ambient", "--tank", tank, *more)[0]
            self.expect_close(facts["volume"], 1, 1e-7)
            (hold,) = facts["holds"]
            self.assertEqual(hold["name"], "tank")
            self.expect_close(hold["volume"], 0.15, 1e-7)
            self.assertEqual([round(opening["centre"][2], 9) for opening in hold.get("openings", [])], openings)
        # The same in JSON, in its own units; another tank makes another body.
        self.write("hull.obj", hull)
        shape = {"type": "mesh", "file": "hull.obj", "scale": 2, "tanks": ["tank.obj"],
                 "openings": [{"place": [0.2, 0, -0.25], "normal": [0, 0, -1], "area": 0.004}]}
        self.expect_close(self.build(shape)[0]["holds"][0]["volume"], 8 * 0.15, 1e-7)
        self.write("tank.obj", obj_text(box((0.5, 0.3, 0.1))))
        self.expect_close(self.build(shape)[0]["holds"][0]["volume"], 8 * 0.12, 1e-7)

    def test_tanks_and_openings_that_make_no_sense_are_refused(self):
        hull, far = self.write("hull.obj", obj_text(box((1, 0.5, 0.25)))), self.write("far.obj", obj_text(box((0.5, 0.3, 0.3))))
        tank, lidless = self.write("tank.obj", obj_text(box((0.5, 0.3, 0.125)))), self.write("lidless.obj", obj_text(LIDLESS))
        self.assertEqual(self.build_refusal(hull, "--tank", far), f"{far}: the tank is not wholly inside {hull}")
        self.assertIn(lidless + ": ", self.build_refusal(hull, "--tank", lidless))
        self.assertIn("nowhere.obj: ", self.build_refusal(hull, "--tank", self.path("nowhere.obj")))
        self.assertEqual(self.build_refusal(hull, "--tank", tank, "--tank", tank), f"{tank}: the tank reaches into the tank of {hull}")
        for numbers, words in (((0, 0, 0, -1, 0, 0, 1), "its area of -1 m^2 is not positive and finite"),
                               ((0, 0, 0.125, 0.1, 0, 0, 0), "its normal (0 0 0) is no direction"),
                               ((0, 0, 0.5, 0.1, 0, 0, 1), "it is 0.375 m from the nearest wall of a hold, more than 0.119"),
                               ((0, 0, 0.125, 10, 0, 0, 1), "its area of 10 m^2 is above that of the walls of the tank")):
            self.assertIn(f"{hull}: opening 1: {words}", self.build_refusal(hull, "--tank", tank, "--opening", *numbers))
        self.assertEqual(self.build_refusal(hull, "--opening", 0, 0, 0, 1, 0, 0, 1), f"{hull}: opening 1: there is no hold that it could open")
        ball = self.write("ball.json", BALL)
        self.assertEqual(self.build_refusal(ball, "--tank", tank), f"{ball}: a tank or an opening needs a closed mesh or a compound")


class FlyingTest(CommandTest):
    def test_a_plate_with_its_mass_ahead_glides(self):
        file = self.path("plate.ambient")  # with the added mass of tables
        self.run_well("build", self.write("plate.json", {"type": "box", "half_sizes": [0.1, 0.5, 0.002], "faces": 400}), "-o", file)
        flying = "inspect", file, "--fly", "--mass", "0.3", "--centre-of-mass", "0.04", "0", "0"
        facts = self.result_of(*flying, "--json")["flying"]
        trim, stability = facts["trim"], facts["stability"]
        self.expect_close(math.tan(math.radians(trim["glide_angle"])) * trim["glide_ratio"], 1, 1e-9)
        self.assertGreater(facts["best_glide"]["glide_ratio"], trim["glide_ratio"])
        self.expect_close(stability["margin_over_chord"], stability["static_margin"] / 0.2, 1e-9)
        self.expect_close(stability["neutral_point"][0], 0.04 - stability["static_margin"], 1e-12)
        text = self.run_well(*flying)
        self.assertIn("    glide ratio   %.4g" % trim["glide_ratio"], text.output)
        self.assertEqual(text.errors, "")

    def test_where_there_is_no_trim_a_sentence_says_so(self):
        _, file = self.build(BALL)
        flying = "inspect", file, "--fly", "--mass", 30
        result = self.run_well(*flying, "--centre-of-mass", 0, 0, -0.1, "--json")  # the drag acts above it
        self.assertEqual(result.errors, "it has no trim: at no upright incidence from -30 to 30 degrees it is in balance; its nose goes up: "
                                        "move its mass ahead\n")
        self.assertEqual(list(json.loads(result.output)["flying"]), ["best_glide"])
        self.assertEqual(self.refusal("inspect", file, "--fly", status=2), "--fly: needs --mass")
        self.assertEqual(self.refusal(*flying, "--density", 998, status=2),
                         "--fly: needs both --density and --viscosity of a fluid, or none: air")


ATTACK, SIDE_SLIP, LIFT, DRAG, SIDE, ROLL, PITCH, YAW = range(8)


class PolarTest(CommandTest):
    def polar(self, file, *more):
        header, *rows = self.run_well("polar", file, *more).output.splitlines()
        self.assertEqual(header, "attack,side_slip,C_L,C_D,C_Y,C_l,C_m,C_n")
        return [[float(cell) for cell in row.split(",")] for row in rows]

    @staticmethod
    def munk_pitch(facts, attack, area, length):
        """C_m of Munk's moment v x (A v) at an angle of attack [rad]."""
        v = math.cos(attack), 0, -math.sin(attack)
        p = [sum(facts["added_mass"][3 + i][3 + j] * v[j] for j in range(3)) for i in range(3)]
        return 2 * (v[2] * p[0] - v[0] * p[2]) / (area * length)

    def test_a_flat_plate_has_its_closed_form(self):
        # Slip velocity on the windward side is V cos a: C_N = cos^2 a.
        facts, file = self.build({"type": "sheet", "size": [2, 3], "faces": 200})
        rows = self.polar(file, "--attack", "-30:60:30", "--law", "published")
        self.assertEqual([round(row[ATTACK], 9) for row in rows], [-30, 0, 30, 60])
        for row in rows:
            a = math.radians(row[ATTACK])
            self.expect_close(row[LIFT], ((a > 0) - (a < 0)) * math.cos(a)**3, 1e-8)
            self.expect_close(row[DRAG], math.cos(a)**2 * abs(math.sin(a)), 1e-8)
            self.expect_close(row[PITCH], self.munk_pitch(facts, a, 6, 2), 1e-8)
            # Rounding, such as a C_l of 1e-17, is not printed.
            self.assertEqual([row[SIDE], row[ROLL], row[YAW]], [0, 0, 0])

    def test_an_oblique_spheroid_agrees_with_quadrature(self):
        # Surface integrals of the model over the smooth body: F / (rho/2), T / (rho/2) at V = 1.
        facts, file = self.build({"type": "ellipsoid", "semi_axes": [1, 1, 0.2], "faces": 5000})
        row, = self.polar(file, "--attack", "30", "--reference-area", "1", "--reference-length", "1", "--law", "published")
        force_x, force_z, torque_y = -0.03831223759085936, 2.1569881366057917, 0.22698823654312306
        c, s = math.cos(math.pi / 6), 0.5
        # Error of the facets of 5000 triangles; measured 3.9e-3.
        self.expect_close(row[LIFT], force_x * s + force_z * c, 5e-3)
        self.expect_close(row[DRAG], -force_x * c + force_z * s, 5e-3)
        self.expect_close(row[PITCH], self.munk_pitch(facts, math.pi / 6, 1, 1) - torque_y, 5e-3)

    def test_side_slip_and_other_axes_are_the_same_body_turned(self):
        angles = "--attack", "20", "--side-slip", "-15"
        wing = moved(box((1, 3, 0.2), 8), (0.3, 0.4, 0.5))
        row, = self.polar(self.build(obj_text(wing))[1], *angles)
        turned = [(-y, -z, x) for x, y, z in wing[0]], wing[1]  # maps forward x to z, up z to -y
        same, = self.polar(self.build(obj_text(turned))[1], *angles, "--forward", "z", "--up", "-y")
        for k in range(LIFT, YAW + 1):
            self.expect_close(same[k], row[k], 1e-8)
        self.assertGreater(abs(row[SIDE]), 1e-3)

    def test_wind_from_the_right_pushes_to_the_left(self):
        _, ball = self.build({"type": "ellipsoid", "semi_axes": [1, 1, 1], "faces": 1280})
        for row in self.polar(ball, "--attack", "0", "--side-slip", "0:40:40"):
            # Drag of a ball turns with the flow: 1/2 of its silhouette. Force across the flow comes from the facets.
            self.expect_close(row[DRAG], 0.5, 5e-3)
            self.expect_close(row[SIDE], 0, 1e-2)
        _, fin = self.build({"type": "box", "half_sizes": [1, 0.02, 1], "faces": 800})
        row, = self.polar(fin, "--attack", "0", "--side-slip", "20", "--reference-area", "4", "--reference-length", "1")
        self.assertLess(row[SIDE], -0.1)

    def test_drag_over_reynolds_numbers_is_that_of_stokes_to_the_crisis(self):
        # Any length and density: a ball is the ball that it is printed beside.
        _, file = self.build({"type": "sphere", "radius": 3, "faces": 80})
        result = self.run_well("polar", file, "--reynolds", "1e-3:1e6:1")
        self.assertEqual(result.errors, "Reynolds number on D_A = sqrt(area/pi) = 6 m, C_D on 28.2743339 m^2\n")
        header, *rows = result.output.splitlines()
        self.assertEqual((header, len(rows)), ("Re,C_D,C_D_of_ball", 10))
        for i, row in enumerate(rows):
            reynolds, drag, ball = map(float, row.split(","))
            self.expect_close(reynolds * 10**(3 - i), 1, 1e-8)
            self.expect_close(drag / ball, 1, 1e-8)
            if i == 0:
                self.expect_close(drag * reynolds / 24, 1, 1e-3)
        self.assertLess(drag, 0.15)  # beyond the crisis
        _, flat = self.build({"type": "sheet", "size": [2, 3], "faces": 200})
        self.assertEqual(self.refusal("polar", flat, "--reynolds", "1:10", "--roughness", "1e-4"),
                         flat + ": has no area seen along --forward: give --reference-area")

    def test_a_drag_table_that_is_refused_begins_with_nothing(self):
        _, file = self.build({"type": "sphere", "radius": 3, "faces": 80})
        self.assertIn("roughness [m] is 100, must be from 0 to 10.6", self.refusal("polar", file, "--reynolds", "1:10", "--roughness", 100))

    def test_coefficients_that_are_not_finite_are_refused(self):
        _, file = self.build(obj_text(CUBE))
        self.assertEqual(self.refusal("polar", file, "--speed", "1e200"), file + ": a coefficient at an angle of attack of -90 "
                         "degrees is not finite: speed or reference is too large or too small")


if __name__ == "__main__":
    programs.main()
