"""The tables of docs/reality.md."""

import math
import statistics

from reality_numbers import FLOOR, LAWS, rms, within

FAMILIES = (
    ("disc", "thin discs, I* 0.001 to 0.5, from 5, 45, 85°", "Field et al. 1997; borders from memory"),
    ("strip", "thin strips, Froude number 0.3 to 2, from 20, 45, 70°", "Belmonte et al. 1998"),
    ("plate", "aluminium plates in water, h/l 1/14, 1/8, 1/5, from 11.5, 30, 60°", "Andersen et al. 2005; 2 from memory"),
    ("card", "cards of 80 to 1000 g/m² in air, from 60, 85°", "Smith 1970, Mahadevan et al. 1999: cards tumble"),
    ("long card", "cards of 300 mm × 30 to 60 mm in air, from 60°", "Mahadevan et al. 1999"),
    ("spheroid", "10 : 1 spheroids, I* 0.004 to 0.3, from 5, 45, 85°", "as the discs, whose edges are not round"),
)


def number(value):
    return "0" if abs(value) < 5e-4 else f"{value:.3g}"


def ratio(value, measured):
    return "–" if value < FLOOR else f"{value / measured:.2f}"


def attitude(row):
    return row["attitude"].replace("incidence ", "").replace(" deg", "°")


def source(row):
    return row["source"] + ("" if row["verified"] else " (memory)")


def case_rows(cases):
    rows = []
    for case in cases:
        row, models = case.row, [case.model[law] for law in LAWS]
        cells = [cell for model in models for cell in (number(model), ratio(model, case.value))]
        what = row["quantity"].split(" on ")[0].split(" =")[0].split(" (")[0]
        rows.append((row["body"], attitude(row), what, number(case.value), source(row), *cells, row["fitted"]))
    return rows


CASE_HEAD = ("body", "attitude", "what", "measured", "source", "published", "ratio", "form", "ratio", "fitted")


def factor(cases, law):
    return f"{math.exp(rms(cases, law)):.2f}"


def kind_rows(reality):
    rows = []
    for kind in dict.fromkeys(case.kind for case in reality.cases):
        cases = [case for case in reality.cases if case.kind == kind]
        shares = (f"{within(cases, law, 1.5)}" for law in LAWS)
        rows.append((kind, str(len(cases)), *(factor(cases, law) for law in LAWS), *shares))
    return rows


def sum_rows(reality):
    sets = (
        ("all coefficients", reality.cases),
        ("those that no parameter was fitted on", reality.unfitted()),
        ("those not in view either when the law was chosen", reality.unseen()),
        ("all but balls", [case for case in reality.cases if case.kind != "balls"]),
        ("all but those where the published law has none", [c for c in reality.cases if c.model["published"] >= FLOOR]),
        ("quoted from memory, not among the above", reality.from_memory),
        ("drawn after the law was frozen, not among the above", reality.drawn),
    )
    rows = []
    for name, cases in sets:
        shares = (f"{within(cases, law, 1.25)}, {within(cases, law, 1.5)}" for law in LAWS)
        rows.append((name, str(len(cases)), *(f"{rms(cases, law):.2f}" for law in LAWS), *shares))
    return rows


def reach_of(points):
    ends = min(point.reynolds for point in points), max(point.reynolds for point in points)
    return " to ".join(dict.fromkeys(f"{end:.1g}".replace("e+0", "e").replace("e-0", "e-") for end in ends))


def curve_kind_rows(curves):
    rows = []
    for (kind, verified), (points, held) in sorted(curves.kinds().items(), key=lambda item: not item[0][1]):
        name = kind + ("" if verified else " (memory)")
        factors = (*(factor(points, law) for law in LAWS), factor(held, "form") if held else "–")
        rows.append((name, str(len(points)), reach_of(points), *factors))
    return rows


def curve_rows(curves):
    rows = []
    for entry in curves.sets:
        points = entry["made"]
        factors = (factor(points, law) for law in LAWS)
        mean = math.exp(sum(point.error("form") for point in points) / len(points))
        cells = (entry["kind"], source(entry), str(len(points)), reach_of(points), *factors, f"{mean:.2f}", entry["fitted"])
        rows.append((entry["body"], *cells))
    return rows


def flight_rows(reality):
    rows = []
    for row, values in reality.motions("none"):
        cells = []
        for law in LAWS:
            shown = values[law][0]
            of = "–" if row["motion"]["what"] == "miss" else ratio(shown, row["value"])
            cells += (number(shown), of)
        measured = f"flew {row['value']:.3g}" if row["motion"]["what"] == "miss" else number(row["value"])
        rows.append((f"{row['body']}, {row['attitude']}: {row['quantity']}", measured, source(row), *cells))
    return rows


def regime_rows(reality):
    rows = []
    for family, name, origin in FAMILIES:
        shares = ("{} of {}".format(*reality.regimes([family], law)) for law in LAWS)
        rows.append((name, origin, *shares))
    return rows


def speed_of(fall):
    return math.hypot(fall.descent, fall.drift)


def autorotation(fall, width=0.055, mass_per_area=0.3):
    """Mean C_L, C_D and rate of a card that glides steadily while it tumbles."""
    speed, density = speed_of(fall), 1.204
    load = mass_per_area * 9.81 / (0.5 * density * speed**2)
    return load * fall.drift / speed, load * fall.descent / speed, fall.spin * width / (2 * speed)


def exponent(reality, law, names, values):
    """Of the spin over a value, where the cards tumble."""
    falls = [reality.fall("long card", name, law) for name in names]
    if any(fall.mode != "tumbling" for fall in falls):
        return None
    return math.log(falls[-1].spin / falls[0].spin) / math.log(values[-1] / values[0])


def motion_numbers(reality):
    """Name, measured, unit, source, and what the laws give; None where the motion is another."""
    rows = reality.rows
    made = []
    for name in ("coin_2", "coin_5", "coin_10", "coin_20", "coin_50"):
        falls = [reality.fall("coin", name, law).descent for law in LAWS]
        made.append((f"{rows[name]['body']}: descent", rows[name]["value"], "m/s", rows[name], falls))
    cards = [reality.fall("card", "business card 300 g/m2", law) for law in LAWS]
    for i, name in enumerate(("smith_cl", "smith_cd", "smith_rate")):
        values = [autorotation(card)[i] if card.mode == "tumbling" else None for card in cards]
        what = ("mean lift coefficient", "mean drag coefficient", "rate wc/2V")[i]
        what = f"autorotating plate (here: a card of 85 × 55 mm): {what}"
        made.append((what, rows[name]["value"], "", rows[name], values))
    plates = [reality.fall("plate", "1/8", law) for law in LAWS]
    for what, measured, unit in (("descent", 0.115, "m/s"), ("spin", 14.5, "rad/s")):
        values = [getattr(plate, what) if plate.mode == "tumbling" else None for plate in plates]
        made.append((f"aluminium plate, h/l = 1/8: {what}", measured, unit, rows["andersen_1_8_speed"], values))
    return made


def motion_rows(reality):
    rows = []
    for name, measured, unit, row, values in motion_numbers(reality):
        cells = []
        for value in values:
            shown = ("another motion", "–") if value is None else (number(value), f"{value / measured:.2f}")
            cells += shown
        rows.append((name, f"{measured} {unit}".strip(), source(row), *cells))
    widths = ["width 30 mm", "width 45 mm", "width 60 mm"]
    masses = ["150 g/m2", "width 45 mm", "600 g/m2"]
    for what, names, values, measured in (("width", widths, (30, 60), "-1"), ("thickness", masses, (150, 600), "1/2")):
        powers = [exponent(reality, law, names, values) for law in LAWS]
        cells = [cell for p in powers for cell in (("another motion" if p is None else f"{p:.2f}"), "–")]
        rows.append((f"long cards: exponent of the spin over the {what}", measured, "MRS", *cells))
    return rows


def agreement(row, values):
    """What a law gives for a drawn motion, and its ratio to the measured value or the share of releases that agree."""
    if isinstance(row["value"], list):
        right = sum(value in row["value"] for value in values)
        return ", ".join(dict.fromkeys(values)), f"{right} of {len(values)}"
    value = statistics.median(values)
    return number(value), f"{value / row['value']:.2f}"


def drawn_motion_rows(reality):
    rows = []
    for row, values in reality.motions("drawn"):
        measured = " or ".join(row["value"]) if isinstance(row["value"], list) else number(row["value"])
        cells = [cell for law in LAWS for cell in agreement(row, values[law])]
        rows.append((f"{row['body']}, {row['attitude']}: {row['quantity']}", measured, source(row), *cells))
    return rows


# Drag of smooth spheres of 2500 kg/m3 by size [m] at their own Reynolds numbers, 7e4 to 4e6 (Achenbach 1972).
SINKING = {0.05: 0.49, 0.1: 0.51, 0.2: 0.12, 0.4: 0.17}


def speed_rows(reality):
    """Final speeds of cubes and balls in water."""
    rows = []
    bodies = (("cube", "600"), ("cube", "2500"), ("sphere", "600"), ("sphere", "2500"))
    for family, density in bodies:
        for size in (0.05, 0.2):
            measured = 1.05 if family == "cube" else 0.95 if density == "600" else SINKING[size]
            expected = terminal_speed(family, float(density), size, measured)
            falls = [reality.fall(family, density, law, size) for law in LAWS]
            cells = [
                cell
                for fall in falls
                for cell in (f"{abs(fall.descent):.2f}", f"{abs(fall.descent) / expected:.2f}", f"{fall.substeps:.1f}")
            ]
            rows.append((f"{family} of {100 * size:g} cm, {density} kg/m³", f"{expected:.2f} ({measured})", *cells))
    return rows


def terminal_speed(family, density, size, drag):
    """Of a body that moves face first in water [m/s]."""
    length = size if family == "cube" else 2 / 3 * size  # volume over frontal area
    return math.sqrt(2 * abs(density / 998 - 1) * 9.81 * length / drag)


def stall_rows(reality):
    rows = []
    for case in reality.stall:
        models = (f"{case.model[law]:g}°" for law in LAWS)
        rows.append((f"{case.row['shape']['size']:g}", f"{case.value}°", source(case.row), *models))
    return rows


def source_rows(reality):
    used = {case.row["source"] for case in reality.cases + reality.drawn + reality.from_memory + reality.stall}
    used |= {row["source"] for row in reality.rows.values() if "flow" not in row}
    rows = rows_of_sources(reality, used)
    return rows + rows_of_sources(reality.curves, set(reality.curves.sources) - used)


def rows_of_sources(reality, used):
    rows = []
    for name in sorted(used):
        entry = reality.sources[name]
        pages = dict.fromkeys(entry.get("addresses", []))
        for row in reality.rows.values():
            if row["source"] == name:
                pages.update(dict.fromkeys(row.get("addresses", [])))
        links = ", ".join(f"[{i}]({page})" for i, page in enumerate(pages, 1))
        rows.append((name, entry["citation"], entry["seen"], links or "–"))
    return rows
