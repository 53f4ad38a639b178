"""Many runs at a time, in memory."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

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


def _columns() -> dict[str, tuple[str | int, ...]]:
    """Returns the columns of a summary, with their places in a body's entry of summary.json."""
    places: dict[str, tuple[str | int, ...]] = {"body": ("name",), "mass": ("mass",), "end_time": ("end", "time")}
    for vector, axes in (("position", "xyz"), ("orientation", "wxyz"), ("linear_velocity", "xyz"), ("angular_velocity", "xyz")):
        places.update({f"end_{vector}_{axis}": ("end", vector, i) for i, axis in enumerate(axes)})
    places["path_length"] = ("path", "length")
    places.update({name: ("path", name) for name in ("largest_speed", "largest_height")})
    places["landing_time"] = ("path", "landing", "time")
    places.update({f"landing_{axis}": ("path", "landing", "position", i) for i, axis in enumerate("xyz")})
    fall = ("mode", "overturns", "swings", "turns", "largest_swing", "descent_speed", "drift_speed")
    places.update({name: ("fall", name) for name in fall})
    places.update({name: ("work", name) for name in ("substeps", "load_evaluations")})
    places["guarded_evaluations"] = ("work", "guarded")
    places.update({f"{name}_steps": ("work", name) for name in ("coarse", "halted")})
    places["energy_removed"] = ("work", "energy_removed")
    return places


_COLUMNS = _columns()


def _cell(name: str, body: Any) -> str | float:
    """Returns a word or a number of a body's entry of summary.json; "" or NaN if it has none."""
    value = body
    for step in _COLUMNS[name]:
        value = value.get(step) if isinstance(value, dict) else value and value[step]
    if name in ("body", "mode"):
        return value or ""
    return float("nan") if value is None else float(value)


def _rows(summary: str) -> list[list[str | float]]:
    """Converts the text of a summary.json to one row per body: end pose, path, fall and computational work."""
    return [[_cell(name, body) for name in _COLUMNS] for body in json.loads(summary)["bodies"]]


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
    if not runs:
        raise ValueError("there are no scenes")
    bodies = [len(scene.bodies) for scene in runs]
    for i, count in enumerate(bodies):
        if count != bodies[0]:
            raise ValueError(f"scene {i} has {count} bodies, scene 0 has {bodies[0]}")
    rows: list[list[list[str | float]]] = [[[float("nan")] * len(_COLUMNS)] * bodies[0] for _ in runs]

    def take(index: int, summary: str, *_: str) -> None:
        rows[index] = _rows(summary)

    more = {"threads": threads, "motion": motion, "texts": False, "cache": cache, "report": True, "progress": progress}
    arrays, errors = _core._run_scenes(runs, take, **more)
    table = _structured(list(_COLUMNS), [row for run in rows for row in run])
    return Rollout(arrays, table.reshape(len(runs), -1), errors)
