"""Settings of fluids and of the flow along bodies: frozen, keyword-only, equal by value."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, fields
from numbers import Real
from typing import Any

import numpy as np

from . import _core

_KINDS: dict[type, Any] = {float: Real, bool: object, str: str}


def _converted(value: Any, default: Any) -> Any:
    """Returns a value as the type of its default. Raises TypeError or ValueError if it is none."""
    if isinstance(default, tuple):
        x, y, z = (_converted(number, 0.0) for number in value)
        return x, y, z
    if not isinstance(value, _KINDS[type(default)]):
        raise TypeError
    return type(default)(value)


def _convert(settings: Any) -> None:
    for field in fields(settings):
        value = getattr(settings, field.name)
        try:
            object.__setattr__(settings, field.name, _converted(value, field.default))
        except (TypeError, ValueError):
            raise TypeError(f"{type(settings).__name__}.{field.name} cannot be {value!r}") from None


@dataclass(frozen=True, kw_only=True)
class Medium:
    """Fluid around a body; vectors in world axes.

    density : [kg/m^3], >= 0; default 0, a vacuum
    viscosity : dynamic viscosity [Pa s], >= 0; 0: no skin friction
    velocity : of the undisturbed flow at the body [m/s]
    acceleration : rate of change of that velocity [m/s^2]
    """

    density: float = 0.0
    viscosity: float = 0.0
    velocity: Sequence[float] = (0.0, 0.0, 0.0)
    acceleration: Sequence[float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        _convert(self)
        _core._check_medium(self)


@dataclass(frozen=True, kw_only=True)
class FlowSettings:
    """Settings of the flow along the surface of a body.

    roughness : height of the roughness of the surface with the law "form" [m]; default 0, smooth
    separation_angle : from pi/2 (default) to pi [rad], with the law "published"; larger: flow stays attached longer
    skin_friction : False: no friction and no resistance of the viscosity
    law : of the pressure: "form" (default) or "published"
    maximum_load_error : largest relative error of reduced loads, from 0 (sums all faces) to 1; default 0.01
    stall_lag : time by which stall lags with the law "form", in body lengths over speed; 0: none
    """

    roughness: float = 0.0
    separation_angle: float = np.pi / 2
    skin_friction: bool = True
    law: str = "form"
    maximum_load_error: float = 0.01
    stall_lag: float = 4.5

    def __post_init__(self) -> None:
        _convert(self)
        _core._check_flow(self)
        if self.law == "form" and self.separation_angle != type(self).separation_angle:
            warnings.warn("FlowSettings.separation_angle: only the law \"published\" reads it; the law \"form\" has roughness",
                          stacklevel=3)
