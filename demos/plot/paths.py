"""Paths of bodies: one panel per run, seen from the side and from above."""

import matplotlib.pyplot as plt
import numpy as np

COLOURS = plt.get_cmap("tab10").colors
# Paths that lie on each other show through.
STYLES = ("-", (0, (6, 2)), (0, (3, 2)), (0, (1, 1.5)))


# Sideways motion below this share of the whole counts as none.
NEGLIGIBLE = 1e-3


def horizontal_part(vectors, up):
    return vectors - np.outer(vectors @ up, up)


def main_direction(run):
    """Horizontal unit vector: of the first body's launch, else along which the bodies move most, else any."""
    up = run.up()
    track = run.tracks[0]
    launch = horizontal_part(track.velocity[:1], up)[0]
    if np.linalg.norm(launch) > NEGLIGIBLE * np.abs(track.velocity).max() > 0:
        return launch / np.linalg.norm(launch)
    offsets = np.concatenate([track.position - track.position[0] for track in run.tracks])
    flat = horizontal_part(offsets, up)
    if np.abs(flat).max() > NEGLIGIBLE * np.abs(offsets).max() > 0:
        along = np.linalg.eigh(flat.T @ flat)[1][:, 2]
        return along * (1 if along @ flat.sum(axis=0) >= 0 else -1)
    axis = horizontal_part(np.eye(3)[:1], up)[0]
    if np.linalg.norm(axis) < 0.5:
        axis = horizontal_part(np.eye(3)[1:2], up)[0]
    return axis / np.linalg.norm(axis)


def decorate(axes):
    # An equal scale on both axes, and room for paths that are straight lines.
    axes.set_aspect("equal", adjustable="datalim")
    axes.grid(color="0.92", linewidth=0.6)
    axes.set_axisbelow(True)
    for spine in ("top", "right"):
        axes.spines[spine].set_visible(False)


def draw_view(axes, run, horizontal, vertical):
    for index, track in enumerate(run.tracks):
        colour = COLOURS[index % len(COLOURS)]
        x, y = track.position @ horizontal, track.position @ vertical
        if track.entry["mass"] == 0:
            axes.plot(x[0], y[0], "s", color="0.5", markersize=4)
            continue
        axes.plot(x, y, color=colour, linewidth=1.5, label=track.name)
        # Dots at even intervals of time.
        marks = np.unique(np.linspace(0, len(x) - 1, 11).round().astype(int))
        axes.plot(x[marks], y[marks], "o", color=colour, markersize=3.5)
    decorate(axes)
    # What does not move this way is shown so, not as magnified rounding.
    size = max(np.ptp(track.position, axis=0).max() for track in run.tracks)
    for low, high, put in ((*axes.get_xlim(), axes.set_xlim), (*axes.get_ylim(), axes.set_ylim)):
        if high - low < 0.1 * size:
            put(0.5 * (low + high) - 0.05 * size, 0.5 * (low + high) + 0.05 * size)


def draw_paths(runs):
    """A figure with a row per run: side view and top view."""
    figure, rows = plt.subplots(
        len(runs), 2, figsize=(12.5, 3.6 * len(runs)), squeeze=False, layout="constrained"
    )
    for run, (side_view, top_view) in zip(runs, rows):
        up, along = run.up(), main_direction(run)
        across = np.cross(up, along)
        draw_view(side_view, run, along, up)
        side_view.set(title=f"{run.name} ({run.summary['model']}), from the side", xlabel="along [m]", ylabel="height [m]")
        if len(run.tracks) > 1:
            side_view.legend(frameon=False)
        draw_view(top_view, run, along, across)
        interval = run.summary["duration"] / 10
        top_view.set(title=f"from above; dots every {interval:g} s", xlabel="along [m]", ylabel="across [m]")
    return figure


def shown_part(track, until=np.inf):
    """Positions up to the landing and up to a time."""
    landing = track.entry["path"]["landing"]
    end = min(until, landing["time"]) if landing else until
    return track.position[track.time <= end]


def draw_drop(run):
    """A figure of all bodies that move, from the side, each up to its landing."""
    figure, axes = plt.subplots(figsize=(6.5, 6.5), layout="constrained")
    up, along = run.up(), main_direction(run)
    moving = [track for track in run.tracks if track.entry["mass"] > 0]
    for colour, track in zip(COLOURS, moving):
        position = shown_part(track)
        axes.plot(position @ along, position @ up, color=colour, linewidth=1.5, label=track.name.replace("_", " "))
    axes.set(xlabel="along [m]", ylabel="height [m]", title=run.name)
    decorate(axes)
    axes.legend(frameon=False)
    return figure


def draw_panel(axes, runs, curves, labels, **names):
    for colour, style, run, curve, label in zip(COLOURS, STYLES, runs, curves, labels):
        axes.plot(*curve, color=colour, linestyle=style, linewidth=1.7, label=label)
    axes.set(**names)
    decorate(axes)


def show_between(side, other, paths, up, lowest):
    """Heights from `lowest`, or from that of all paths, in both panels."""
    heights = np.concatenate(paths) @ up
    bottom, top = max(heights.min(), lowest), heights.max()
    margin = 0.05 * (top - bottom)
    for axes in (side, other):
        axes.set_ylim(bottom - margin, top + margin)
    side.set_adjustable("datalim")


def draw_overlay(runs, until=np.inf, lowest=-np.inf):
    """A figure of the first bodies of runs in one side view, each up to its landing or a time, and in a top view if any
    moves sideways, else their height over time. Below `lowest` [m] paths are cut."""
    up, along = runs[0].up(), main_direction(runs[0])
    across = np.cross(up, along)
    paths = [shown_part(run.tracks[0], until) for run in runs]
    extent = max(np.ptp(path, axis=0).max() for path in paths)
    sideways = max(np.ptp(path @ across) for path in paths) > 0.05 * extent
    rivals = len({run.name for run in runs}) == 1
    labels = [run.summary["model"] if rivals else run.name.replace("_", " ") for run in runs]
    figure, (side, other) = plt.subplots(
        1, 2, figsize=(12.5, 4 if sideways else 5), width_ratios=(1, 1 if sideways else 1.6), layout="constrained"
    )
    draw_panel(side, runs, [(path @ along, path @ up) for path in paths], labels,
               xlabel="along [m]", ylabel="height [m]", title="from the side")
    if sideways:
        draw_panel(other, runs, [(path @ along, path @ across) for path in paths], labels,
                   xlabel="along [m]", ylabel="across [m]", title="from above")
    else:
        curves = [(run.tracks[0].time[: len(path)], path @ up) for run, path in zip(runs, paths)]
        draw_panel(other, runs, curves, labels, xlabel="time [s]", ylabel="height [m]", title="height over time")
        other.set_aspect("auto")
        show_between(side, other, paths, up, lowest)
    other.legend(frameon=False, fontsize=11)
    return figure
