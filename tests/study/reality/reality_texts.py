"""The words of docs/reality.md; {names} are filled in from the numbers."""

HEAD = """\
# Reality

Measured coefficients and motions of bodies in air and water, and what this library makes of them: by its own law of the
pressure, the [form law](theory.md#11-the-form-law), which is the default, and by the published one of Padilla et al. (2025).

| bodies | off by a factor, typically | by the published law |
|---|---|---|
| cubes, polyhedra, plates and discs broadside | {flat_form} | no drag on flat faces |
| cylinders across; end-on; cones | {across_form}; {end_form}; {cone_form} | {across_published}; no drag; {cone_published} |
| plates at incidence | {incidence_form} | {incidence_published} |
| long plates and rods, above 10 : 1 | {long_form}; rods have more than plates | no drag |
| half balls, cups and spheroids | {round_form}; no suction on shoulders, no hollows | {round_published} |
| balls | {ball_form} at the default separation angle | the same |
| streamlined bodies | 9: no pressure comes back at the tail | 19 |
| falling discs, strips, plates and cards | regime right in {regime_form} runs; speeds to a factor of about 2 | {regime_published} |

A factor is that whose logarithm is the rms over the cases of the kind, drag coefficients and the like.
Over the whole table the rms of ln(library/measured) is **{rms_published} by the published law and {rms_form} by the form
law**, over what no parameter was fitted on {unfitted_published} and {unfitted_form}. The regime of falling is right in
**{share_published} of runs by the published law and {share_form} by the form law**.

Everything here but the words is written by

<!-- not run: takes minutes -->
    demos/run --reality

from [measurements.json](../data/reality/measurements.json) and from runs of this very library. Each number has its
source, [below](#sources), with what of it was seen; what could not be found in a public text and is quoted from memory
is marked so, and left out of the sums of coefficients. Bodies that float, enter water or are driven under it
are on a [page of their own](reality_at_sea.md).

## Sums

0 counts as {floor}. A ratio of 1.25 or 1.5 either way is counted as within it.
"""

FITTED = """\
Three numbers of the form law were fitted, on the cases marked `fit`: the suction e = 0.12 on the lee side, the 40 in
the drag of long flat sides, on Eiffel's plates broadside, and the stall of long plates, 0.18 in (43a), on his plates of 1, 2 and
6 to 1 at incidence. `held` cases were not used for that, but were in view when the form of the law was chosen; `fresh` ones were drawn after the first form law was
frozen, `drawn` ones [below](#drawn-after-the-law-was-frozen) after the present one, and `none` marks those collected for this page. Many of the latter are the same bodies measured by others, so
that they test the numbers more than the idea. c = 1.17 is the measured drag of a disc or square plate, 1.98 that of a
strip without end.

Per kind of body, the factor exp(rms), and how many are within 1.5:
"""

PLATE = """\
## Plates at incidence

The form law drawn is that of a square plate. Longer plates have a steeper rise and an earlier stall, as measured; those of
1.25 to 2 stall some degrees late, those of 3 and 4 some degrees early.
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
spheroids that are released at 5° stay broadside, strips at a Froude number of 0.6 glide off, Andersen's plates of 1/8 and 1/5
flutter or stay broadside from some releases. Cards autorotate too fast and with too little drag.
The published law falls flat or dives edge-on at many times the broadside speed, and then uses all
its substeps; with round edges it flutters and tumbles too. Above its tolerance in more than a tenth of the steps:
{coarse_published} of {falls} falls by the published law, {coarse_form} by the form law. Tried once with half and twice
the steps, one and two regimes fewer were right: between flutter and tumbling, runs hang on rounding.
"""

SPEEDS = """\
Final speeds of cubes and balls in water, at 60 Hz, released 3° off level; measured: by the coefficient in brackets. By
the published law a cube turns a face ahead, which has no drag; it chatters about that attitude, uses up its substeps,
and its speed depends on the step.
"""

ROUND = """\
## Balls

Both laws share the closed forms of the smooth sphere. Real balls have more lift at small spin and less at large, and
less drag beyond the drag crisis; a larger separation angle stands for that in the [scenes](experiments.md) of golf
balls.
"""

TABLE = """\
## Coefficients

On the frontal area but for plates at incidence (their own area) and falling particles (the sphere of equal volume, mean
over 200 attitudes). At a Reynolds number of 10⁵, with friction. A dash: less than {floor}.
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

Each term of the [form law](theory.md#11-the-form-law) was taken out once, in its source, and this page made again. Read regimes as
± 3: between flutter and tumbling, runs hang on rounding. A glider is a flat plate whose centre of mass lies 0.20 of the
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

- The drag crisis, Reynolds numbers below some 1000, vortex shedding: neither law has them.
- Suction at the base of a plate: measured 0.38 (Eiffel), while the form law's 0.12 on the lee side stands for all
  bodies.
- Winged seeds: their geometry is not in the sources.
- Vibration of light rising balls, whose measured drag of 0.95 stands in the table.

## Sources

Letters are those of the tables. Addresses are those of public texts in which the numbers were seen; libraries move
their pages.
"""
