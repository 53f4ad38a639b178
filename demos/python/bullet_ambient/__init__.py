"""Rigid bodies of Bullet in air or water: added mass, pressure with separation, friction, buoyancy.

SI units throughout; 6-vectors hold rotation first; quaternions are w, x, y, z. Arrays are float64. Bad numbers raise
ValueError, files that cannot be used OSError, in one line that says what is wrong.
"""

from ._core import (
    Body,
    FluidBody,
    Loads,
    Motion,
    Robot,
    Scene,
    World,
    air,
    library_version,
    scene_names,
    water,
)
from .cases import CaseCounts, collect, run_cases, write_cases
from .settings import FlowSettings, Medium
from .sweeps import Rollout, rollout
from .tasks import Station
from .vector_env import VectorEnv
from .winds import (
    air_layers,
    current_profile,
    discrete_gust,
    dryden_gusts,
    flow_velocity,
    gauss_markov_gusts,
    layers,
    standard_atmosphere,
    turbulence,
    wind_profile,
)
from .worlds import Gust, WorldBatch, act, observe

__version__ = library_version.split()[1].rstrip(",")

__all__ = [
    "Body",
    "CaseCounts",
    "FlowSettings",
    "FluidBody",
    "Gust",
    "Loads",
    "Medium",
    "Motion",
    "Robot",
    "Rollout",
    "Scene",
    "Station",
    "VectorEnv",
    "World",
    "WorldBatch",
    "act",
    "air",
    "air_layers",
    "collect",
    "current_profile",
    "discrete_gust",
    "dryden_gusts",
    "flow_velocity",
    "gauss_markov_gusts",
    "layers",
    "library_version",
    "observe",
    "rollout",
    "run_cases",
    "scene_names",
    "standard_atmosphere",
    "turbulence",
    "water",
    "wind_profile",
    "write_cases",
]
