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
    """The path, and over it the axis [m] every `interval` seconds with a dot at its head."""
    track, up = run.tracks[0], run.up()
    rows = end_row(track, until)
    plane = np.stack([along, up], axis=1)
    path = track.position[:rows] @ plane
    axes.plot(*path.T, color=colour, linewidth=1, alpha=0.6)
    shown = np.searchsorted(track.time[:rows], np.arange(0, track.time[rows - 1], interval))
    direction = track.rotations()[shown][:, :, AXES[axis]] @ plane
    start, end = path[shown] - direction * length / 2, path[shown] + direction * length / 2
    axes.add_collection(LineCollection(np.stack([start, end], axis=1), colors=[colour], linewidths=2.2, label=label))
    # The end to which the axis points.
    axes.plot(*end.T, "o", color=colour, markersize=3.5)


def draw_attitudes(runs, body_axes, interval, length, until=np.inf, across=False, title=None, height=6):
    """Side views with the body's axis drawn along the path every `interval` seconds, a dot at its head. Runs of one shape
    share a panel, which `title` heads; `across` adds the view from the other side. `height` of the figure [inches]."""
    alike = len(set(run.tracks[0].name for run in runs)) == 1 and len(runs) > 1
    panels = 1 if alike else len(runs) + across
    figure, row = plt.subplots(
        1, panels, figsize=(12.5, 4 if alike else height), squeeze=False, layout="constrained"
    )
    for i, run in enumerate(runs):
        axes = row[0][0 if alike else i]
        along = main_direction(runs[0] if alike else run)
        letter = body_axes[min(i, len(body_axes) - 1)]
        draw_side(axes, run, letter, interval, length, until, along, COLOURS[i], run.name.replace("_", " "))
        axes.set(xlabel="along [m]", ylabel="height [m]")
        if across:
            other = row[0][i + 1]
            draw_side(other, run, letter, interval, length, until, np.cross(run.up(), along), COLOURS[i], run.name)
            other.set(xlabel="across [m]", title="from the front")
        if not alike:
            axes.set_title(f"{run.name.replace('_', ' ')}: its {letter} axis every {interval:g} s")
    for axes in row[0]:
        decorate(axes)
        if alike:
            axes.legend(frameon=False)
            axes.set_title(title)
    return figure


def running_mean(values, rows):
    """The mean over `rows` rows around each; fewer at the ends."""
    kernel = np.ones(rows)
    return np.convolve(values, kernel, mode="same") / np.convolve(np.ones_like(values), kernel, mode="same")


def draw_spinners(runs, until=4, window=0.2):
    """Over time: tilt of the z axis from the vertical, turns per second about the vertical, and speed of descent; means
    over `window` seconds, what they are the means of in pale."""
    figure, panels = plt.subplots(1, 3, figsize=(12.5, 3.6), layout="constrained")
    for colour, run in zip(COLOURS, runs):
        track, up = run.tracks[0], run.up()
        tilt = np.degrees(np.arccos(np.clip(track.rotations()[:, :, 2] @ up, -1, 1)))
        values = (tilt, np.abs(track.spin @ up) / (2 * np.pi), -track.velocity @ up)
        rows = np.searchsorted(track.time, until)
        for axes, value in zip(panels, values):
            mean = running_mean(value, max(1, round(window / (track.time[1] - track.time[0]))))
            axes.plot(track.time[:rows], value[:rows], color=colour, linewidth=0.5, alpha=0.25)
            axes.plot(track.time[:rows], mean[:rows], color=colour, linewidth=2, label=run.name.replace("_", " "))
    for axes, title in zip(panels, ("tilt [°]", "turns per second about the vertical", "descent [m/s]")):
        axes.set(xlabel="time [s]", title=title)
        axes.set_ylim(bottom=0)
        axes.grid(color="0.92", linewidth=0.6)
        axes.set_axisbelow(True)
        for spine in ("top", "right"):
            axes.spines[spine].set_visible(False)
    panels[0].set_ylim(top=100)
    panels[0].legend(frameon=False, fontsize=11)
    return figure
