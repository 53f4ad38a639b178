"""What docs/experiments.md says around its tables and pictures."""

HEAD = """# Experiments

The experiments of [Padilla 2025](theory.md#references), the models that the paper compares with, and scenes with
contacts and joints. Every number of "this library" in the tables and every picture is written by

<!-- not run: takes a quarter of an hour -->
    demos/run --all

from the logs of that very run, in `out`. `demos/run NAME` runs one scene of [data/scenes](../data/scenes). The tests in
[tests/demos](../tests/demos) run the same scenes. A dash means that nothing is known or published. Balls in flight and the scenes with
contacts and joints have the [default law](viscosity.md), all others name the paper's: `"law": "published"`.

The command rewrites this page and its pictures, which git tracks. The convergence is taken from the last
`demos/run --convergence` in `out`; where there was none, that section stays as it is. The command also writes
`out/experiments.html`: every run in 3D, to be played, scrubbed and turned in a browser.
"""

DIFFERENCES = """## Where the model is known to differ from reality

- **Golf.** The paper's launch speed of 53 m/s is that of the club head in the standard; the ball leaves at 78.7 m/s.
  With measured coefficients a ball carries about 147 m from 53 m/s; by the default law, which knows dimples of 0.2 mm
  and no angle, 140 m. The paper's 290 m are twice that: `--set law=published --set
  bodies.0.separation_angle=2.356194490192345` carries 291 m, with 1.6 times the measured lift and half of the drag.
- **Broadside drag.** By the published law a flat face that moves along its normal has no slip and so feels no dynamic
  pressure: a plate that settles broadside falls faster than a real one. `box_pile`, `flap_in_current` and `leaves` are
  run by the [form law](theory.md#11-the-form-law), which has that drag: both flaps stream where their moments balance,
  from wherever they are released: at 81.1°, and 0.7° above it with the step of the scene, because the lag of stall
  takes for a spin what a joint has not yet taken back at the end of a step (82.4, 81.8, 81.4, 81.2° at 1/120 to
  1/960 s). By the published law the one released at 45° hangs.
- **Football.** The moments of inertia are those quoted for a real ball, 0.00194 kg m² about the long axis and 0.00321
  across it (after Rae 2003 and Brody 1985; the originals were not at hand); a shell of this shape has 0.00209 and
  0.00342, a solid 0.00118 and 0.00220. With the shell the axis comes within 6.6°, with the solid within 28°. At the
  height of the throw the range is Rae's, but later: 2.8 s is the time of a throw without lift, and the model's ball,
  its nose above its path, has lift. On the ground that is 0.5 s more than in the paper.
- **Basketball.** Pebbles of 0.2 mm; smooth balls, which meet their crisis later, drift by 12.7, 17.8 and 26.3 m.
- **Bouncing.** Bullet applies restitution to the contact as a step finds it: with 0.8 a ball leaves with 0.8 to 0.98 of
  its speed. In a fluid it leaves with 0.8 at most ([theory](theory.md#7-contacts-and-joints), 28e).
- **Propellers.** A propeller of 4 g or less without a stick turns over in flight; the scene has 8 g. Under water it
  spins up and then turns over as well.
- **Paper copter.** A sheet without thickness: one strip of 80 g/m² paper, slit and folded, with a clip of 0.5 g. Its
  folds fall off outwards by 40°, which gives the wings a pitch. With 35° some releases, and with horizontal folds all,
  end tilted by 30° to 60° and hardly spinning: one wing is broadside to the air, where the model has no pressure. The
  fat proxy of the paper is `paper_copter_proxy`, without stem; with less pitch than 30° or less coning than 45° it
  keeps nutating.
- **Bunny.** Released on its back it finds another screw: 2.5 rad/s and 0.27 m/s.
- **Winged seed.** The paper could not make one autorotate. In this model a steady autorotation exists and is stable
  over a wide range: spun by hand at 230 rad/s, a maple's shape with a flat wing and 70 % of its mass in the nut keeps
  turning at 180 rad/s and falls at 0.5 m/s. With the scene's seed the centre of mass may lie from 3 mm farther back to
  4 mm farther forward on the chord of 11 mm, which gives 0.51 to 1.22 m/s. From rest that state is seldom reached: by
  the maple's shape in none of 24 releases in random directions (it falls at 6 m/s), by the scene's in 7. The scene's
  values were found by a random search: the nut at the trailing edge, half of the mass in it and a third in the vein of
  the leading edge, the wing pitched by 5.6° and drooping by 3.7°. Time steps from 1 to 4 ms give the same flight, and
  so do masses that differ by 1e-7 to 4e-4. A real seed, of a smaller kind, turns at 131 rad/s and falls at 1.2 m/s
  (Lee, Lee, Sohn: Experiments in Fluids 55, 2014).
- Plates are chaotic: compare modes, not positions; how far they can be trusted is in [data](../data/README.md).
"""

CONTACTS_END = """
`cards_in_wind` is run by the published law, whose pressure of the slip lifts a card that the wind passes along; the
form law has none there. The wind rises by 0.006°: along an exactly flat card n·u is zero, and rounding would decide by
eq. (13) of [theory](theory.md#4-surface-loads) on which side the flow is attached.
"""

RIVALS = """## Beside other models

All with the same inertia and the same integrator; `--set model=NAME` does it for any scene.

- `vacuum`: stock Bullet.
- `uwrbd`: "Underwater Rigid Body Dynamics" ([Weissmann 2012](theory.md#references)): linear drag with λ = 1, the
  traction −ρ c u. Its free parameter c is `linear_drag_speed`, 1 m/s.
- `gwtf`: a **stand-in** for "Going with the Flow" (Soliman et al. 2024), whose rule per face no public source gives:
  momentum flux on windward faces, −½ ρ A max(n·u, 0) u.

"""

RIVALS_END = """
As the paper reports, linear drag has no lift, both rivals shorten the golf ball's flight, the stand-in pushes the
spinning ball to the wrong side, and both damp the tumbling plate to a steady fall. Two things differ. The paper's
linear drag becomes unstable when it is weak: here the plate with c = 0.05 m/s falls steadily at 2 m/s, as the
integrator is passive. And the paper's "Going with the Flow" lifts the toy propeller, which the stand-in does not.

"""


CONVERGENCE = """## Convergence

Change of the gated numbers with half the time step, and with half the mesh size (a quarter of the faces instead, where
there are more than 2000 already). The tolerance is that of the tests; the 9 cm plate is chaotic, and 1e-7 of its mass
changes its mean speed by up to 9 %. `demos/run --convergence` repeats the runs.
"""


COST = """## Cost

Each cell has the value of the paper's table of computation times first, then that of this library (paper; ours).
Preparing: processor time of one thread, from the shape to the fluid body; where the file's triangles are few, the flow
is solved on up to 4200 panels. Step: one step of one body in the Bullet world, and the same without a fluid (density 0,
same integrator), least of 15 runs on one core. The paper's steps are 0.01 to 0.03 s on a faster processor and in
Python, here they are 1/240 s, so compare ratios; the paper's ratio is to its own rigid bodies with as many substeps,
here it is to Bullet's step.
"""
