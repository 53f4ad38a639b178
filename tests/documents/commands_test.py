#!/usr/bin/python3
"""Looks up the programs and options of the commands of the pages that are not run: commands_test.py BUILD_DIR"""

import json
import os
import re
import subprocess
import sys
import unittest
from functools import cache
from pathlib import Path

from blocks import COMMANDS, ROOT, all_blocks, pages

BUILD = None
REFERENCE = ROOT / "docs/file_format.md"  # its forms have all options
MODULE = "bullet_ambient"
PROGRAMS = ("ambient_demo", "ambient_preprocess", MODULE)
OTHERS = ". build/crates cd conan cp ctest npm parallel pip python3 sbatch seq snakemake tar vcpkg".split()
INLINE = re.compile(r"`((?:ambient_(?:demo|preprocess) |build/\w+/bin/|demos/run|tests/run|cmake |ctest )[^`]*)`")
OPTION = re.compile(r"(?<![\w:=-])--?[a-z][a-z_-]*")


@cache
def words_of(*patterns):
    files = [file for pattern in patterns for file in ROOT.glob(pattern) if "build" not in file.relative_to(ROOT).parts]
    return frozenset(re.findall(r"[\w-]+", "\n".join(file.read_text() for file in files)))


@cache
def options_of(program, command):
    """What --help of one of the two programs, or of the Python module, shows: for each option its names."""
    run = [sys.executable, "-m", program] if program == MODULE else [BUILD / "bin" / program]
    environment = {**os.environ, "PYTHONPATH": str(BUILD / "python")}
    question = [*run, *([command] if command else []), "--help"]
    shown = subprocess.run(question, capture_output=True, text=True, check=True, env=environment).stdout
    return [set(names.split(",")) for names in re.findall(r"^  (-[\w,-]+)", shown, re.MULTILINE)]


def command_lines(block):
    """Single commands: continued lines joined, comments and redirections of output left out."""
    text = re.sub(r"(^|\s)#.*", "", re.sub(r"\\\n|\n {2,}", " ", block.text))
    for line in re.split("\n" if "usage" in block.notes else r"&&|[;|\n]", text):
        words = [word for word in line.split() if not re.match(r"\w+=", word)]
        while words and words[0] in ("do", "done", "for"):
            words = words[1:] if words[0] == "do" else []
        if words[:3] == ["/usr/bin/python3", "-m", MODULE]:
            yield MODULE, words[3:]
        elif words:
            yield words[0], words[1:]


def wrong_in_cmake(words):
    presets = {preset["name"] for preset in json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]}
    targets = words_of("**/CMakeLists.txt")
    settings = targets | words_of("CMakeLists.txt", "**/*.cmake")
    after = dict(zip(words, words[1:]))
    if after.get("--preset", "release") not in presets:
        yield f"there is no preset {after['--preset']}"
    for target in words[words.index("--target") + 1 :] if "--target" in words else []:
        if target.removesuffix("-float64") not in targets:
            yield f"there is no target {target}"
    for setting in re.findall(r"-D(BULLET_AMBIENT_\w+)=", " ".join(words)):
        if setting not in settings:
            yield f"CMake knows no {setting}"


def wrong_options(program, words):
    used = set(OPTION.findall(" ".join(words)))
    if program in PROGRAMS:
        command = words[0] if program == "ambient_preprocess" else None
        known = set().union(*options_of(program, command))
    else:
        known = words_of("tests/**/*.cpp", "demos/**/*.cpp", "preprocess/**/*.cpp")
    return (f"{program} has no {option}" for option in used - known if not option.startswith(("--benchmark_", "--gtest_")))


def wrong_in_command(program, words):
    """What a command names that is not there."""
    name = re.sub(r"^build/\w+/bin/", "", program)
    script = ROOT / program
    if name == MODULE:
        return list(wrong_options(name, words))
    if name != program or name.startswith("ambient_"):
        if name.removesuffix("-float64") not in words_of("**/CMakeLists.txt"):
            return [f"there is no target {name}"]
        return list(wrong_options(name, words))
    if program == "cmake":
        return list(wrong_in_cmake(words))
    if program == "/usr/bin/python3":
        script = ROOT / words[0]
    if script.is_file():
        missing = [] if os.access(script, os.X_OK) or script.name != Path(program).name else [f"{program} is not executable"]
        used = OPTION.findall(" ".join(words))
        return missing + [f"{program} does not read {option}" for option in used if option not in script.read_text()]
    known = program in OTHERS or (ROOT / "demos/sweep/recipes" / program).is_file()
    return [] if known else [f"there is no {program}"]


class CommandTest(unittest.TestCase):
    def test_commands_that_are_not_run_have_programs_and_options(self):
        for block in all_blocks(COMMANDS):
            if block.notes.keys() & {"not run", "usage"}:
                wrong = [text for command in command_lines(block) for text in wrong_in_command(*command)]
                with self.subTest(block=str(block)):
                    self.assertEqual(wrong, [])

    def test_commands_within_sentences_have_programs_and_options(self):
        for page in pages():
            text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
            for code in INLINE.findall(text):
                program, *words = code.split()
                with self.subTest(page=page.name, code=code):
                    self.assertEqual(list(wrong_in_command(program, words)), [])

    def test_pages_that_name_a_benchmark_or_a_study_say_how_it_is_built(self):
        files = [*ROOT.glob("tests/benchmark/*.cpp"), *ROOT.glob("tests/**/*_study.cpp")]
        benchmarks = [file.stem for file in files] + ["bin/work_precision"]
        for page in pages():
            text = page.read_text()
            if any(name in text for name in benchmarks):
                self.assertRegex(text, "BULLET_AMBIENT_BENCHMARKS=ON|CONTRIBUTING.md#benchmarks", page.name)

    def test_the_reference_has_all_options(self):
        shown = {}
        for block in all_blocks(COMMANDS):
            if block.page == REFERENCE and "usage" in block.notes:
                for program, words in command_lines(block):
                    key = program, words[0] if program == "ambient_preprocess" else None
                    shown.setdefault(key, set()).update(OPTION.findall(" ".join(words)))
        for (program, command), options in shown.items():
            if program in PROGRAMS:
                with self.subTest(program=program, command=command):
                    missing = [names for names in options_of(program, command) if not names & (options | {"--help"})]
                    self.assertEqual(missing, [])


if __name__ == "__main__":
    BUILD = Path(sys.argv.pop(1)).resolve()
    unittest.main()
