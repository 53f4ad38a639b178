#!/usr/bin/python3
"""Writes docs/experiments.md and its pictures from the runs of `demos/run --all`: experiments.py OUT -o DOCS."""

import argparse
import json
import re
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from attitudes import draw_attitudes, draw_spinners
from experiment_numbers import Numbers
from experiment_tables import contact_rows, paper_rows, rival_rows, table
from experiment_texts import CONTACTS_END, CONVERGENCE, COST, DIFFERENCES, HEAD, RIVALS, RIVALS_END
from falling_plates import PlanarFall, draw_falls
from paths import draw_drop, draw_overlay
from runs import Run
from study_tables import convergence_rows, cost_rows

RIVAL_MODELS = ("ambient", "vacuum", "uwrbd", "gwtf")


class Page:
    """The text so far; pictures go into DOCS/images."""

    def __init__(self, docs):
        self.docs, self.file, self.parts = docs, docs / "experiments.md", []

    def add(self, text):
        self.parts.append(text.strip("\n"))

    def add_picture(self, name, figure, caption):
        figure.savefig(self.docs / "images" / f"{name}.png", dpi=60)
        self.add(f"![{caption}](images/{name}.png)")

    def keep(self, heading):
        """Adds the section as it stands in the file, if it does."""
        old = self.file.read_text() if self.file.exists() else ""
        section = re.search(rf"^{re.escape(heading)}\n(?:(?!## ).*\n)*", old, re.MULTILINE)
        if section:
            self.add(section[0])

    def write(self):
        self.file.write_text("\n\n".join(self.parts) + "\n")


def add_experiments(page, numbers, runs):
    page.add("## The paper's experiments")
    page.add(table(("experiment", "paper", "this library", "reality"), paper_rows(numbers)))
    plates = runs("plate_8cm", "plate_9cm", "plate_10cm")
    page.add_picture("plates", draw_falls([PlanarFall(run) for run in plates]), "Plates")
    golf = runs("golf_dimpled_spin", "golf_smooth_spin", "golf_dimpled", "golf_smooth")
    page.add_picture("golf", draw_overlay(golf), "Golf balls")
    page.add_picture("basketball", draw_drop(runs("basketball_drop")[0]), "Basketballs")
    football = "a thrown football, in air and in a vacuum: its long axis every 0.25 s"
    page.add_picture("football", draw_attitudes(runs("football", "football_vacuum"), "x", 0.25, 4, title=football), "Football")
    water = runs("underwater_ellipsoid", "underwater_propeller", "underwater_bunny")
    figure = draw_attitudes(water, "xzz", 0.1, 0.08, until=4)
    page.add_picture("underwater", figure, "Underwater ellipsoid, propeller and bunny")
    page.add_picture("balloon", draw_attitudes(runs("balloon"), "z", 0.4, 0.5, across=True, height=8), "Balloon")
    figure = draw_spinners(runs("paper_copter", "paper_copter_proxy", "winged_seed"))
    page.add_picture("spinners", figure, "Paper copters and winged seed")


def add_rivals(page, numbers, runs):
    rivals = lambda scene, *models: runs(scene, *(f"{scene}-{model}" for model in models))
    page.add(RIVALS)
    page.add(table(("", *(f"`{model}`" for model in RIVAL_MODELS)), rival_rows(numbers, RIVAL_MODELS)))
    page.add(RIVALS_END)
    page.add_picture("rivals_soccer", draw_overlay(rivals("soccer_curl", *RIVAL_MODELS[1:])), "Free kick")
    page.add_picture("rivals_golf", draw_overlay(rivals("golf_dimpled_spin", *RIVAL_MODELS[1:])), "Golf ball")
    page.add_picture("rivals_plate", draw_overlay(rivals("plate_8cm", *RIVAL_MODELS[1:]), lowest=-6), "Plate of 8 cm")
    figure = draw_overlay(rivals("toy_propeller", *RIVAL_MODELS[1:]), until=0.7)
    page.add_picture("rivals_propeller", figure, "Toy propeller")


def read_study(out, name):
    """What another program has measured; None if it has not."""
    file = out / f"{name}.json"
    return json.loads(file.read_text()) if file.exists() else None


def add_study(page, text, head, rows):
    """Without rows the section stays as it is."""
    if rows is None:
        page.keep(text.splitlines()[0])
    else:
        page.add(text)
        page.add(table(head, rows))


def add_studies(page, out):
    convergence, cost = read_study(out, "convergence"), read_study(out, "cost")
    head = ("scene", "number", "as it is", "half the step", "half the mesh size", "tolerance")
    add_study(page, CONVERGENCE, head, convergence and convergence_rows(convergence))
    head = ("paper's name", "scene", "faces", "preparing, once", "substeps", "without a fluid", "step", "ratio")
    add_study(page, COST, head, cost and cost_rows(cost))


def write(out, docs):
    numbers = Numbers(out)
    runs = lambda *names: [Run(out / name) for name in names]
    page = Page(docs)
    page.add(HEAD)
    add_experiments(page, numbers, runs)
    add_rivals(page, numbers, runs)
    page.add("## Contacts and joints")
    page.add(table(("scene", "quantity", "this library"), contact_rows(numbers)))
    page.add(CONTACTS_END)
    add_studies(page, out)
    page.add(DIFFERENCES)
    page.write()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path, metavar="OUT")
    parser.add_argument("-o", "--docs", type=Path, required=True, metavar="DOCS")
    arguments = parser.parse_args()
    write(arguments.out, arguments.docs)
    print(f"\nTable: {(arguments.docs / 'experiments.md').resolve()}")


if __name__ == "__main__":
    main()
