#!/usr/bin/python3
"""Writes docs/experiments.md and its pictures from the runs of `demos/run --all`: experiments.py OUT -o DOCS."""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from experiment_numbers import Numbers
from paths import draw_overlay, draw_paths
from runs import Run

HEAD = """# Experiments

The experiments of [Padilla 2025](theory.md#references), the models that the paper compares with, and scenes with
contacts and joints. Every number of "this library" in the tables and every picture but that of the plates is written by

    demos/run --all

from the logs of that very run, in `out`. `demos/run NAME` runs one scene of [data/scenes](../data/scenes). The tests in
[tests/demos](../tests/demos) run the same scenes. A dash means that nothing is known or published.

The same command writes `out/experiments.html`: every run in 3D, to be played, scrubbed and turned in a browser.

"""

DIFFERENCES = """## Where the model is known to differ from reality

- **Golf.** The paper's launch speed of 53 m/s is that of the club head in the standard; the ball leaves at 78.7 m/s.
  With measured coefficients a ball carries about 147 m from 53 m/s, half of what the model gives: at a spin of S = 0.1
  the model's lift is 1.6 times and its drag half of the measured one.
- **Broadside drag.** A flat face that moves along its normal has no slip and so feels no dynamic pressure. The low flap
  of `flap_in_current` swings with hardly any damping, and a plate that settles broadside falls faster than a real one.
- **Football.** Range and alignment depend on the assumed inertia: 69 m and 10.4° at most for a shell (the scene), 65 m
  and 7.7° for a solid. It stays longer in the air than in the paper and in reality.
- **Basketball.** The drifts are those without skin friction. With it they are 14.0, 28.5 and 44.3 m.
- **Bouncing.** Bullet applies restitution to the contact as a step finds it: with 0.8 a ball leaves with 0.8 to 0.98 of
  its speed, stock or in a fluid.
- **Propellers.** A propeller of 4 g or less without a stick turns over in flight; the scene has 8 g. Under water it
  spins up and then turns over as well.
- **Paper copter.** A fat proxy, as in the paper, without stem. Pitch (30°) and coning (45°) were chosen so that it
  rights itself; with 15° and 25° it keeps nutating.
- Plates are chaotic: compare modes, not positions; how far they can be trusted is in [data](../data/README.md).
- Not here: the bunny and the winged seed.
"""

RIVALS = """## Beside other models

All with the same inertia and the same integrator; `--set model=NAME` does it for any scene.

- `vacuum`: stock Bullet.
- `uwrbd`: linear drag after [Weissmann 2012](theory.md#references) with λ = 1: the traction −ρ c u. Its free parameter
  c is `linear_drag_speed`, 1 m/s.
- `gwtf`: a **stand-in** for "Going with the Flow" (Soliman et al. 2024), whose rule per face no public source gives:
  momentum flux on windward faces, −½ ρ A max(n·u, 0) u.

"""

RIVALS_END = """
As the paper reports, linear drag has no lift, both rivals shorten the golf ball's flight, the stand-in pushes the
spinning ball to the wrong side, and both damp the tumbling plate to a steady fall. Two things differ. The paper's
linear drag becomes unstable when it is weak: here the plate with c = 0.05 m/s falls steadily at 2 m/s, as the
integrator is passive. And the paper's "Going with the Flow" lifts the toy propeller, which the stand-in does not.

"""


COST = """
## Cost

Time of one step of 1/240 s of the Bullet world, the same without a fluid (density 0, same integrator) and their ratio,
least of three runs on one core. The paper's ratio is to its own rigid bodies, at its own steps; its step of the plate
takes 2.58 ms.

"""


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def picture(docs, name, figure, caption):
    figure.savefig(docs / "images" / f"{name}.png", dpi=60)
    return f"\n![{caption}](images/{name}.png)\n"


def paper_rows(numbers):
    """Experiment, paper, this library, reality."""
    rows = []
    carries = [("golf_dimpled_spin", "290 m")]
    carries += [(scene, "figure only") for scene in ("golf_dimpled", "golf_smooth_spin", "golf_smooth")]
    for scene, paper in carries:
        reality = "289 m, launched faster; 147 m with measured coefficients" if paper == "290 m" else "-"
        rows.append((f"`{scene}`, carry", paper, f"{numbers.carry(scene):.1f} m", reality))
    rows.append(("`soccer_curl`, drift at 20 m", "4 m", f"{numbers.drift_at(20):.2f} m", "about 4 m (1997 free kick)"))
    drops = ", ".join(f"{x:.1f}" for x in numbers.drops())
    rows.append(("`basketball_drop`, drift at 1, 2, 3 turns per second", "figure only", drops + " m", "-"))
    place, time = numbers.throw("football")
    ours = f"{place:.1f} m, {time:.2f} s"
    rows.append(("`football`, range and time", "67.6 m, 2.85 s", ours, "66.4 m, 2.8 s (Rae 2003)"))
    fluid, vacuum = (numbers.axis_angle(name) for name in ("football", "football_vacuum"))
    ours = f"{fluid:.1f}°; vacuum {vacuum:.1f}°"
    rows.append(("axis off the path, late half, largest", "aligned; not so in a vacuum", ours, "aligned"))
    for size, mode in ((8, "tumbling"), (9, "chaotic"), (10, "flutter")):
        fall = numbers.fall(f"plate_{size}cm")
        ours = f"{fall['mode']}, {fall['descent_speed']:.2f} m/s down"
        rows.append((f"`plate_{size}cm`", mode, ours, "these modes exist"))
    tilts = ", ".join(f"{name} {tilt:.0f}°" for name, tilt in numbers.late_tilts(("0.2_g", "5_g", "10_g")))
    paper = "flutter, stable, free fall"
    rows.append(("`plate_mass_sweep`, tilt in the last half second", paper, tilts.replace("_", " "), "-"))
    lags = ", ".join(f"{name} {lag * 1000:.0f} mm" for name, lag in numbers.lags(("100_g", "500_g", "1_kg")))
    rows.append(("the same, behind a vacuum after 1 s", "-", lags.replace("_", " "), "-"))
    return rows + water_and_toy_rows(numbers)


def water_and_toy_rows(numbers):
    tilt, spin = numbers.copter()
    sinking, falling = numbers.end_speed("underwater_ellipsoid"), numbers.end_speed("paper_copter")
    spin_under_water = f"up to {numbers.largest_spin('underwater_propeller'):.1f} rad/s"
    balloon = f"{numbers.height('balloon'):.1f} m in 8 s, tilts up to {numbers.largest_tilt('balloon'):.0f}°"
    rocking = f"turns back {numbers.turns_back()} times, sinks at {sinking:.2f} m/s"
    return [
        ("`underwater_ellipsoid`", "glides and rocks", rocking, "glides and rocks"),
        ("`underwater_propeller`", "spins up", spin_under_water, "spins up"),
        ("`toy_propeller`", "climbs on a curved path", f"climbs {numbers.height('toy_propeller'):.2f} m", "climbs"),
        ("`balloon`", "unsteady ascent", balloon, "unsteady ascent"),
        (
            "`paper_copter`",
            "aligns and autorotates",
            f"{tilt:.1f}° off its descent, {spin:.1f} rad/s, {falling:.1f} m/s down",
            "autorotates",
        ),
    ]


def contact_rows(numbers):
    """Scene, what it shows, this library."""
    low, high = numbers.flap_angles()
    shift = numbers.largest_shift("box_pile") * 1000
    leaves = f"{numbers.end_tilt('leaves'):.1f}°, {numbers.end_speed('leaves') * 1000:.1f} mm/s"
    impact = f"{numbers.largest_speed('ball_on_bottom'):.3f} m/s"
    return [
        ("`ball_on_bottom`", "speed before the first bounce; closed form 1.240 m/s", impact),
        ("`box_pile`", "farthest that a box has moved in 4 s", f"{shift:.2f} mm"),
        ("`flap_in_current`", "mean angle from the vertical, late half: low, high", f"{low:.0f}°, {high:.0f}°"),
        ("`chain_in_water`", "largest speed after 12 s", f"{numbers.end_speed('chain_in_water'):.2f} m/s"),
        ("`leaves`", "largest tilt at rest, largest speed", leaves),
        ("`cards_in_wind`", "least way that a card is carried in 4 s", f"{numbers.least_shift('cards_in_wind'):.1f} m"),
    ]


def rival_rows(numbers):
    cells = {
        "free kick, drift at 20 m or the end": lambda model: f"{round(numbers.drift_at(20, model), 2) + 0:.2f} m",
        "golf, dimples and spin, carry": lambda model: f"{numbers.carry('golf_dimpled_spin', model):.0f} m",
        "8 cm plate": lambda model: "{mode}, {descent_speed:.2f} m/s".format(**numbers.fall("plate_8cm", model)),
        "toy propeller, climb": lambda model: f"{numbers.height('toy_propeller', model):.2f} m",
    }
    return [[name, *(cell(model) for model in ("ambient", "vacuum", "uwrbd", "gwtf"))] for name, cell in cells.items()]


def cost_rows(numbers):
    rows = []
    papers = {"plate_8cm": "5.07", "soccer_curl": "5.16", "golf_dimpled_spin": "4.97", "toy_propeller": "7.55"}
    for scene, paper in papers.items():
        fluid, empty, substeps = numbers.cost(scene)
        times = [f"{seconds * 1e6:.1f} µs" for seconds in (fluid, empty)]
        rows.append((f"`{scene}`", *times, f"{substeps:.1f}", f"{fluid / empty:.1f}", paper))
    return rows


def write(out, docs):
    numbers = Numbers(out)
    runs = lambda *names: [Run(out / name) for name in names]
    rivals = lambda scene, *models: runs(scene, *(f"{scene}-{model}" for model in models))
    text = HEAD + "## The paper's experiments\n\n"
    text += table(("experiment", "paper", "this library", "reality"), paper_rows(numbers))
    text += "\n![Plates](images/plates.png)\n"
    golf = runs("golf_dimpled_spin", "golf_smooth_spin", "golf_dimpled", "golf_smooth")
    text += picture(docs, "golf", draw_overlay(golf), "Golf balls")
    text += picture(docs, "basketball", draw_paths(runs("basketball_drop")), "Basketballs")
    text += "\n" + RIVALS + table(("", "`ambient`", "`vacuum`", "`uwrbd`", "`gwtf`"), rival_rows(numbers)) + RIVALS_END
    text += picture(docs, "rivals_soccer", draw_overlay(rivals("soccer_curl", "vacuum", "uwrbd", "gwtf")), "Free kick")
    text += picture(docs, "rivals_plate", draw_overlay(rivals("plate_8cm", "uwrbd", "gwtf")), "Plate of 8 cm")
    text += picture(docs, "rivals_propeller", draw_overlay(rivals("toy_propeller", "uwrbd", "gwtf")), "Toy propeller")
    text += "\n## Contacts and joints\n\n" + table(("scene", "quantity", "this library"), contact_rows(numbers))
    text += COST
    text += table(("scene", "step", "without a fluid", "substeps", "ratio", "paper's ratio"), cost_rows(numbers))
    text += "\n" + DIFFERENCES
    (docs / "experiments.md").write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path, metavar="OUT")
    parser.add_argument("-o", "--docs", type=Path, required=True, metavar="DOCS")
    arguments = parser.parse_args()
    write(arguments.out, arguments.docs)
    print(f"\nTable: {(arguments.docs / 'experiments.md').resolve()}")


if __name__ == "__main__":
    main()
