#!/usr/bin/python3
"""Writes docs/reality.md or docs/reality_at_sea.md and its pictures: plot_reality.py MEASUREMENTS.json OUT -o DOCS, with
OUT from `reality`."""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
sys.path.append(str(Path(__file__).resolve().parents[3] / "demos/plot"))

import reality_figures as figures
import reality_tables as tables
import reality_texts as texts
import sea_page
from experiment_tables import table
from files import reading
from reality_numbers import FLOOR, LAWS, Reality, Sea, is_sea, rms
from reality_page import Page

KINDS = {
    "flat": "cubes, polyhedra, plates and discs broadside",
    "end": "cylinders end-on",
    "across": "cylinders across",
    "cone": "cones",
    "long": "long plates and rods",
    "incidence": "plates at incidence",
    "round": "half balls, cups and spheroids",
    "ball": "balls",
}


CURVE_KINDS = {
    "spheres": ("settling: spheres", True),
    "discs": ("settling: discs broadside", True),
    "spheroids": ("settling: spheroids", True),
    "polyhedra": ("settling: polyhedra", True),
    "grains": ("settling: grains, sand, rods", True),
    "sand": ("settling: grains, sand, rods", False),
    "crisis": ("crisis: smooth and sand-rough spheres", True),
    "drag": ("crisis: balls, drag", True),
    "lift": ("crisis: balls, lift", True),
    "inside": ("inside the crisis", True),
    "cylinders": ("crisis: long cylinders", True),
    "hulls": ("hulls and drops: drag", True),
    "side": ("hulls: side force", False),
}


def numbers_of(reality):
    """What the texts name."""
    made = {"floor": f"{FLOOR:g}"}
    for key, kind in KINDS.items():
        cases = [case for case in reality.cases if case.kind == kind]
        made.update({f"{key}_{law}": tables.factor(cases, law) for law in LAWS})
    kinds = reality.curves.kinds()
    for key, kind in CURVE_KINDS.items():
        made.update({f"{key}_{law}": tables.factor(kinds[kind][0], law) for law in LAWS})
    made["held"] = sum(len(held) for (_, verified), (_, held) in kinds.items() if verified)
    made["memory_points"] = sum(len(points) for (_, verified), (points, _) in kinds.items() if not verified)
    made.update(drawn=len(reality.drawn), drawn_motions=len(reality.motions("drawn")))
    families = [family for family, _, _ in tables.FAMILIES]
    for law in LAWS:
        made[f"rms_{law}"] = f"{rms(reality.cases, law):.2f}"
        made[f"drawn_rms_{law}"] = f"{rms(reality.drawn, law):.2f}"
        made[f"unfitted_{law}"] = f"{rms(reality.unfitted(), law):.2f}"
        right, runs = reality.regimes(families, law)
        made[f"regime_{law}"] = f"{right} of {runs}"
        made[f"share_{law}"] = f"{100 * right / runs:.0f} %"
        falls = [fall for fall in reality.falls if fall.law == law]
        made[f"coarse_{law}"], made["falls"] = sum(fall.coarse > 0.1 for fall in falls), len(falls)
    return made


def add_sums(page, reality, numbers):
    page.add(texts.HEAD.format(**numbers))
    head = ("set", "n", "rms published", "rms form", "within 1.25, 1.5 published", "within 1.25, 1.5 form")
    page.add(table(head, tables.sum_rows(reality)))
    page.add_picture("coefficients", figures.draw_coefficients(reality), "Measured coefficients and those of both laws")
    page.add(texts.FITTED)
    head = ("bodies", "n", "factor published", "factor form", "within 1.5 published", "within 1.5 form")
    page.add(table(head, tables.kind_rows(reality)))
    page.add(texts.PLATE)
    page.add_picture("plate", figures.draw_plate(reality), "Normal force of plates over incidence")


def add_motions(page, reality, numbers):
    page.add(texts.MOTION)
    page.add(table(("bodies", "measured", "right published", "right form"), tables.regime_rows(reality)))
    page.add_picture("regimes", figures.draw_regimes(reality), "Regimes of falling discs, spheroids and strips")
    page.add(texts.REGIMES.format(**numbers))
    page.add_picture("plates", figures.draw_plates(reality), "Falling plates of Andersen et al.")
    head = ("motion", "measured", "source", "published", "ratio", "form", "ratio")
    page.add(table(head, tables.motion_rows(reality)))
    page.add(texts.SPEEDS)
    head = ("body", "measured [m/s]", "published", "ratio", "substeps", "form", "ratio", "substeps")
    page.add(table(head, tables.speed_rows(reality)))
    page.add_picture("speeds", figures.draw_speeds(reality), "Speeds of cubes and balls in water over size")


def add_curves(page, reality, numbers):
    curves = reality.curves
    page.add(texts.CURVES.format(**numbers))
    head = ("kind", "points", "Re", "factor published", "factor form", "form, where nothing was fitted")
    page.add(table(head, tables.curve_kind_rows(curves)))
    page.add_picture("curves", figures.draw_curves(curves), "Drag and terminal speeds over the Reynolds number")
    page.add(texts.FLIGHTS)
    head = ("flight", "measured", "source", "published", "ratio", "form", "ratio")
    page.add(table(head, tables.flight_rows(reality)))


def add_tables(page, reality, numbers):
    page.add(texts.ROUND)
    page.add_picture("balls", figures.draw_balls(reality), "Lift and drag of spinning balls")
    page.add(texts.TABLE.format(**numbers))
    page.add(table(tables.CASE_HEAD, tables.case_rows(reality.cases)))
    page.add(texts.MEMORY)
    page.add(table(tables.CASE_HEAD, tables.case_rows(reality.from_memory)))
    page.add(texts.STALL)
    page.add(table(("span/chord", "measured", "source", "published", "form"), tables.stall_rows(reality)))
    page.add(texts.DRAWN.format(**numbers))
    page.add(table(tables.CASE_HEAD, tables.case_rows(reality.drawn)))
    page.add(texts.DRAWN_MOTIONS)
    head = ("motion", "measured", "source", "published", "ratio", "form", "ratio")
    page.add(table(head, tables.drawn_motion_rows(reality)))
    page.add(texts.CURVE_TABLE)
    head = ("body", "kind", "source", "points", "Re", "published", "form", "form, mean ratio", "fitted")
    page.add(table(head, tables.curve_rows(reality.curves)))
    page.add(texts.TRIED)
    page.add(texts.NOT)
    page.add(table(("", "work", "seen", "pages"), tables.source_rows(reality)))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("measurements", type=Path, metavar="MEASUREMENTS.json")
    parser.add_argument("out", type=Path, nargs="?", metavar="OUT", help="what `reality` wrote; motions at sea are run")
    parser.add_argument("-o", "--docs", type=Path, required=True, metavar="DOCS")
    arguments = parser.parse_args()
    with reading(arguments.measurements, "a file of measurements"):
        at_sea = is_sea(arguments.measurements)
    if at_sea:
        sea_page.write(Sea(arguments.measurements), arguments.docs)
        return
    with reading(arguments.out, "a folder of results of reality"):
        reality = Reality(arguments.measurements, arguments.out)
        numbers = numbers_of(reality)
    page = Page(arguments.docs, "reality", "reality")
    add_sums(page, reality, numbers)
    add_motions(page, reality, numbers)
    add_curves(page, reality, numbers)
    add_tables(page, reality, numbers)
    page.write()


if __name__ == "__main__":
    main()
