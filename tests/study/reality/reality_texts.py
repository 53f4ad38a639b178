"""The words of docs/reality.md; {names} are filled in from the numbers."""

HEAD = """\
# Reality

Measured coefficients and motions of bodies in air and water, and what this library makes of them: by its own law, the
[form law](theory.md#11-the-form-law) [at any Reynolds number](theory.md#19-any-reynolds-number), which is the default, and by the
published one of Padilla et al. (2025).

What to trust, by what factor, from which Reynolds number to which. The user's only number is the height of the roughness; none
was fitted to a row but where that is said.

| bodies | Re | off by a factor, typically | by the published law |
|---|---|---|---|
| spheres, also falling | 0.01 to 1e5 | {spheres_form} in speed, 1.04 in drag | {spheres_published} in speed |
| discs broadside; spheroids; polyhedra | 0.01 to 6e4 | {discs_form}; {spheroids_form}; {polyhedra_form} in speed | no drag; {spheroids_published}; {polyhedra_published} |
| grains, sand, rods that settle | 0.001 to 1e3 | {grains_form}, sand {sand_form} in speed | {grains_published} |
| smooth and sand-rough spheres beyond their crisis | 2e5 to 6e6 | {crisis_form} | {crisis_published} |
| balls of sports, drag; lift | 2e4 to 4e5 | {drag_form}; {lift_form}, tennis 1.9; 1.6 | {drag_published}; {lift_published} |
| inside a crisis | 10 % of Re is a factor of 3 there | {inside_form} | {inside_published} |
| long smooth cylinders across | 1e4 to 5e6 | {cylinders_form}, beyond 2e6 too little drag | {cylinders_published} |
| hulls and drops: drag; side force | 1e6 to 3e7 | {hulls_form}; {side_form} (from memory) | {hulls_published}; {side_published} |
| cubes, plates, discs broadside | 1e4 to 1e6 | {flat_form} | no drag on flat faces |
| cylinders across; end-on; cones | 1e4 to 1e6 | {across_form}; {end_form}; {cone_form} | {across_published}; no drag; {cone_published} |
| plates at incidence | 1e5 | {incidence_form} | {incidence_published} |
| long plates and rods, above 10 : 1 | 1e4 to 1e5 | {long_form}; rods have more than plates | no drag |
| half balls, cups and spheroids | 1e4 to 1e6 | {round_form}; no hollows | {round_published} |
| falling discs, strips, plates and cards | 1e3 to 1e4 | regime right in {regime_form} runs; speeds to a factor of about 2 | {regime_published} |
| light balls that rise freely | > 130 | 0.4 of the drag: their path, which vibrates, is not in the law | 0.5 |

A factor is that whose logarithm is the rms over the cases of the kind, drag coefficients and the like.
Over the whole table the rms of ln(library/measured) is **{rms_published} by the published law and {rms_form} by the form
law**, over what no parameter was fitted on {unfitted_published} and {unfitted_form}. The regime of falling is right in
**{share_published} of runs by the published law and {share_form} by the form law**.

Everything here but the words is written by

<!-- not run: takes minutes -->
    demos/run --reality

from [measurements.json](../data/reality/measurements.json), [curves.json](../data/reality/curves.json) and runs of this very library. Each number has its
source, [below](#sources), with what of it was seen; what could not be found in a public text and is quoted from memory
is marked so, and left out of the sums of coefficients. Bodies that float, enter water or are driven under it
are on a [page of their own](reality_at_sea.md).

## Sums

0 counts as {floor}. A ratio of 1.25 or 1.5 either way is counted as within it.
"""

FITTED = """\
Of the numbers of the form law three were fitted on cases of this table, marked `fit`, those of [any Reynolds
number](theory.md#19-any-reynolds-number) on sets of [another](#sets). The three are the suction e = 0.12 on the lee side, the 40 in
the drag of long flat sides, on Eiffel's plates broadside, and the stall of long plates, 0.18 in (43a), on his plates of 1, 2 and
6 to 1 at incidence. `held` cases were not used for that, but were in view when the form of the law was chosen; `fresh` ones were drawn after the first form law was
frozen, `drawn` ones [below](#drawn-after-the-law-was-frozen) after it was frozen again, before it had a Reynolds number, and `none` marks those collected for this page. Many of the latter are the same bodies measured by others, so
that they test the numbers more than the idea. c = 1.17 is the measured drag of a disc or square plate, 1.98 that of a
strip without end.

Per kind of body, the factor exp(rms), and how many are within 1.5:
"""

PLATE = """\
## Plates at incidence

The form law drawn is that of a square plate. Longer plates have a steeper rise and an earlier stall, as measured; those of
1.25 to 2 stall some degrees late, those of 3 and 4 some degrees early.
"""

CURVES = """\
## Over the Reynolds number

From Stokes' flow through the drag crisis. Bodies that settle are compared by their terminal speed, at which the library's drag is
the measured one, others by their coefficient. {held} points were not fitted on; {memory_points} quoted from memory stand apart. Table
tennis balls and spheres are smooth, other balls have the roughness of their pattern. Speeds of more than a hundred times the
measured one count as a hundred. Every set is [below](#sets).
"""

FLIGHTS = """\
Lines join the form law's coefficients at the measured Reynolds numbers. Smooth spheres have 0.12 at the bottom of their
crisis, where 0.06 to 0.10 is measured, and 0.8 of the measured drag from 3e6 on; long cylinders 0.6 of it from 2e6 on.

Flights of balls, from their measured release; golf balls with dimples of 0.2 mm, table-tennis balls smooth. The table of the
first two golf shots was measured, their flight computed by others. Of table tennis, how far from the measured place the flight ends;
[spindoe](https://github.com/cogsys-tuebingen/spindoe) itself computes all but the last within 0.1 or 0.2 m.
"""

CURVE_TABLE = """\
## Sets

Of the coefficients [over the Reynolds number](#over-the-reynolds-number): factors exp(rms), and the mean ratio of the form law to what was measured.
"""

MOTION = """\
## Motions

Regimes as [path_summary.h](../demos/analysis/path_summary.h) has them, from the second half of each fall. Released at
rest, with default settings. Discs, spheroids and strips are without size: their fluid is that of a Reynolds number of
2000, their weight that of speed 1 broadside; 120 of their widths at that speed are run. `mixed` is what the literature
calls chaotic. The discs' borders, I* = 0.01 to some 0.05 and 0.1, are from memory, to a factor of 1.5. Strips within
the measured error of the border (0.67 ± 0.05) are drawn and not counted.
"""

REGIMES = """\
A regime counts as right only if the name is that of the measurement. What the form law misses: heavy discs and
spheroids that are released at 5° stay broadside, discs of I* = 0.015 tumble, strips at a Froude number of 0.85 tumble and glide
in turn, Andersen's plates of 1/8 flutter from some releases. Cards autorotate too fast and with too little drag.
The published law falls flat or dives edge-on at many times the broadside speed, and then uses all
its substeps; with round edges it flutters and tumbles too. Above its tolerance in more than a tenth of the steps:
{coarse_published} of {falls} falls by the published law, {coarse_form} by the form law. Tried once with half and twice
the steps, one and two regimes fewer were right: between flutter and tumbling, runs hang on rounding.
"""

SPEEDS = """\
Final speeds of cubes and balls in water, at 60 Hz, released 3° off level; measured: by the coefficient in brackets. By
the published law a cube turns a face ahead, which has no drag; it chatters about that attitude, uses up its substeps,
and its speed depends on the step. Balls that sink are compared with the drag of smooth spheres at their own Reynolds number,
Achenbach's (1972): the largest are beyond the crisis.
"""

ROUND = """\
## Balls

Measured lift and drag of spinning balls, and the form law at the roughness and Reynolds number of each. The published law has
no Reynolds number: its lift is 4/3 of the spin, its drag 0.5 and more.
"""

TABLE = """\
## Sets

Of the coefficients [over the Reynolds number](#over-the-reynolds-number): factors exp(rms), and the mean ratio of the form law to what was measured.
"""

MOTION = """\
## Motions

Regimes as [path_summary.h](../demos/analysis/path_summary.h) has them, from the second half of each fall. Released at
rest, with default settings. Discs, spheroids and strips are without size: their fluid is that of a Reynolds number of
2000, their weight that of speed 1 broadside; 120 of their widths at that speed are run. `mixed` is what the literature
calls chaotic. The discs' borders, I* = 0.01 to some 0.05 and 0.1, are from memory, to a factor of 1.5. Strips within
the measured error of the border (0.67 ± 0.05) are drawn and not counted.
"""

REGIMES = """\
A regime counts as right only if the name is that of the measurement. What the form law misses: heavy discs and
spheroids that are released at 5° stay broadside, discs of I* = 0.015 tumble, strips at a Froude number of 0.85 tumble and glide
in turn, Andersen's plates of 1/8 flutter from some releases. Cards autorotate too fast and with too little drag.
The published law falls flat or dives edge-on at many times the broadside speed, and then uses all
its substeps; with round edges it flutters and tumbles too. Above its tolerance in more than a tenth of the steps:
{coarse_published} of {falls} falls by the published law, {coarse_form} by the form law. Tried once with half and twice
the steps, one and two regimes fewer were right: between flutter and tumbling, runs hang on rounding.
"""

SPEEDS = """\
Final speeds of cubes and balls in water, at 60 Hz, released 3° off level; measured: by the coefficient in brackets. By
the published law a cube turns a face ahead, which has no drag; it chatters about that attitude, uses up its substeps,
and its speed depends on the step. Balls that sink are compared with the drag of smooth spheres at their own Reynolds number,
Achenbach's (1972): the largest are beyond the crisis.
"""

ROUND = """\
## Balls

By the published law lift grows with the spin without end, and drag knows no crisis: a separation angle has to be typed for each
ball. The form law has both from the Reynolds number and the roughness of the pattern, as in the [scenes](experiments.md) of balls.
"""

TABLE = """\
## Coefficients

On the frontal area but for plates at incidence (their own area) and falling particles (the sphere of equal volume, mean
over 200 attitudes). At the Reynolds number and roughness of each source, or 10⁵ where none is told. A dash: less than {floor}.
"""

MEMORY = """\
Quoted from memory, none of which is counted above:
"""

STALL = """\
Incidence of largest lift of thin rectangular wings. By the published law a plate has most lift at no
incidence.
"""

TRIED = """\
## What each term is good for

Each term of the [form law](theory.md#11-the-form-law) was taken out once, in its source, and this page made again, before the law had
a Reynolds number; what each term of [that](theory.md#19-any-reynolds-number) is good for was tried in a prototype. Read regimes as ± 3: between flutter and tumbling, runs hang on rounding. A glider is a flat plate whose centre of mass lies 0.20 of the
chord ahead of its middle, `glider` with spans of 1, 3 and 7 chords.

| without | rms | regimes | what is lost |
|---|---|---|---|
| nothing | 0.370 | 85 | |
| the vortices $\\pi\\nu$ in (43b) | 0.396 | 78 | plates at incidence 1.32 in place of 1.11; stall of short plates; spheroids tumble wrongly |
| $K'$ in (43b): $K$ along the span as well | 0.370 | 85 | wings of half a chord of span have their largest lift at 22°, measured 44°, with it 37° |
| the mean plane in (43a): incidence to the face alone | 0.370 | 82 | coins of 0.24 to 0.37 m/s in place of 0.25 to 0.48; blades stall as plates do |
| the relief of pitching (43d) | 0.370 | 80 | strips 16 of 36 in place of 23 |
| thickness in $W$ (45a) | 0.396 | 84 | cylinders across 1.21 in place of 1.13, half balls and spheroids 1.59 in place of 1.36 |
| one way in $W$ (45a) | 0.405 | 85 | half balls and cups 2.3 in place of 1.36 |
| $E$ (45c), which makes no body slender or smooth | 0.386 | 85 | hulls, football |
| $m$ (45d) | 0.387 | 85 | hulls: side force 2.7 in place of 1.1 at 4 : 1 |
| $\\tau$ (43e) | 0.370 | 85 | football: 72.8 m in place of 66.5 m, measured 66.4 m |
| $\\tfrac12W(1 - f_0)$ in (47) | 0.370 | 87 | coins of 0.18 m/s, measured 0.41 m/s |
| the same, without the half | 0.370 | 80 | cards autorotate at 1.3 times the speed |
| $\\xi_w$ in (49a): the whole lag | 0.370 | 85 | gliders of 7 : 1 do not glide |
| $f_0$ in (49a): 1 in its place | 0.370 | 88 | no glider glides |
| the lower branch of (49a) | 0.370 | 82 | cards fall 1.4 times as fast |

**W per face**, from the thickness of the body under it, would give pitched blades more lift. The most it can give is $W = 1$ on all
faces: so tried, the toy propeller climbs 0.59 m in place of 0.51 m, not the 0.68 m of the published law, and sheets, which have $W = 1$,
stay as they are. It was not made; fins of one mesh with their hull have the hull's $W$.
"""

DRAWN = """\
## Drawn after the law was frozen

These {drawn} coefficients and {drawn_motions} motions were searched for after the law had got its form and its numbers (commit
e10bd8d), and count in no other sum of this page than the row that names them. They come from what some eighty searches
of public pages, programs and data files showed: every number was taken whose body, attitude, fluid and
source were told well enough to make the body here, and whose body and attitude were not in the table, before the
library's value was computed. Of dense curves two or three points were taken by incidence. Left out for want of a size, a mass or a
centre of mass: coffee filters, paper helicopters, winged and gliding seeds, washers; ring wings, whose table could not be reached, and
thrown discs, whose numbers may be computed. Notes in measurements.json say which sizes are from memory. The rms of ln(library/measured)
is **{drawn_rms_published} by the published law and {drawn_rms_form} by the form law**.
"""

DRAWN_MOTIONS = """\
Motions, each from three releases: the median is shown, or the regimes and in how many releases they agree with the measured ones.
"""

NOT = """\
## What is not compared

- Vortex shedding, starts in liquids (the history force), walls, slip of bubbles and drops: neither law has them.
- Micro plastics: only their ratios of axes are public.
- Suction at the base of a plate: measured 0.38 (Eiffel), while the form law's 0.12 on the lee side stands for all
  bodies.
- Winged seeds: their geometry is not in the sources.
- Vibration of light rising balls, whose measured drag of 0.95 stands in the table. Beyond Re 2e5 it was not found; the
  ball of 20 cm that rises is compared with it all the same.

## Sources

Letters are those of the tables. Addresses are those of public texts in which the numbers were seen; libraries move
their pages.
"""
