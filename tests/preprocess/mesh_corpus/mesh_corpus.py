#!/usr/bin/env python3
"""Which share of the mesh files of some folders can be built, by ambient_preprocess check.

    mesh_corpus.py build/release/bin/ambient_preprocess FOLDER ... [--most N] [--list FILE]

prints a table with one row per folder and the reasons of refusals. Files without triangles, which
hold points or an animation, and those that their reader refuses, do not count.
"""
import argparse
import collections
import json
import pathlib
import subprocess

ENDINGS = set(".3ds .3mf .ac .amf .ase .b3d .blend .dae .dxf .fbx .glb .gltf .lwo .ms3d .obj .off .ply .stl .wrl .x "
              ".x3d".split())
UNREADABLE = ("there are no triangles", "all triangles are points", "cannot be read", "the file is empty",
              "is damaged", "no mesh", "refers to vertex", "cut short", "announces")


def mesh_files(folder, most):
    """At most so many, evenly chosen."""
    files = sorted(p for p in pathlib.Path(folder).rglob("*") if p.suffix.lower() in ENDINGS and p.is_file())
    if most and len(files) > most:
        files = [files[i * len(files) // most] for i in range(most)]
    return files


def check(program, file, seconds):
    """The JSON of check, or the line in which the file was refused."""
    try:
        run = subprocess.run([program, "check", "--strict", "--json", str(file)], capture_output=True, text=True, timeout=seconds,
                             errors="replace")
    except subprocess.TimeoutExpired:
        return f"took more than {seconds} s"
    if run.stdout.startswith("{"):
        return json.loads(run.stdout)
    return run.stderr.strip() or f"status {run.returncode}"


def verdict(result):
    """'as it is', '--sheet', '--wrap' or 'refused'; None if the file holds no triangles."""
    if isinstance(result, str):
        return None if any(word in result for word in UNREADABLE) else "refused"
    if result["usable"]:
        return "as it is"
    for option in ("--sheet", "--wrap"):
        if any(r["option"] == option and r["usable"] for r in result["remedies"]):
            return option
    return "refused"


def kinds(result):
    return [result] if isinstance(result, str) else sorted({d["kind"] for d in result["defects"]})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--most", type=int, default=0, help="files per folder; 0: all")
    parser.add_argument("--seconds", type=int, default=120, help="per file")
    parser.add_argument("--list", help="writes file, verdict and reasons, one line each")
    arguments = parser.parse_args()
    total, reasons, lines = collections.Counter(), collections.Counter(), []
    print("| folder | files | as they are | also --sheet | also --wrap | refused |\n|---|---|---|---|---|---|")
    for folder in arguments.folders:
        counts = collections.Counter()
        for file in mesh_files(folder, arguments.most):
            result = check(arguments.program, file, arguments.seconds)
            found = verdict(result)
            lines.append(f"{file}\t{found}\t{'; '.join(kinds(result))}")
            if found is None:
                continue
            counts[found] += 1
            if found != "as it is":
                reasons.update(kinds(result))
        print_row(pathlib.Path(folder).name, counts)
        total.update(counts)
    print_row("all", total)
    for reason, count in reasons.most_common(12):
        print(f"{count:6d}  {reason}")
    if arguments.list:
        pathlib.Path(arguments.list).write_text("\n".join(lines) + "\n")


def print_row(name, counts):
    files = sum(counts.values())
    share = [f"{100 * n / files:.0f} %" if files else "-" for n in
             (counts["as it is"], counts["as it is"] + counts["--sheet"], files - counts["refused"])]
    print(f"| {name} | {files} | {' | '.join(share)} | {counts['refused']} |", flush=True)


if __name__ == "__main__":
    main()
