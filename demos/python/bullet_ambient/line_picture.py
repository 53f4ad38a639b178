"""Pictures of lines, by NumPy alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.float64]


def camera_for(points: npt.ArrayLike) -> tuple[_Floats, _Floats]:
    """Returns where a camera sees all points (..., 3) from, and what it looks at, (3,) each [m]; z is up."""
    flat = np.asarray(points, np.float64).reshape(-1, 3)
    low, high = (flat.min(0), flat.max(0)) if len(flat) else (np.zeros(3), np.ones(3))
    at = (low + high) / 2
    return at + 1.3 * max(float(np.linalg.norm(high - low)), 1e-6) * np.array([-0.6, -0.7, 0.4]), at


def _clipped(a: _Floats, b: _Floats, height: int, width: int) -> tuple[Any, Any]:
    """Shares of the ways from a to b, (L, 2), between which they are in the picture; the first above the second: nowhere."""
    low, high = np.zeros(len(a)), np.ones(len(a))
    for axis, end in ((0, width - 1), (1, height - 1)):
        way = b[:, axis] - a[:, axis]
        ends = (np.array([[0.0], [end]]) - a[:, axis]) / np.where(way == 0, 1e-12, way)
        low, high = np.maximum(low, ends.min(0)), np.minimum(high, ends.max(0))
    return low, high


def picture(
    points: npt.ArrayLike, colours: npt.ArrayLike, eye: npt.ArrayLike, at: npt.ArrayLike, size: tuple[int, int] = (360, 480)
) -> npt.NDArray[np.uint8]:
    """Draws lines as a camera sees them on white, 50 degrees high; later lines lie over earlier ones.

    points, colours : (L, 2, 3) [m]; (L, 3), red, green, blue from 0 to 1
    eye, at : place of the camera, and a point in the middle of the picture, (3,) [m]; z is up
    size : height and width of the picture
    Returns (height, width, 3)
    """
    height, width = size
    image = np.full((height, width, 3), 255, np.uint8)
    seen = np.asarray(points, np.float64) - np.asarray(eye, np.float64)
    ahead = np.asarray(at, np.float64) - np.asarray(eye, np.float64)
    near, ahead = 1e-3 * np.linalg.norm(ahead), ahead / np.linalg.norm(ahead)
    right = np.cross(ahead, (0, 0, 1) if abs(ahead[2]) < 0.999 else (0, 1, 0))
    right /= np.linalg.norm(right)
    seen = seen @ np.stack([right, np.cross(ahead, right), ahead], axis=1)  # to the right, down, ahead
    is_ahead = seen[..., 2].max(1, initial=-np.inf) > near
    seen, paint = seen[is_ahead], (255 * np.asarray(colours, np.float64)[is_ahead]).clip(0, 220).astype(np.uint8)
    for one, other in ((0, 1), (1, 0)):  # ends behind the camera move to its plane
        depth, way = seen[:, one, 2], seen[:, other] - seen[:, one]
        share = np.where(depth < near, (near - depth) / np.where(way[:, 2] == 0, 1, way[:, 2]), 0)
        seen[:, one] += share[:, None] * way
    pixels = seen[..., :2] / seen[..., 2:] * (height / 2 / np.tan(np.radians(25))) + np.array([width - 1, height - 1]) / 2
    a, b = pixels[:, 0], pixels[:, 1]
    low, high = _clipped(a, b, height, width)
    steps = np.where(low <= high, np.ceil(np.abs(b - a).max(1, initial=0) * (high - low)) + 1, 0).astype(np.int64)
    line = np.repeat(np.arange(len(a)), steps)
    place = np.arange(len(line)) - np.repeat(np.cumsum(steps) - steps, steps)
    share = low[line] + (high - low)[line] * place / np.maximum(steps[line] - 1, 1)
    column, row = np.rint(a[line] + share[:, None] * (b - a)[line]).astype(np.int64).T
    image[row.clip(0, height - 1), column.clip(0, width - 1)] = paint[line]
    return image
