"""The words of docs/reality.md; {names} are filled in from the numbers."""

HEAD = """\
# Reality

Measured coefficients and motions of bodies in air and water, and what this library makes of them by its two pressure
laws, [theory](theory.md#11-flat-faces).

| bodies | law to trust | off by a factor, typically |
|---|---|---|
| cubes, polyhedra, plates and discs broadside | form | {flat_form} (published: no drag on flat faces) |
| cylinders across; end-on; cones | form | {across_form}; {end_form}; {cone_form} (published {across_published}; none; {cone_published}) |
| plates at incidence | form | {incidence_form}, no stall (published {incidence_published}) |
| long plates and rods, above 10 : 1 | form | {long_form}; rods have more than plates (published: none) |
| half balls, cups and spheroids | form | {round_form} (published {round_published}); no suction on shoulders, no hollows |
| balls | the same in both | {ball_form} at the default separation angle |
| streamlined bodies | neither | 10 and more: no pressure comes back at the tail |
| falling discs, strips, plates and cards | form | regime right in {regime_form} runs (published {regime_published}); speeds to a factor of about 2 |

A factor is that whose logarithm is the rms over the cases of the kind, drag coefficients and the like.
Over the whole table the rms of ln(library/measured) is **{rms_published} by the published law and {rms_form} by the form
law**, over what no parameter was fitted on {unfitted_published} and {unfitted_form}. The regime of falling is right in
**{share_published} of runs by the published law and {share_form} by the form law**.

Everything here but the words is written by

<!-- not run: takes minutes -->
    demos/run --reality

from [measurements.json](../data/reality/measurements.json) and from runs of this very library. Each number has its
source, [below](#sources), with what of it was seen; what could not be found in a public text and is quoted from memory
is marked so, and left out of the sums of coefficients.

## Sums

0 counts as {floor}. A ratio of 1.25 or 1.5 either way is counted as within it.
"""

FITTED = """\
Two numbers of the form law were fitted, on the cases marked `fit`: the suction e = 0.12 on the lee side, and the 40 in
the drag of long flat sides, on Eiffel's plates broadside. `held` cases were not used for that, but were in view when the form of the law was chosen; `fresh` ones were drawn after the law was
frozen, and `none` marks those collected for this page. Many of the latter are the same bodies measured by others, so
that they test the numbers more than the idea. c = 1.17 is the measured drag of a disc or square plate, 1.98 that of a
strip without end.

Per kind of body, the factor exp(rms), and how many are within 1.5:
"""

PLATE = """\
## Plates at incidence

The form law drawn is that of a square plate, without stall. Square plates have more normal force from 20° to 45°
(Eiffel's peak of 1.55 at 37°), slender wings more below 20°. A plate of aspect ratio 10 has 1.11 times it by (45).
"""

MOTION = """\
## Motions

Regimes as [falling_mode.h](../demos/analysis/falling_mode.h) has them, from the second half of each fall. Released at
rest, with default settings. Discs, spheroids and strips are without size: their fluid is that of a Reynolds number of
2000, their weight that of speed 1 broadside; 120 of their widths at that speed are run. `mixed` is what the literature
calls chaotic. The discs' borders, I* = 0.01 to some 0.05 and 0.1, are from memory, to a factor of 1.5. Strips within
the measured error of the border (0.67 ± 0.05) are drawn and not counted.
"""

REGIMES = """\
A regime counts as right only if the name is that of the measurement. What the form law misses: heavy discs and
spheroids that are released at 5° stay broadside, strips at a Froude number of 0.6 glide off, discs at I* = 0.015 dive
and turn over now and then, Andersen's plate of 1/8 flutters widely. Descents of fluttering bodies just below the
border are too fast. The published law falls flat or dives edge-on at many times the broadside speed, and then uses all
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
## What was tried

Variants of the form law over the whole of this page. Kept is what brings the table nearer and worsens nothing; two
regimes are within rounding; $y$ is that of (45).

| variant | rms | regimes | plates at incidence, factor | |
|---|---|---|---|---|
| no regard to aspect ratio | 0.450 | 81 | 1.46 | as it was |
| long flat sides have more drag, (45) | 0.429 | 83 | 1.41 | kept |
| and the slip presses on the windward side alone, (43) | 0.428 | 82 | 1.41 | kept: the lee side is free, cones and half balls are nearer |
| steeper everywhere: $2.5$ for $2$ in $2\\sin i - \\sin^2 i$ | 0.408 | 81 | 1.25 | streamlined bodies and cylinders across farther |
| $3$ for $2$ | 0.413 | 79 | 1.24 | the same, and cubes |
| steeper on long flat sides: $2 + y/(y + 1)$ | 0.403 | 78 | 1.26 | strips that should flutter glide |
| $2 + \\tfrac12y/(y + 1)$ | 0.412 | 79 | 1.31 | the same |
| $\\sin^2 i$ in the lee, nothing more on the windward side | 0.447 | 79 | 1.52 | plates farther |
| that, $2.25 + y/(y + 1)$ windward | 0.403 | 81 | 1.26 | regimes fewer |
| that, $2.4$ windward, b = 1, e = 0.17 | 0.423 | 80 | 1.39 | no reason for it |

So wings want a normal force that is steep below 15° and saturates, and falling strips do not want it: their stall and
lag, (48) to (50), were chosen with the slope as it is. Who takes that up has to do both.

Where the law is known to fail, by sums over plates and bodies of revolution alone, `demos/plot/form_variants.py`:

| variant | where | (43) | variant | measured |
|---|---|---|---|---|
| on faces more curved than the sphere, sharpness by the curvature along the slip | side force of a hull of 8.57 : 1, per radian | 9.5 | 0.98 | 0.56 (memory) |
| | its drag, nose first | 0.27 | 0.07 | |
| | cones of 15°, 30°, apex first | 0.30, 0.43 | 0.18, 0.35 | 0.34, 0.51 |
| | normal force of a cylinder of 20 : 1 at 30° | 0.63 | 0.17 | 0.27 if as $\\sin^2$ |
| a peak before the stall, $4h\\,u_n^2(1 - u_n^2/\\lvert u\\rvert^2)^2$ more with $h$ = 0.85 | square plates at 6° to 37° (Eiffel), factor | 1.35 | 1.16 | |
| | cube edge-on | 1.07 | 1.49 | 0.8 |
| no suction on the base from one diameter of length on | cylinders end-on, factor | 1.31 | 1.19 | |
| and 0.75 in place of $b$ on the front, 0.1 on the base there | | | 1.08 | |
| a lag of 0, 1, 2, 3 for 4.5 | the 10 cm plate, released at 85° | tumbles, 0.15 m/s | tumbles, 0.30, 0.17, 0.14, 0.16 m/s | flutters |

None is taken. The first is the one to go on with: hulls would have twice the measured side force in place of 17 times, and
oblique rods would follow the flow across them. It needs two curvatures and a direction per face in files and kernels,
and cones would need suction at their base for what they lose. A peak cannot be told by a face, because the squares of a cube
edge-on stand as those of a plate; nor can what is behind a base. The 10 cm plate:
`ambient_demo plate_10cm --set law=form --set bodies.0.stall_lag=1`.
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
