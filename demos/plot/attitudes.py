"""Where the axes of bodies point: along their paths, and over time for those that spin."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from paths import COLOURS, decorate, main_direction

AXES = {"x": 0, "y": 1, "z": 2}


def end_row(track, until):
    """Number of rows up to the landing, or up to a time."""
    landing = track.entry["path"]["landing"]
    end = landing["time"] if landing else track.time[-1]
    return int(np.searchsorted(track.time, min(end, until)))


def draw_side(axes, run, axis, interval, length, until, along, colour, label):
    track, up = run.tracks[0], run.up()
    rows = end_row(track, until)
    plane = np.stack([along, up], axis=1)
    path = track.position[:rows] @ plane
    axes.plot(*path.T, color=colour, linewidth=1, alpha=0.6, label=label)
    shown = np.searchsorted(track.time[:rows], np.arange(0, track.time[rows - 1], interval))
    direction = track.rotations()[shown][:, :, AXES[axis]] @ plane
    start, end = path[shown] - direction * length / 2, path[shown] + direction * length / 2
    axes.add_collection(LineCollection(np.stack([start, end], axis=1), colors=[colour], linewidths=2.2))
    # The end to which the axis points.
    axes.plot(*end.T, "o", color=colour, markersize=3.5)


def draw_attitudes(runs, body_axes, interval, length, until=np.inf, across=False):
    """Side views with the body's axis drawn along the path every `interval` seconds, a dot at its head. Runs of one shape
    share a panel; `across` adds the view from the other side."""
    alike = len(set(run.tracks[0].name for run in runs)) == 1 and len(runs) > 1
    panels = 1 if alike else len(runs) + across
    figure, row = plt.subplots(
        1, panels, figsize=(12.5, 4 if alike else 6), squeeze=False, layout="constrained"
    )
    for i, run in enumerate(runs):
        axes = row[0][0 if alike else i]
        along = main_direction(runs[0] if alike else run)
        letter = body_axes[min(i, len(body_axes) - 1)]
        draw_side(axes, run, letter, interval, length, until, along, COLOURS[i], run.name)
        axes.set(xlabel="along [m]", ylabel="height [m]")
        if across:
            other = row[0][i + 1]
            draw_side(other, run, letter, interval, length, until, np.cross(run.up(), along), COLOURS[i], run.name)
            other.set(xlabel="across [m]", title="from the front")
        if not alike:
            axes.set_title(f"{run.name}: its {letter} axis")
    for axes in row[0]:
        decorate(axes)
        if alike:
            axes.legend(frameon=False)
            axes.set_title(f"{body_axes[0]} axis of the body, every {interval:g} s")
    return figure


def draw_spinners(runs):
    """Over time: tilt of the z axis from the vertical, turns per second about the vertical, and speed of descent."""
    figure, panels = plt.subplots(1, 3, figsize=(12.5, 3.6), layout="constrained")
    for colour, run in zip(COLOURS, runs):
        track, up = run.tracks[0], run.up()
        tilt = np.degrees(np.arccos(np.clip(track.rotations()[:, :, 2] @ up, -1, 1)))
        values = (tilt, np.abs(track.spin @ up) / (2 * np.pi), -track.velocity @ up)
        for axes, value in zip(panels, values):
            axes.plot(track.time, value, color=colour, linewidth=1.2, label=run.name)
    for axes, title in zip(panels, ("tilt [°]", "turns per second about the vertical", "descent [m/s]")):
        axes.set(xlabel="time [s]", title=title)
        axes.set_ylim(bottom=0)
        axes.grid(color="0.92", linewidth=0.6)
        axes.set_axisbelow(True)
        for spine in ("top", "right"):
            axes.spines[spine].set_visible(False)
    panels[0].legend(frameon=False, fontsize=9)
    return figure
