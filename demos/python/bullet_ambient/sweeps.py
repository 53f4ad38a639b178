"""Many runs at a time: in memory, or as cases of a file with their results in a folder."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core

_Path = Union[str, "os.PathLike[str]"]
_Progress = Optional[Callable[[int, int], object]]


@dataclass(frozen=True)
class Rollout:
    """Results of N runs of scenes with B bodies.

    motion : arrays of shape (N, T, B, ...), NaN where a run failed; None without motion
    summary : structured array (N, B): end position, path, fall and counts of work of each body
    errors : error messages of the runs that failed, by index
    """

    motion: _core.Motion | None
    summary: npt.NDArray[Any]
    errors: dict[int, str]

    @property
    def failed(self) -> npt.NDArray[np.int64]:
        """Indices of the runs that failed."""
        return np.array(sorted(self.errors), dtype=np.int64)

    def save(self, path: _Path) -> None:
        """Writes an .npz file with summary, failed and the arrays of the motion."""
        arrays: dict[str, npt.NDArray[Any]] = {"summary": self.summary, "failed": self.failed}
        if self.motion is not None:
            for name in ("t", "position", "orientation", "twist"):
                arrays[name] = getattr(self.motion, name)
        np.savez_compressed(path, **arrays)


class CaseCounts(NamedTuple):
    """Counts of one shard: its cases, cases that had results before, and error messages of cases that failed, by index."""

    cases: int
    done_before: int
    failures: dict[int, str]


def _structured(columns: Sequence[str], rows: Sequence[Sequence[str | float]]) -> npt.NDArray[Any]:
    """Returns rows of words and numbers as a structured array; a column with a word becomes a column of words."""

    def kind(i: int) -> str:
        words = [len(row[i]) for row in rows if isinstance(row[i], str)]  # type: ignore[arg-type]
        return f"U{max([1, *words])}" if words else "f8"

    kinds = [kind(i) for i in range(len(columns))]

    def cell(value: str | float, of: str) -> str | float:
        return value if of == "f8" or isinstance(value, str) else "" if value != value else repr(value)

    cells = [tuple(cell(value, of) for value, of in zip(row, kinds)) for row in rows]
    return np.array(cells, dtype=list(zip(columns, kinds)))


def _override_sets(overrides: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Converts {"path": N values, ...} to N dicts {"path": value, ...}."""
    lengths = {path: len(values) for path, values in overrides.items()}
    if len(set(lengths.values())) != 1:
        raise ValueError(f"overrides must have as many values each, not {lengths}")
    return [dict(zip(overrides, values)) for values in zip(*overrides.values())]


def rollout(
    scenes: _core.Scene | Sequence[_core.Scene],
    overrides: Mapping[str, Any] | None = None,
    *,
    duration: float | None = None,
    threads: int = 0,
    motion: bool = True,
    cache: _Path | None = None,
    progress: _Progress = None,
) -> Rollout:
    """Runs many scenes on all cores; the interpreter is free, and results do not depend on the threads, bit for bit.

    Parameters
    ----------
    scenes : one Scene, or one for each run, all with the same number of bodies
    overrides : with one Scene: N values for each path, {"bodies.0.mass": masses}; run i takes the i-th value of each
    duration : duration of all runs [s]; default: the scene's
    threads : number of threads; 0 (default): all cores
    motion : False: the summary alone
    cache : folder in which fluid bodies are stored and found again; default: the user's, docs/python.md
    progress : called with the numbers of ended and of all runs, by the calling thread, a few times a second at most

    A run that fails does not stop the others. Raises ValueError if a scene is not right.

    >>> from bullet_ambient import Scene
    >>> out = rollout(Scene("sphere_fall"), {"bodies.0.mass": [1, 2, 4]}, duration=0.1)
    >>> out.motion.position.shape, out.failed.size
    ((3, 7, 1, 3), 0)
    """
    if isinstance(scenes, _core.Scene):
        sets: list[dict[str, Any]] = [{}] if overrides is None else _override_sets(overrides)
        runs = [scenes.replace(one) for one in sets]
    elif overrides is not None:
        raise ValueError("overrides go with one scene")
    else:
        runs = list(scenes)
    if duration is not None:
        runs = [scene.replace({"duration": duration}) for scene in runs]
    arrays, columns, rows, errors = _core._rollout(runs, threads, motion, cache, progress)
    blank = [[float("nan")] * len(columns)] * len(runs[0].bodies)
    table = _structured(columns, [row for run in rows for row in run or blank])
    return Rollout(arrays, table.reshape(len(runs), -1), errors)


def write_cases(path: _Path, scene: str | Mapping[str, Any], overrides: Mapping[str, Any]) -> int:
    """Writes a file of cases, one per line: a scene by name, path or content, and the i-th value of each override.

    Returns the number of cases. For all combinations of values, give numpy.meshgrid(...) raveled.
    """
    sets = _override_sets(overrides)

    def plain(value: Any) -> Any:
        return value.tolist()

    lines = [json.dumps({"scene": scene, "set": one}, default=plain) + "\n" for one in sets]
    Path(path).write_text("".join(lines))
    return len(lines)


def run_cases(
    cases: _Path,
    out: _Path,
    *,
    shard: tuple[int, int] = (0, 1),
    threads: int = 0,
    motion: bool = True,
    progress: _Progress = None,
) -> CaseCounts:
    """Runs the cases of a file that have no result in the folder yet, as `ambient_demo --cases` does.

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
    return CaseCounts(*_core._run_cases(cases, out, shard, threads=threads, motion=motion, progress=progress))


def collect(cases: _Path, out: _Path) -> npt.NDArray[Any]:
    """Returns the results of finished cases in the order of the file: a structured array, one row per body.

    Columns: case, key, the overrides by their paths, and the columns of Rollout.summary.
    """
    return _structured(*_core._collect(cases, out))

