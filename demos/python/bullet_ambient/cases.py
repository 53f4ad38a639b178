"""Many runs as cases of a file, with their results in a folder."""

from __future__ import annotations

import csv
import io
import json
import os
import uuid
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core
from .sweeps import _COLUMNS, _override_sets, _Path, _Progress, _rows, _structured

_Row = list["str | float"]


class CaseCounts(NamedTuple):
    """Counts of one shard: its cases, cases that had results before, and error messages of cases that failed, by index."""

    cases: int
    done_before: int
    failures: dict[int, str]


def write_cases(path: _Path, scene: str | Mapping[str, Any], overrides: Mapping[str, Any]) -> int:
    """Writes a file of cases, one per line: a scene by name, path or content, and the i-th value of each override.

    Returns the number of cases. For all combinations of values, give numpy.meshgrid(...) raveled.
    """
    sets = _override_sets(overrides)

    def plain(value: Any) -> Any:
        return value.tolist()

    lines = [json.dumps({"scene": scene, "set": one}, default=plain) + "\n" for one in sets]
    Path(path).write_text("".join(lines), encoding="utf-8")
    return len(lines)


def _lines(cases: _Path) -> list[tuple[str, str]]:
    """Returns the lines of a file of cases but for blank ones, each with its place, as in "cases.jsonl:17".

    Bytes that are not UTF-8 are a fault of their case alone.
    """
    with Path(cases).open(encoding="utf-8-sig", errors="surrogateescape", newline="\n") as stream:
        return [(f"{os.fspath(cases)}:{number}", line) for number, line in enumerate(stream, 1) if line.strip()]


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Returns the dict of an object of JSON. Raises ValueError if it has a key twice."""
    found = dict(pairs)
    if len(found) < len(pairs):
        twice = next(key for i, (key, _) in enumerate(pairs) if key in dict(pairs[:i]))
        raise ValueError(f'key "{twice}" is given twice in one object')
    return found


def _parsed(line: str) -> tuple[Any, dict[str, Any]]:
    """Returns scene and overrides of a case, the overrides sorted by path. Raises ValueError if it is none."""
    line.encode()  # refuses bytes that are not UTF-8
    try:
        case = json.loads(line, object_pairs_hook=_object)
    except json.JSONDecodeError as error:
        raise ValueError(f"is not valid JSON: {error}") from None
    if not isinstance(case, dict):
        raise ValueError("a case must be an object")
    for key in case:
        if key not in ("scene", "set"):
            raise ValueError(f'unknown key "{key}" in a case, which has scene and set')
    if "scene" not in case:
        raise ValueError('"scene" is missing')
    if not isinstance(case["scene"], (str, dict)):
        raise ValueError('"scene" must be a name, a path or a scene')
    changes = case.get("set", {})
    if not isinstance(changes, dict):
        raise ValueError('"set" must be an object of paths and values')
    return case["scene"], dict(sorted(changes.items()))


def _scene_of(place: str, line: str) -> _core.Scene:
    """Returns the scene of a case. Paths are relative to the folder of the file. Raises ValueError that begins with the place."""
    try:
        scene, changes = _parsed(line)
        if isinstance(scene, dict):
            return _core._parse_scene(scene, place, changes)
        is_path = "/" in scene or scene.endswith(".json")
        return _core.Scene(Path(place).parent / scene if is_path else scene, changes)
    except (ValueError, OSError, RuntimeError) as error:
        text = str(error)
        raise ValueError(text if text.startswith(f"{place}: ") else f"{place}: {text}") from None


def _dumped(value: Any) -> str:
    """Returns a value as JSON without spaces."""
    return json.dumps(value, separators=(",", ":"), sort_keys=True, ensure_ascii=False)


def _result(out: Path, key: str) -> list[_Row] | None:
    """Returns the rows of a case by its key; None if there is no readable summary.json."""
    try:
        return _rows((out / key / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError, LookupError, TypeError):
        return None


def _write(file: Path, text: str) -> None:
    """Writes a file aside and renames it: it is there whole or not at all."""
    partial = file.with_name(f".{uuid.uuid4().hex}.partial")
    try:
        with partial.open("w", newline="", encoding="utf-8", errors="replace") as stream:
            stream.write(text)
        partial.replace(file)
    finally:
        partial.unlink(missing_ok=True)


def _write_result(folder: Path, summary: str, trajectory: str, geometry: str) -> None:
    """Writes the files of a run, summary.json last, and removes the partial files of runs that were killed."""
    folder.mkdir(parents=True, exist_ok=True)
    if trajectory:
        _write(folder / "trajectory.csv", trajectory)
        _write(folder / "geometry.json", geometry)
    _write(folder / "summary.json", summary)
    for partial in folder.glob(".*.partial"):
        partial.unlink(missing_ok=True)


def failed_file(out: _Path, shard: tuple[int, int] = (0, 1)) -> Path:
    """Returns the file of the cases that failed, one JSON object per line with `case` and `error`."""
    return Path(out) / ("failed.jsonl" if shard[1] == 1 else f"failed-{shard[0]}-of-{shard[1]}.jsonl")


def run_cases(
    cases: _Path,
    out: _Path,
    *,
    shard: tuple[int, int] = (0, 1),
    threads: int = 0,
    motion: bool = True,
    progress: _Progress = None,
) -> CaseCounts:
    """Runs the cases of a file that have no result in the folder yet.

    Parameters
    ----------
    cases : file of lines {"scene": name, path or scene, "set": {path: value}}
    out : folder for the results of all shards; each case has a folder there, named by its key
    shard : (i, n): cases with index i modulo n
    threads : 0 (default): all cores
    motion : False: keep summary.json alone
    progress : called with the numbers of ended and of all runs

    It may be stopped at any moment and called again, by other processes, too, and ends with the same results. Cases that
    failed are listed in `out`.
    """
    index, count = shard
    if not 0 <= index < count:
        raise ValueError(f"shard {index}/{count}: must be I/N with 0 <= I < N")
    folder = Path(out)
    lines = list(enumerate(_lines(cases)))[index::count]
    folder.mkdir(parents=True, exist_ok=True)
    pending: dict[str, tuple[int, _core.Scene]] = {}  # index of the case and scene, by key: equal cases share one result
    done_before = 0
    failures: dict[int, str] = {}
    for case, line in lines:
        try:
            scene = _scene_of(*line)
            key = scene.key
            if _result(folder, key) is not None:
                done_before += 1
            else:
                pending.setdefault(key, (case, scene))
        except (ValueError, RuntimeError) as error:
            failures[case] = str(error)
    keys, runs = list(pending), list(pending.values())

    def take(run: int, *texts: str) -> None:
        try:
            _write_result(folder / keys[run], *texts)
        except OSError as error:
            # Ignored if another shard has meanwhile run an equal case, with the same result.
            if _result(folder, keys[run]) is None:
                failures[runs[run][0]] = str(error)

    more = {"threads": threads, "motion": False, "texts": motion, "cache": folder / "fluid_bodies", "report": False}
    _, failed = _core._run_scenes([scene for _, scene in runs], take, progress=progress, **more)
    failures.update({runs[run][0]: sentence for run, sentence in failed.items()})
    list_of_failed = [_dumped({"case": case, "error": error}) + "\n" for case, error in sorted(failures.items())]
    if failures:
        _write(failed_file(folder, shard), "".join(list_of_failed))
    else:
        failed_file(folder, shard).unlink(missing_ok=True)
    return CaseCounts(len(lines), done_before, failures)


def _finished(cases: _Path, out: Path) -> Iterator[tuple[int, str, dict[str, Any], list[_Row]] | None]:
    """Yields index, key, overrides and rows of each case, or None if it is not done. run_cases() reports errors."""
    for index, (place, line) in enumerate(_lines(cases)):
        try:
            key = _scene_of(place, line).key
            rows = _result(out, key)
        except (ValueError, RuntimeError):
            rows = None
        yield None if rows is None else (index, key, _parsed(line)[1], rows)


def _table(cases: _Path, out: _Path) -> tuple[list[str], list[_Row], int]:
    """Returns columns and rows of the table of all finished cases, and the number of the others."""
    if not Path(out).is_dir():
        raise NotADirectoryError(f"{out}: is not a folder, and holds no results")
    found = list(_finished(cases, Path(out)))
    results = [result for result in found if result is not None]
    paths = sorted({path for _, _, changes, _ in results for path in changes})

    def cell(changes: dict[str, Any], path: str) -> str | float:
        value = changes.get(path, float("nan"))
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return float(value) if is_number else value if isinstance(value, str) else _dumped(value)

    rows: list[_Row] = [
        [float(index), key, *(cell(changes, path) for path in paths), *row]
        for index, key, changes, body_rows in results
        for row in body_rows
    ]
    return ["case", "key", *paths, *_COLUMNS], rows, len(found) - len(results)


def collect(cases: _Path, out: _Path) -> npt.NDArray[Any]:
    """Returns the results of finished cases in the order of the file: a structured array, one row per body.

    Columns: case, key, the overrides by their paths, and the columns of Rollout.summary.
    """
    columns, rows, _ = _table(cases, out)
    return _structured(columns, rows)


def write_table(file: _Path, columns: Sequence[str], rows: Sequence[_Row]) -> None:
    """Writes a table as CSV with a header, whole or not at all; numbers have 17 significant digits."""
    target = Path(file).resolve()  # the file that a link leads to
    if target.exists() and not target.is_file():
        raise OSError(f"{file}: is not a regular file")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([cell if isinstance(cell, str) else f"{cell:.17g}" for cell in row] for row in rows)
    _write(target, text.getvalue())
