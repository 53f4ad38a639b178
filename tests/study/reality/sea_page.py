"""docs/reality_at_sea.md and its pictures."""

import math

import matplotlib.pyplot as plt
from experiment_tables import table
from reality_numbers import rms
from reality_page import Page
from reality_tables import number, rows_of_sources, source

HEAD = """\
# Reality at sea

Measured motions of bodies that float, roll, ride on waves, fall into water and are driven under it, and what this library
makes of them with default settings, smooth bodies. [Reality](reality.md) has coefficients and falls. What to trust, by what factor,
at Reynolds numbers of 1e4, sections that roll, to 1e7, a ball of 10 m:
"""

REMARKS = {
    "heave decay": "periods are right; the first trough is {trough_30}, {trough_90} and {trough_150} of the measured one from a tenth, "
    "a third and half of the diameter; later swings are damped too slowly, at {decay_30}, {decay_90} and {decay_150} of the rate",
    "natural periods": "heave, roll, a box on a hinge",
    "roll damping": "sharp corners shed more in small swings than in steady flow, which is all that the law knows; a mesh of the same box 2.73, before boxes had their few faces by rule 2.70",
    "waves: heave": "near resonance too small; half of the measured heave where the body rolls as well; short waves too large",
    "waves: roll": "right near resonance, twice too large in waves shorter than it",
    "water entry": "a cone of 45° and a cylinder right; a blunter cone feels {blunt} of the largest force; a wedge is stopped too "
    "early, for the parts of its added mass are those of its full breadth ([slamming](water_validation.md#slamming))",
    "driven under water: drag": "the measured drags of two such vehicles differ by a factor of 5 to 8; a box of their size lies between",
    "driven under water: added mass": "a solid box holds more water than an open frame",
    "sloshing: heights": "the first mode alone is there; crests are higher than troughs are deep, here they are alike",
    "sloshing: times": "right; in boxes half of their length deep and more the measured waves are 5 to 6 % slower than those of linear theory",
    "capsizing": "closed form, not measured: hydrostatics are exact",
}

MAKE = """\
A factor is that whose logarithm is the rms over the numbers of the kind, of ln(library/measured). The way of the wake was
chosen with the ball's heave decay in view; no other number of the library was fitted on any of them. Everything here but the
words is written by

<!-- not run: takes a minute -->
    demos/run --reality sea

from [measurements_at_sea.json](../data/reality/measurements_at_sea.json), which also holds the scenes of all cases, and from
runs of this very library. Each number has its [source](#sources), with what of it was seen.
"""

HEAVE = """\
## Heave decay

A ball that floats with half of its volume under water, let go above its balance. Its waves damp it; its drag has
hardly begun, for the wake of a smooth body needs some of its length to grow
([theory, eq. (51b)](theory.md#11-the-form-law)). From half of the diameter the ball enters as a whole, and loses too much to the spray.
"""

WAVES = """\
## In waves

A section of a ship across waves, in a flume; the library's is ten breadths long in open water. In the flume springs held the
section in its place, here it drifts with some centimetres a second, which lengthens the period that it meets by up to 4 %.
Measured amplitudes are those before the first reflections; at 1.21 s the roll still grew.
"""

ENTRY = """\
## Water entry

Cones on cylinders that carry an accelerometer, a wedge and a level cylinder. The library's deceleration goes in steps, one for
each part of the added mass that gets wet; finer meshes change it by 2 %. Tried once with a waterline table of 4 divisions, the
wedge has 4.04, 3.00, 2.72 and 2.26 m/s after 10, 20, 30 and 40 ms, the cone of 60° a largest deceleration of 4.49 g.
"""

SLOSHING = """\
## Water in a tank

A tank with water in its [hold](vessels.md#water-that-sloshes) is moved to and fro along its length, faster than its first mode, whose period is 1.67 s: the water
beats. The library has this mode alone.
"""

CASES = """\
## All numbers

`computed` marks computations by others and closed forms, which stand in where nothing measured was found.
"""

NOT = """\
## What is not compared

- The roll decay of whole ships, such as R/V Melville (DTMB 5720, period 2.139 ± 0.041 s), whose hulls are not public.
- Drift in waves, mooring lines, thrusters; heave and pitch of ships in head waves, for want of a measurement whose numbers
  were seen together with the hull.
- Measured righting arms, swimmers and manipulators under water: none was found with all sizes.
- The flooding of damaged ships, such as the box-shaped barge of Ruponen (Helsinki 2006), and the roll of ships with a free-surface
  tank: nothing was found with all sizes and measured numbers. Looked for were "Ruponen", "box-shaped barge", "progressive flooding", "flooding benchmark",
  "damaged ship section" in stored pages, documentation and repositories; what came up were titles and summaries, among them of the thesis of Dankowski (Hamburg 2013), which compares with three of the barge's tests, and of
  10.3390/jmse12081367. None had the measured courses in numbers. [Vessels](vessels.md) has closed forms.
- The water's depth and the walls of the tanks: the library's water is deep and without bounds here.

## Sources

Letters are those of the table.
"""


def factor(cases):
    return f"{math.exp(rms(cases, 'form')):.2f}"


def numbers_of(sea):
    """What the remarks name."""
    ratios = {case.row["id"]: case.ratio() for case in sea.cases}
    made = {f"trough_{height}": f"{ratios[f'kramer_{height}_extreme_1']:.2f}" for height in (30, 90, 150)}
    made |= {f"decay_{height}": f"{ratios[f'kramer_{height}_decay']:.2f}" for height in (30, 90, 150)}
    return made | {"blunt": f"{ratios['cone_60_50cm']:.2f}"}


def kind_rows(sea):
    numbers = numbers_of(sea)
    kinds = ((kind, sea.of_kind(kind)) for kind in sea.kinds())
    return [(kind, str(len(cases)), factor(cases), REMARKS[kind].format(**numbers)) for kind, cases in kinds]


def case_rows(sea):
    rows = []
    for case in sea.cases:
        row = case.row
        what = f"{row['quantity']}{'' if row['unit'] == '1' else ' [' + row['unit'] + ']'}"
        origin = source(row) + (", computed" if row.get("computed") else "")
        rows.append((row["body"], what, number(case.value), origin, number(case.model), f"{case.ratio():.2f}"))
    return rows


def draw_curves(sea, picture, label):
    chosen = [k for k, series in enumerate(sea.series) if series["picture"] == picture]
    side = 1 if len(chosen) == 1 else 2
    figure, panels = plt.subplots(side, side, figsize=(11, 3.5 * side), squeeze=False)
    for axes, k in zip(panels.flat, chosen):
        series = sea.series[k]
        axes.plot(*zip(*sea.curves[k]), color="tab:blue", linewidth=1.8, label="library, default settings")
        measured = "computed" if "computed" in series["label"] else "measured"
        axes.plot(*zip(*series["points"]), "o", color="k", markersize=3.5, label=measured)
        axes.axhline(0, color="0.7", linewidth=0.6)
        axes.set_title(series["label"], fontsize=9)
        axes.set(xlabel="time [s]", ylabel=label)
        axes.grid(True, linewidth=0.3)
        axes.legend(fontsize=8)
    figure.tight_layout()
    return figure


def draw_waves(sea):
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.4))
    for axes, kind, label in zip(panels, ("heave", "roll"), ("heave over the wave's amplitude", "roll over the wave's slope")):
        for ending, marker, name in ((", free", "o", "free"), ("rolling", "s", "kept from rolling")):
            cases = [case for case in sea.of_kind(f"waves: {kind}") if case.row["body"].endswith(ending)]
            cases.sort(key=lambda case: case.row["period"])
            periods = [case.row["period"] for case in cases]
            if cases:
                axes.plot(periods, [case.value for case in cases], marker + "-", color="k", markersize=5, label=f"measured, {name}")
                axes.plot(periods, [case.model for case in cases], marker + "--", color="tab:blue", markersize=5, label=f"library, {name}")
        axes.set(xlabel="period of the wave [s]", ylabel=f"{label} [1]", ylim=(0, None))
        axes.grid(True, linewidth=0.3)
        axes.legend(fontsize=8)
    figure.suptitle("Section of a ship across waves (Sundsdal et al. 2025)", fontsize=10)
    figure.tight_layout()
    return figure


def write(sea, docs):
    page = Page(docs, "reality_at_sea", "sea")
    page.add(HEAD)
    page.add(table(("motions", "numbers", "off by a factor, typically", ""), kind_rows(sea)))
    page.add(MAKE)
    page.add(HEAVE)
    page.add_picture("heave", draw_curves(sea, "heave", "height over the start [1]"), "Heave decay of floating balls")
    page.add(WAVES)
    page.add_picture("waves", draw_waves(sea), "Heave and roll of a section of a ship in waves")
    page.add(ENTRY)
    page.add_picture("entry", draw_curves(sea, "entry", ""), "Bodies that fall into water")
    page.add(SLOSHING)
    page.add_picture("sloshing", draw_curves(sea, "sloshing", "height [m]"), "Water in a tank that is moved to and fro")
    page.add(CASES)
    page.add(table(("body", "what", "measured", "source", "library", "ratio"), case_rows(sea)))
    page.add(NOT)
    page.add(table(("", "work", "seen", "pages"), rows_of_sources(sea, sea.sources)))
    page.write()
