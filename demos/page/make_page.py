#!/usr/bin/python3
"""Writes one HTML file with a 3D view of runs of ambient_demo: make_page.py RUN ... -o FILE.html.

A folder SCENE-MODEL is drawn over the run of SCENE. The file needs nothing else, no network either: three.js, from
Debian's libjs-three, is written into it.
"""

import argparse
import json
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "plot"))

from files import reading, writing
from page_data import pack
from sections import sections_as_html

THREE = Path("/usr/share/javascript/three")
LIBRARY = [THREE / "three.min.js", THREE / "examples/js/controls/OrbitControls.js"]
SCRIPTS = [HERE / f"{name}.js" for name in ("motion", "slip", "body_view", "flow_arrow", "force_arrows", "hold_view", "water_view", "run_view", "scene_list", "player")]
LICENCE = "/* three.js, threejs.org, MIT licence, copyright 2010-2019 three.js authors */\n"


def script(file):
    text = file.read_text()
    if "</script" in text:
        sys.exit(f"{file}: cannot be written into a page, it contains </script")
    return f"<script>\n{LICENCE if file in LIBRARY else ''}{text}</script>"


def read_sections(file):
    with reading(file, "a Markdown file"):
        return sections_as_html(file.read_text(encoding="utf-8"))


def make_page(folders, tables):
    for file in LIBRARY:
        if not file.exists():
            sys.exit(f"{file}: is missing; the Debian package libjs-three has it")
    parts = {
        "@STYLE@": (HERE / "page.css").read_text(),
        "@TABLES@": read_sections(tables) if tables else "",
        "@RUNS@": json.dumps(pack(folders), separators=(",", ":")).replace("</", "<\\/"),
        "@SCRIPTS@": "\n".join(map(script, LIBRARY + SCRIPTS)),
    }
    page = (HERE / "template.html").read_text()
    for place, text in parts.items():
        before, after = page.split(place)
        page = before + text + after
    return page


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE")
    parser.add_argument("--tables", type=Path, metavar="MARKDOWN", help="show the sections of this file below")
    arguments = parser.parse_args()
    page = make_page(arguments.runs, arguments.tables)
    partial = arguments.output.with_name(f".{arguments.output.name}.{os.getpid()}.partial")
    with writing(arguments.output):
        partial.write_text(page, encoding="utf-8")
        partial.replace(arguments.output)
    print(f"Page: {arguments.output.resolve()}")


if __name__ == "__main__":
    main()
