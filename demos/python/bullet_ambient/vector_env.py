"""Gymnasium's interface of many worlds; Gymnasium need not be there."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .line_picture import camera_for, picture
from .worlds import WorldBatch


class _OwnBox:
    """Numbers between two bounds, as gymnasium.spaces.Box."""

    def __init__(self, low: Any, high: Any, shape: tuple[int, ...] | None = None, dtype: Any = np.float32) -> None:
        self.dtype = np.dtype(dtype)
        self.shape = np.shape(low) if shape is None else shape
        self.low, self.high = (np.broadcast_to(np.asarray(x, self.dtype), self.shape) for x in (low, high))
        self.seed(None)

    def seed(self, seed: int | None) -> None:
        """Begins other samples."""
        self._random = np.random.default_rng(seed)

    def sample(self) -> npt.NDArray[Any]:
        """Draws evenly between finite bounds, and normally where there are none."""
        is_bounded = np.isfinite(self.low) & np.isfinite(self.high)
        low, high = np.where(is_bounded, self.low, 0), np.where(is_bounded, self.high, 1)
        even = self._random.uniform(low, high)
        return np.asarray(np.where(is_bounded, even, self._random.normal(size=self.shape)), self.dtype)

    def contains(self, x: Any) -> bool:
        """Whether an array has the shape and is within the bounds."""
        x = np.asarray(x)
        return x.shape == self.shape and bool(np.all((x >= self.low) & (x <= self.high)))

    def __repr__(self) -> str:
        return f"Box({self.low.min(initial=np.inf)}, {self.high.max(initial=-np.inf)}, {self.shape}, {self.dtype})"


_Base: Any = object
_Box: Any = _OwnBox
_Mode: Any = str
try:
    _vector = importlib.import_module("gymnasium.vector")
    _Base, _Mode, _Box = _vector.VectorEnv, _vector.AutoresetMode, importlib.import_module("gymnasium.spaces").Box
except ImportError:
    pass

_RENDERED = ["rgb_array", "lines"]
_MODES = {"next_step": "NextStep", "same_step": "SameStep", "disabled": "Disabled"}


class VectorEnv(_Base):  # type: ignore[misc]
    """A task on the worlds of a batch, by the rules of gymnasium.vector.VectorEnv; derives from it where Gymnasium is installed.

    A task is a class with reward(batch) -> (N,), and if need be ended(batch) -> (N,) bool and info(batch) -> {name: (N, ...)}.
    A world that fails is terminated, with reward 0, observations of 0, infos["failed"], and infos["fault"], which says why. Until
    then reward(), ended() and info() see NaN in its observations.

    Parameters
    ----------
    batch : WorldBatch, or the scene of one, which `worlds` and the other arguments make
    autoreset : "next_step": the call after the end of an episode resets, ignores the action, and gives reward 0; "same_step":
        the call that ends an episode resets, with the last observations in infos["final_obs"]; "disabled": reset() alone does
    copy : False: observations are overwritten by the next call
    dtype : of the observations
    render_mode : what render() returns of each world: "rgb_array", a picture; "lines", those of WorldBatch.lines(); None: nothing
    drawing : what they show of the fluid, as in WorldBatch.lines()
    camera : (eye, at), places of the camera and of what it looks at, (3,) each [m]; None: all lines of the first picture

    >>> class Fall(VectorEnv):
    ...     def reward(self, batch):
    ...         return -batch["position"][:, 2]
    >>> env = Fall("sphere_fall", 4, observations=["position"], most_steps=10)
    >>> observations, infos = env.reset(seed=1)
    >>> observations, rewards, terminated, truncated, infos = env.step(np.zeros((4, 0)))
    >>> observations.shape, bool(truncated.any())
    ((4, 3), False)
    """

    def __init__(
        self,
        batch: Any,
        worlds: int = 1,
        *,
        autoreset: str = "next_step",
        copy: bool = True,
        dtype: Any = np.float32,
        render_mode: str | None = None,
        drawing: Sequence[str] = (),
        camera: Any = None,
        **settings: Any,
    ) -> None:
        if render_mode not in (None, *_RENDERED):
            raise ValueError(f"render_mode is {render_mode!r}; must be None or one of {_RENDERED}")
        if autoreset not in _MODES:
            raise ValueError(f"autoreset is {autoreset!r}; must be one of {sorted(_MODES)}")
        if isinstance(batch, WorldBatch) and (settings or worlds not in (1, batch.worlds)):
            raise ValueError(f"a WorldBatch has its worlds and settings already; not taken: {', '.join(settings) or 'worlds'}")
        self.batch = batch if isinstance(batch, WorldBatch) else WorldBatch(batch, worlds, **settings)
        self.num_envs, self.closed, self.spec, self.render_mode = self.batch.worlds, False, None, render_mode
        self.metadata = {"autoreset_mode": _Mode(_MODES[autoreset]), "render_modes": _RENDERED}
        self._mode, self._copy, self._drawing, self._camera = autoreset, copy, list(drawing), camera
        if render_mode is not None:
            self.batch.lines(0, self._drawing)  # refuses what it does not know
        self._done = np.zeros(self.num_envs, bool)
        bound = np.full(self.batch.actions.shape[1], np.inf)
        for name, at, size in self.batch.action_fields:
            if name.startswith(("thrusters", "foils")):
                bound[at : at + size] = 1
        width = self.batch.observations.shape[1]
        self.single_action_space = _Box(-bound.astype(np.float32), bound.astype(np.float32), dtype=np.float32)
        self.single_observation_space = _Box(-np.inf, np.inf, (width,), dtype)
        every = np.broadcast_to(bound.astype(np.float32), (self.num_envs, len(bound)))
        self.action_space = _Box(-every, every, dtype=np.float32)
        self.observation_space = _Box(-np.inf, np.inf, (self.num_envs, width), dtype)
        self._observations = np.zeros((self.num_envs, width), dtype)

    def reward(self, batch: WorldBatch) -> npt.ArrayLike:
        """Returns the rewards (N,) of the last env step: what a task defines."""
        raise NotImplementedError(f"{type(self).__name__} has no reward(batch)")

    def ended(self, batch: WorldBatch) -> npt.ArrayLike:
        """Returns which worlds have come to an end (N,), besides those that `most_steps` truncates; default: none."""
        return np.zeros(self.num_envs, bool)

    def info(self, batch: WorldBatch) -> dict[str, npt.NDArray[Any]]:
        """Returns further facts by name, arrays (N, ...); default: none."""
        return {}

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[npt.NDArray[Any], dict[str, Any]]:
        """Begins new episodes of all worlds, or of those in options["reset_mask"], (N,) bool. Returns observations and infos.

        seed : s: world i gets s + i; or one for each; None: the next episodes are drawn
        """
        mask = (options or {}).get("reset_mask")
        if mask is not None:
            is_right = isinstance(mask, np.ndarray) and mask.dtype == bool and mask.shape == (self.num_envs,)
            if not is_right or not mask.any():
                raise ValueError(f"options['reset_mask'] must be an array of bool of shape ({self.num_envs},), one of them True")
        self.batch.reset(mask, seed)
        self._done[slice(None) if mask is None else mask] = False
        return self._observe(), self._infos(np.ones(self.num_envs, bool))

    def step(self, actions: npt.ArrayLike) -> tuple[npt.NDArray[Any], ...]:
        """Makes one env step. Returns observations (N, O), rewards, terminated and truncated (N,), and infos."""
        batch, before = self.batch, self._done
        given = np.asarray(actions)
        if given.shape != batch.actions.shape:
            raise ValueError(f"actions have shape {given.shape}; must be {batch.actions.shape}")
        if self._mode == "disabled" and before.any():
            raise ValueError(f"world {int(before.argmax())} has ended; reset it by options={{'reset_mask': ...}}")
        batch.actions[:] = given
        is_reset = before if self._mode == "next_step" else np.zeros_like(before)
        batch.step(is_reset if is_reset.any() else None)
        failed = batch.failed.copy()
        rewards = np.where(failed | is_reset, 0.0, self._each("reward", self.reward(batch), np.float64))
        terminated = (self._each("ended", self.ended(batch), np.bool_) | failed) & ~is_reset
        truncated = batch.truncated & ~is_reset & ~failed
        done = terminated | truncated
        infos = self._infos(np.ones(self.num_envs, bool))
        if self._mode == "same_step" and done.any():
            infos = self._begin_ended(done, infos)
        self._done = np.zeros_like(done) if self._mode == "same_step" else done
        return self._observe(), rewards, terminated, truncated, infos  # type: ignore[return-value]

    def _each(self, name: str, value: npt.ArrayLike, dtype: Any) -> npt.NDArray[Any]:
        """Returns what a function of the task has said of each world."""
        of_each = np.asarray(value, dtype)
        if of_each.shape != (self.num_envs,):
            raise ValueError(f"{name}(batch) has shape {of_each.shape}; must be ({self.num_envs},)")
        return of_each

    def _begin_ended(self, done: npt.NDArray[np.bool_], last: dict[str, Any]) -> dict[str, Any]:
        """Resets the worlds that have ended. Returns infos with those of their last env step."""
        final = np.full(self.num_envs, None, object)
        observations = self._observe().copy()
        for i in np.flatnonzero(done):
            final[i] = observations[i]
        last = {name: np.where(done, value, False) if name.startswith("_") else value for name, value in last.items()}
        self.batch.reset(done)
        infos = self._infos(np.ones(self.num_envs, bool))
        return {**infos, "final_obs": final, "_final_obs": done.copy(), "final_info": last, "_final_info": done.copy()}

    def _infos(self, mask: npt.NDArray[np.bool_]) -> dict[str, Any]:
        facts = dict(self.info(self.batch))
        if self.batch.failed.any():
            facts["failed"] = self.batch.failed.copy()
            facts["fault"] = np.array([self.batch.fault(i) for i in range(self.num_envs)], object)
        infos: dict[str, Any] = {}
        for name, value in facts.items():
            infos[name], infos["_" + name] = np.array(value), mask.copy()
        return infos

    def _observe(self) -> npt.NDArray[Any]:
        np.copyto(self._observations, self.batch.observations, casting="same_kind")
        if self.batch.failed.any():
            self._observations[self.batch.failed] = 0
        return self._observations.copy() if self._copy else self._observations

    def render(self) -> tuple[Any, ...] | None:
        """Returns what `render_mode` says, one for each world: pictures (360, 480, 3) uint8, or points and colours of lines."""
        if self.render_mode is None:
            return None
        drawn = [self.batch.lines(i, self._drawing) for i in range(self.num_envs)]
        if self.render_mode == "lines":
            return tuple(drawn)
        if self._camera is None:
            self._camera = camera_for(np.concatenate([points for points, _ in drawn]))
        return tuple(picture(points, colours, *self._camera) for points, colours in drawn)

    def close(self, **_: Any) -> None:
        """Ends the use of the environment; the batch stays."""
        self.closed = True
