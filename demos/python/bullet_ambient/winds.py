"""Winds, currents and densities for the keys "flow", "flow_above" and "layers" of a water or region of a scene.

    scene["water"]["flow_above"] = [wind_profile([0, 9, 0], roughness=0.0002), dryden_gusts(speed=9)]

Lists add up. `bullet_ambient.pybullet.Fluid` takes the same. Docs: wind.md.
"""

from collections.abc import Iterator, Sequence
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _core
from .settings import Medium

_Vector = Sequence[float]
_Flow = dict[str, dict[str, Any]]


def wind_profile(velocity: _Vector, *, height: float = 10, roughness: float = 0.03, exponent: float = 1 / 7,
                 ground: float = 0) -> _Flow:
    """Returns the mean wind over flat ground, with its velocity (3,) [m/s] at a height over it [m].

    roughness : z_0 of the logarithmic law [m]; 0: power law
    exponent : of the power law
    ground : height of ground or water in the world [m]
    """
    return {"wind_profile": {"velocity": _three(velocity), "height": height, "roughness": roughness, "exponent": exponent,
                             "ground": ground}}


def current_profile(depths: Sequence[float], velocities: Sequence[_Vector], *, surface: float = 0) -> _Flow:
    """Returns a current that is linear between depths [m] below the surface [m], N of each with velocities (N, 3) [m/s]."""
    levels = [[float(depth), *_three(velocity)] for depth, velocity in _pairs(depths=depths, velocities=velocities)]
    return {"current_profile": {"levels": levels, "surface": surface}}


def discrete_gust(velocity: _Vector, *, start: float = 0, rise: float = 1, hold: Optional[float] = 0) -> _Flow:
    """Returns a gust that rises to a velocity (3,) [m/s] and falls as half a period of 1 - cos.

    start : [s]
    rise : time from its start to its peak, and from that to its end [s]
    hold : time at its peak [s]; None: it stays
    """
    return {"discrete_gust": {"velocity": _three(velocity), "start": start, "rise": rise, "hold": hold}}


def dryden_gusts(*, height: float = 10, speed: float = 10, intensity: float = 1, direction: _Vector = (1, 0, 0),
                 seed: int = 1) -> _Flow:
    """Returns gusts by Dryden's spectra, MIL-F-8785C.

    height : over the ground, at least 3.048 [m]
    speed : at which they pass, the airspeed [m/s]
    intensity : standard deviation of the vertical part [m/s]
    direction : (3,) of the mean wind
    """
    return {"dryden_gusts": {"height": height, "speed": speed, "intensity": intensity, "direction": _three(direction),
                             "seed": seed}}


def gauss_markov_gusts(intensity: _Vector, time: float, *, seed: int = 1) -> _Flow:
    """Returns gusts whose correlation is exp(-t / time): Dryden's along the wind, in each axis.

    intensity : (3,) standard deviations [m/s]
    time : in which they forget themselves [s]
    """
    return {"gauss_markov_gusts": {"intensity": _three(intensity), "time": time, "seed": seed}}


def turbulence(*, length: float = 100, intensity: float = 1, smallest: float = 0, carried: _Vector = (0, 0, 0),
               seed: int = 1) -> _Flow:
    """Returns 64 waves with von Karman's spectrum, without the mean velocity.

    length : integral scale [m]
    intensity : standard deviation of each component [m/s]
    smallest : wavelength at which the spectrum ends [m]; 0: a hundredth of the length
    carried : (3,) velocity that carries them along [m/s]
    """
    return {"turbulence": {"length": length, "intensity": intensity, "smallest": smallest, "carried": _three(carried),
                           "seed": seed}}


def layers(heights: Sequence[float], densities: Sequence[float]) -> dict[str, Any]:
    """Returns densities [kg/m^3] at N heights [m], from the lowest up; linear in between, two of one height are a step."""
    return {"levels": [[float(height), float(density)] for height, density in _pairs(heights=heights, densities=densities)]}


def air_layers(lowest: float, highest: float) -> dict[str, Any]:
    """Returns the densities of the standard atmosphere (1976) between two heights over the sea, which has height 0 [m]."""
    return {"standard_atmosphere": [float(lowest), float(highest)]}


def standard_atmosphere(height: float) -> Medium:
    """Returns air of the standard atmosphere (1976) at a geometric height over the sea, from -5000 to 86000 [m].

    Raises ValueError for other heights.
    """
    return _core._standard_atmosphere(float(height))


def flow_velocity(flow: Sequence[_Flow], points: npt.ArrayLike, time: float = 0,
                  up: _Vector = (0, 0, 1)) -> npt.NDArray[np.float64]:
    """Returns the velocities (N, 3) [m/s] of flows that add up at points (N, 3) [m] and a time [s].

    up : (3,) against gravity
    Raises ValueError for flows that a scene would refuse.
    """
    return _core._flow_velocity(_core._json_text(list(flow), "flow"), points, float(time), up)


def _pairs(**lists: Sequence[Any]) -> Iterator[tuple[Any, Any]]:
    """Pairs of two lists, by their names for the message."""
    (first, one), (second, other) = lists.items()
    if len(one) != len(other):
        raise ValueError(f"{first} are {len(one)} and {second} {len(other)}; must be as many")
    return zip(one, other)


def _three(vector: _Vector) -> list[float]:
    x, y, z = (float(number) for number in vector)
    return [x, y, z]
