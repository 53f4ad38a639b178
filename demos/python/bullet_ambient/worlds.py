"""Many worlds of one scene that step by one call."""

from __future__ import annotations

import operator
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, SupportsIndex, Union

import numpy as np
import numpy.typing as npt

from . import _core

_Floats = npt.NDArray[np.float64]
_Mask = npt.NDArray[np.bool_]
_Path = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class Gust:
    """Gusts of all fluids of a world, alike everywhere in it: `gauss_markov_gusts` of a seed for each world and episode at
    the ends of env steps, linear in between.

    intensity : standard deviation [m/s], one number for all axes or three
    time : in which a gust forgets itself [s]
    """

    intensity: float | Sequence[float]
    time: float = 1.0


def observe(
    kind: str,
    body: str = "",
    *,
    rows: Sequence[int] = (),
    place: Sequence[float] = (0, 0, 0),
    noise: float = 0,
    bias: float = 0,
) -> dict[str, Any]:
    """Describes an observation of a WorldBatch; docs/worlds.md lists the kinds.

    body : its name; default: the first that moves
    rows : numbers of it that are wanted; default: all
    place : of a sensor, from the centre of mass, axes of the body's shape [m]
    noise : standard deviation of each reading
    bias : standard deviation of what an episode adds to all of its readings
    """
    return {"kind": kind, "body": body, "rows": list(rows), "place": list(place), "noise": noise, "bias": bias}


def act(kind: str, body: str = "", *, rows: Sequence[int] = (), scale: float = 1) -> dict[str, Any]:
    """Describes an action of a WorldBatch: "thrusters", "foils", "wrench", "wrench_world", "joint_torque", "motor_position" or "motor_velocity".

    body : its name; default: the first that moves
    rows : numbers of it that are actions, all others are 0; default: all
    scale : factor on the actions
    """
    return {"kind": kind, "body": body, "rows": list(rows), "scale": scale}


def _seed(value: SupportsIndex) -> int:
    seed = operator.index(value)
    if not 0 <= seed < 2**64:
        raise ValueError(f"seed is {seed}; must be from 0 to 2^64 - 1")
    return seed


def _variation(name: str, bounds: Sequence[Any]) -> dict[str, Any]:
    kind, _, body = name.partition(":")
    count = len(bounds) if hasattr(bounds, "__len__") else 0
    is_logarithmic = count == 3 and bounds[2] == "log"
    if count != 2 and not is_logarithmic:
        raise ValueError(f"vary[{name!r}] is {bounds!r}; must be (lowest, highest) or (lowest, highest, \"log\")")
    low, high = (np.atleast_1d(np.asarray(bound, dtype=np.float64)) for bound in bounds[:2])
    return {"kind": kind, "body": body, "lowest": low, "highest": high, "is_logarithmic": is_logarithmic}


def _fields(name: str, given: Sequence[str | dict[str, Any]], describe: Callable[[str], dict[str, Any]]) -> list[dict[str, Any]]:
    fields = [describe(of) if isinstance(of, str) else of for of in ([given] if isinstance(given, str) else given)]
    for index, of in enumerate(fields):
        if not isinstance(of, dict):
            raise TypeError(f"{name}[{index}] is {of!r}; must be a word or what {describe.__name__}() returns")
    return fields


def _columns(what: str, name: str, known: dict[str, slice]) -> slice:
    if name not in known:
        raise KeyError(f"{name} is not {what} here; there are {sorted(known)}")
    return known[name]


class WorldBatch(_core._WorldBatch):
    """N worlds of one scene that step by one call: actions (N, A) in, observations (N, O) out.

    The same bits at any number of threads, and as N batches of one world with the seeds seed, seed + 1, ... A world whose
    state is not finite fails: it stands still, with observations of NaN, until its reset; the others go on. Other threads of
    Python run meanwhile. One thread at a time may use a batch.

    Parameters
    ----------
    scene : Scene, or what makes one
    worlds : N
    substeps : steps of the scene in an env step, under one action
    most_steps : env steps after which a world is truncated; 0: never
    seed : of the first world; those of the others follow
    threads : 0: all cores
    actions, observations : words, or what act() and observe() return
    vary : {"mass": (0.9, 1.1), "current": ((-1, -1, 0), (1, 1, 0)), "loads:hull": (0.5, 2, "log"), ...}: what each episode
        draws, between two bounds
    gust : Gust
    cache : folder in which fluid bodies are stored and found again; default: the user's, docs/python.md

    >>> batch = WorldBatch("sphere_fall", 3, observations=["position"], vary={"mass": (1, 2)}, threads=1)
    >>> batch.step()
    >>> batch["position"].shape
    (3, 3)
    >>> bool(batch.parameter("mass")[0] == batch.parameter("mass")[1])
    False
    """

    def __init__(
        self,
        scene: _core.Scene | _Path | dict[str, Any],
        worlds: int = 1,
        *,
        substeps: int = 1,
        most_steps: int = 0,
        seed: int = 0,
        threads: int = 0,
        actions: Sequence[str | dict[str, Any]] = (),
        observations: Sequence[str | dict[str, Any]] = (),
        vary: Mapping[str, Sequence[Any]] | None = None,
        gust: Gust | None = None,
        cache: _Path | None = None,
    ) -> None:
        settings: dict[str, Any] = {"worlds": worlds, "substeps": substeps, "most_steps": most_steps, "seed": _seed(seed)}
        settings.update(threads=threads, cache=cache)
        settings["actions"] = _fields("actions", actions, act)
        settings["observations"] = _fields("observations", observations, observe)
        if not isinstance(vary or {}, Mapping):
            raise TypeError(f"vary is {vary!r}; must be a dict of keys and bounds")
        settings["variations"] = [_variation(name, bounds) for name, bounds in (vary or {}).items()]
        if gust is not None:
            if not isinstance(gust, Gust):
                raise TypeError(f"gust is {gust!r}; must be a Gust, as Gust(0.1, time=3.0)")
            sigma = np.broadcast_to(np.asarray(gust.intensity, dtype=np.float64), 3)
            settings["gust"] = {"intensity": sigma, "time": gust.time}
        self.scene = scene if isinstance(scene, _core.Scene) else _core.Scene(scene)
        super().__init__(self.scene, settings)
        self.worlds, self.substeps, self.most_steps = worlds, substeps, most_steps
        self._observed = {name: slice(at, at + size) for name, at, size in self.observation_fields}
        self._varied = {name: slice(at, at + size) for name, at, size in self.parameter_fields}
        self._acted = {name: slice(at, at + size) for name, at, size in self.action_fields}

    @property
    def env_step(self) -> float:
        """Duration of an env step [s]."""
        return self.substeps * self.scene.time_step

    def __getitem__(self, name: str) -> _Floats:
        """View (N, size) of an observation, by its kind, or kind:body if a body was named."""
        return self.observations[:, _columns("observed", name, self._observed)]

    def parameter(self, name: str) -> _Floats:
        """Returns the view (N, size) of what the episodes have drawn, by the key of `vary`."""
        return self.parameters[:, _columns("varied", name, self._varied)]

    def action(self, name: str) -> _Floats:
        """Returns the view (N, size) of an action, by its kind, or kind:body if a body was named."""
        return self.actions[:, _columns("an action", name, self._acted)]

    def reset(self, mask: _Mask | None = None, seed: int | Sequence[int] | None = None, draws: bool = True) -> None:
        """Begins new episodes.

        mask : (N,) bool, which worlds; default: all
        seed : s: world i gets s + i and begins its first episode; or one for each; None: the next episode is drawn
        draws : False: takes `parameters` as they are
        """
        if isinstance(seed, (int, np.integer)):
            seed = range(int(seed), int(seed) + self.worlds)
        if mask is not None:
            mask = np.asarray(mask)
            if mask.dtype != np.bool_:
                raise TypeError(f"mask has numbers of the type {mask.dtype}; must be bool")
        self._reset(mask, None if seed is None else [_seed(of) for of in seed], draws)
