"""Tasks that gymnasium.make_vec() finds by name, docs/worlds.md."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import numpy.typing as npt

from .vector_env import VectorEnv
from .worlds import Gust, WorldBatch, observe

# Published drags of nearly this vehicle differ by 5 to 10 times, and added masses by 2 to 3 times: docs/worlds.md.
_VARY = {
    "loads": (0.5, 1.5),
    "added_mass": (0.5, 1.3),
    "mass": (0.98, 1.02),
    "position": (-1, 1),
    "attitude": (-0.3, 0.3),
    "current": ((-0.4, -0.4, -0.1), (0.4, 0.4, 0.1)),
}
# Settings of WorldBatch("rov_station", ...): env steps of 0.05 s.
STATION: dict[str, Any] = {
    "substeps": 10,
    "most_steps": 200,
    "actions": ["thrusters"],
    "observations": ["target", observe("rotation", rows=[3, 6, 7]), "twist"],
    "vary": _VARY,
    "gust": Gust(0.05, 3.0),
}


def station_cost(batch: WorldBatch) -> npt.NDArray[np.float64]:
    """Returns the costs (N,) of the last env step: distance [m], 0.5 for a quarter of a turn off the heading, 0.02 for full thrust."""
    away = np.linalg.norm(batch["target"], axis=1)
    cost: npt.NDArray[np.float64] = away + 0.5 * np.abs(batch["rotation"][:, 0]) + 0.02 * (batch.actions**2).mean(1)
    return cost


class Station(VectorEnv):
    """A vehicle with six thrusters holds its place in a current that it does not know, "bullet_ambient/Station-v0".

    num_envs : worlds
    settings : those of VectorEnv and WorldBatch, in place of STATION's
    """

    def __init__(self, num_envs: int = 1, **settings: Any) -> None:
        super().__init__("rov_station", num_envs, **{**STATION, **settings})

    def reward(self, batch: WorldBatch) -> npt.ArrayLike:
        """Returns 1 - station_cost() (N,)."""
        return 1 - station_cost(batch)

    def ended(self, batch: WorldBatch) -> npt.ArrayLike:
        """Ends a world whose vehicle is 5 m away (N,)."""
        return np.asarray(np.linalg.norm(batch["target"], axis=1) > 5)


try:
    importlib.import_module("gymnasium").register(id="bullet_ambient/Station-v0", vector_entry_point="bullet_ambient.tasks:Station")
except ImportError:
    pass
