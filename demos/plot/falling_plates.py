"""Falling plates side by side.

Above, a part of each fall: the outline of the plate along its path at even intervals of time. Below, the whole falls.
Each row has one scale. The plane of the pictures is vertical, across the swing axis of the plate.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.patches import Rectangle
from matplotlib.ticker import MultipleLocator

# Without the palest end, which vanishes on white.
COLOURS = ListedColormap(plt.get_cmap("plasma")(np.linspace(0, 0.9, 256)))
CLOSE_UP_METRES = 1.0
CLOSE_UP_INTERVAL = 0.06  # between two outlines [s]
WHOLE_INTERVAL = 0.1


class PlanarFall:
    """A fall seen along its swing axis: sideways and upwards coordinates, outlines as ellipses."""

    def __init__(self, run):
        self.track = track = run.falling_plate()
        self.fall = track.entry["fall"]
        self.time = track.time
        up = run.up()
        axis = np.array(self.fall["swing_axis"])
        side = np.cross(axis, up)
        end = track.position[-1] - track.position[0]
        if side @ end < 0:
            side = -side
        self.path = track.position @ np.stack([side, up], axis=1)
        self.path -= self.path[0]
        half = np.array(track.entry["fluid_body"]["half_extents"])
        self.width = 2 * half.max()
        self.slenderness = half.max() / half.min()
        # The outline of an ellipsoid with axes A in the plane P is the ellipse P R A^2 R^T P^T.
        seen = np.einsum("ki,tij,j->tkj", np.stack([side, up]), track.rotations(), half)
        squares = np.einsum("tkj,tlj->tkl", seen, seen)
        lengths, directions = np.linalg.eigh(squares)
        self.outline_lengths = 2 * np.sqrt(lengths)  # short, long
        long = directions[:, :, 1]
        self.outline_angles = np.degrees(np.arctan2(long[:, 1], long[:, 0]))

    def title(self):
        diameter, thickness = 100 * self.width, 100 * self.width / self.slenderness
        grams = 1000 * self.track.entry["mass"]
        return f"{diameter:.0f} cm x {thickness:.1f} cm, {grams:g} g: {self.fall['mode']}"

    def subtitle(self):
        return (
            f"{self.fall['overturns']} overturns, {self.fall['swings']} swings, "
            f"descends at {self.fall['descent_speed']:.2f} m/s"
        )

    def characteristic_time(self):
        """Where the fall shows best what it is: at the first change between overturning and swinging, else half-way."""
        events = self.fall["events"]
        for before, after in zip(events, events[1:]):
            if before["kind"] != after["kind"]:
                return before["time"]
        return 0.5 * (self.time[0] + self.time[-1])

    def rows_every(self, interval):
        wanted = np.arange(self.time[0], self.time[-1] + interval / 2, interval)
        return np.unique(np.searchsorted(self.time, wanted - 1e-9).clip(0, len(self.time) - 1))


def draw(axes, fall, interval, colours, spacing, edge=0.0):
    """Path and outlines; returns what a colour bar needs."""
    segments = np.stack([fall.path[:-1], fall.path[1:]], axis=1)
    line = LineCollection(segments, cmap=COLOURS, norm=colours, linewidths=0.7, alpha=0.6)
    line.set_array(fall.time[:-1])
    axes.add_collection(line)
    rows = fall.rows_every(interval)
    outlines = EllipseCollection(
        fall.outline_lengths[rows, 1],
        fall.outline_lengths[rows, 0],
        fall.outline_angles[rows],
        units="xy",
        offsets=fall.path[rows],
        offset_transform=axes.transData,
        cmap=COLOURS,
        norm=colours,
        linewidths=edge,
        edgecolors="black",
        alpha=0.7,
        zorder=3,
    )
    outlines.set_array(fall.time[rows])
    axes.add_collection(outlines)
    axes.set_aspect("equal")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MultipleLocator(spacing))
    axes.grid(color="0.92", linewidth=0.6)
    axes.set_axisbelow(True)
    for spine in ("top", "right"):
        axes.spines[spine].set_visible(False)
    return outlines


def show_box(axes, centre, width, height):
    axes.set_xlim(centre[0] - width / 2, centre[0] + width / 2)
    axes.set_ylim(centre[1] - height / 2, centre[1] + height / 2)


def close_up_centre(fall):
    """Middle of the close-up: the path around the characteristic time, as central as the whole path allows."""
    row = min(np.searchsorted(fall.time, fall.characteristic_time()), len(fall.path) - 1)
    low = fall.path.min(axis=0) - fall.width + CLOSE_UP_METRES / 2
    high = fall.path.max(axis=0) + fall.width - CLOSE_UP_METRES / 2
    middle = 0.5 * (low + high)
    return fall.path[row].clip(np.minimum(low, middle), np.maximum(high, middle))


def draw_falls(falls):
    """A figure of falls, close up above, whole below."""
    colours = Normalize(0, max(fall.time[-1] for fall in falls))
    lows = np.array([fall.path.min(axis=0) - 1.5 * fall.width for fall in falls])
    highs = np.array([fall.path.max(axis=0) + 1.5 * fall.width for fall in falls])
    widths = np.maximum(highs[:, 0] - lows[:, 0], 1.2)
    bottom, top = lows[:, 1].min(), highs[:, 1].max()

    figure_width, side, gap = 12.5, 0.75, 0.55
    close_up = (figure_width - 2 * side - gap * (len(falls) - 1)) / len(falls)
    scale = (figure_width - 2 * side - gap * (len(falls) - 1)) / widths.sum()
    whole = scale * (top - bottom)
    above, between, below = 0.6, 0.75, 0.55
    figure_height = above + close_up + between + whole + below
    figure = plt.figure(figsize=(figure_width, figure_height))

    def place(left, low, width, height):
        return figure.add_axes(
            (left / figure_width, low / figure_height, width / figure_width, height / figure_height)
        )

    left = side
    for column, fall in enumerate(falls):
        axes = place(side + column * (close_up + gap), below + whole + between, close_up, close_up)
        draw(axes, fall, CLOSE_UP_INTERVAL, colours, 0.2, edge=0.5)
        show_box(axes, close_up_centre(fall), CLOSE_UP_METRES, CLOSE_UP_METRES)
        axes.set_title(fall.title() + "\n", fontsize=12, fontweight="bold")
        axes.text(0.5, 1.025, fall.subtitle(), transform=axes.transAxes, ha="center", fontsize=9.5)
        if column == 0:
            axes.set_ylabel("height [m]")

        axes = place(left, below, scale * widths[column], whole)
        mappable = draw(axes, fall, WHOLE_INTERVAL, colours, 1)
        corner = close_up_centre(fall) - CLOSE_UP_METRES / 2
        axes.add_patch(
            Rectangle(corner, CLOSE_UP_METRES, CLOSE_UP_METRES, fill=False, edgecolor="0.6", linewidth=0.8)
        )
        middle = 0.5 * (lows[column] + highs[column])
        show_box(axes, (middle[0], 0.5 * (bottom + top)), widths[column], top - bottom)
        axes.set_xlabel("sideways [m]")
        if column == 0:
            axes.set_ylabel("height [m]")
        left += scale * widths[column] + gap
    bar = figure.add_axes((1 - 0.6 / figure_width, below / figure_height, 0.12 / figure_width, whole / figure_height))
    figure.colorbar(mappable, cax=bar, label="time [s]")
    return figure
