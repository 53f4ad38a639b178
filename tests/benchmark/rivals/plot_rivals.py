#!/usr/bin/python3
"""Writes the picture and the tables of docs/rivals.md that rivals_cost makes: plot_rivals.py RESULTS.json -o DOCS"""

import argparse
import json
import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
sys.path.append(str(Path(__file__).resolve().parents[3] / "demos/plot"))

import matplotlib.pyplot as plt
from experiment_tables import table
from files import reading, writing

PICTURE = "images/rivals_cost.png"
BEGIN, END = "<!-- begin: plot_rivals.py -->", "<!-- end: plot_rivals.py -->"
FLOOR = 0.01  # smaller errors are drawn here [%]
CHEAPEST = 0.005  # smaller costs, which are noise, are drawn here [us]
STYLES = {"bullet_ambient": ("o", "tab:blue"), "forces by hand": ("s", "tab:gray"), "Jolt": ("^", "tab:orange"),
          "MuJoCo": ("D", "tab:green")}
OFFSETS = {"forces by hand": (-14, -19), "Jolt": (-16, 10)}  # of the numbers [points]
NOTES = {("rising cube", "forces by hand"): "typed in"}
TITLES = {"light ball": "light ball let go:\nacceleration", "barge in heave": "barge:\nperiod of heave",
          "rising cube": "rising cube:\nspeed", "ellipsoid in ideal flow": "ellipsoid in ideal flow:\nenergy over 20 s"}


def error_of(row, engine):
    """Relative error in per cent; None if the engine has no such number."""
    number, reference = row["numbers"].get(engine), row["reference"]
    if number is None:
        return None
    return 100 * (abs(number / reference - 1) if reference else number)


def percent(error):
    return "< 0.01 %" if error < 0.01 else f"{error:.3g} %" if error >= 100 else f"{error:.2g} %"


def draw_panel(axes, row):
    missing = []
    for engine, (marker, colour) in STYLES.items():
        if engine not in row["numbers"]:
            continue
        error, cost = error_of(row, engine), row["costs"][engine]
        if error is None or cost is None:
            missing.append(engine)
            continue
        place = max(cost["fluid"], CHEAPEST), max(error, FLOOR)
        axes.plot(*place, marker, color=colour, markersize=11, markeredgecolor="white", label=engine)
        note = NOTES.get((row["case"], engine), percent(error))
        # By hand and Jolt are often neighbours of others.
        offset = OFFSETS.get(engine, (9, 5)) if error > 1 else (9, 5)
        axes.annotate(note, place, offset, textcoords="offset points", fontsize=10, color=colour)
    if missing:
        axes.text(0.5, 0.03, f"{', '.join(missing)}: none", transform=axes.transAxes, ha="center", fontsize=10)
    axes.set(xscale="log", yscale="log", xlim=(0.002, 40), ylim=(0.006, 3000), title=TITLES[row["case"]])
    axes.title.set_fontsize(11)
    axes.minorticks_off()
    axes.grid(alpha=0.3)


def draw(results):
    """Error of each number over the cost of the same body."""
    rows = results["accuracy"]
    figure, panels = plt.subplots(1, len(rows), figsize=(11, 4.2), sharex=True, sharey=True)
    for axes, row in zip(panels, rows):
        draw_panel(axes, row)
        axes.set_xticks([0.01, 0.1, 1, 10], ["0.01", "0.1", "1", "10"])
    ticks = [0.01, 0.1, 1, 10, 100, 1000]
    panels[0].set_yticks(ticks, ["≤ 0.01 %", *(f"{tick:g} %" for tick in ticks[1:])])
    panels[0].set_ylabel("error", fontsize=11)
    figure.supxlabel("what the fluid costs [µs per body and step]: the better, the further left and down", fontsize=11, y=0.1)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=len(labels), frameon=False, fontsize=11)
    figure.tight_layout(rect=(0, 0.1, 1, 1))
    return figure


def cost_cell(cost):
    return f"{cost['fluid']:.2g} µs, {cost['ratio']:.2f}×" if cost else "none"


def cost_rows(results, engines):
    rows = [(f"{row['case']} ({row['bodies']})", row["engines"]) for row in results["cost"]]
    return [(name, *(cost_cell(costs[engine]) for engine in engines)) for name, costs in rows]


def number_cell(row, engine):
    number = row["numbers"][engine]
    if number is None:
        return "none"
    cost = row["costs"][engine]
    error = f"{number:.4g}, off by {percent(error_of(row, engine))}" if row["reference"] else percent(error_of(row, engine))
    return f"{error}; {cost['fluid']:.2g} µs"


def accuracy_rows(results, engines):
    rows = []
    for row in results["accuracy"]:
        unit = "" if row["unit"] == "1" else f" {row['unit'].replace('^2', '²')}"
        reference = f"{row['reference']:.4g}{unit}, {row['source']}" if row["reference"] else row["source"]
        rows.append((TITLES[row["case"]].replace("\n", " "), reference, *(number_cell(row, engine) for engine in engines)))
    return rows


def section_of(results):
    """What stands between the marks of the page."""
    engines = [engine["name"] for engine in results["engines"]]
    versions = "; ".join(f"{e['name']}: {e['version']}, {e['settings']}" for e in results["engines"])
    made = f"Made on {results['date']}, {results['processor']}, one core, {results['compiler']}. {versions}."
    left_out = "".join(f" {line}." for line in results["missing"])
    parts = [f"![Error over the cost of the fluid, four motions]({PICTURE})", made + left_out,
             table(("error; cost", "right", *engines), accuracy_rows(results, engines)).strip(),
             table(("cost", *engines), cost_rows(results, engines)).strip()]
    return "\n\n".join(parts)


def write(results, docs):
    figure, page = draw(results), docs / "rivals.md"
    with writing(docs / PICTURE):
        figure.savefig(docs / PICTURE, dpi=80)
    text, marks = page.read_text(encoding="utf-8"), re.compile(f"({BEGIN}\n).*?({END})", re.DOTALL)
    if not marks.search(text):
        sys.exit(f"{page}: has no part between '{BEGIN}' and '{END}'")
    with writing(page):
        page.write_text(marks.sub(lambda found: f"{found[1]}\n{section_of(results)}\n\n{found[2]}", text), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", type=Path, metavar="RESULTS.json")
    parser.add_argument("-o", "--docs", type=Path, required=True, metavar="DOCS")
    arguments = parser.parse_args()
    with reading(arguments.results, "a file of results of rivals_cost"):
        results = json.loads(arguments.results.read_text(encoding="utf-8"))
        if results["quick"]:
            sys.exit(f"{arguments.results}: was made with --quick, its times mean nothing")
    with reading(arguments.docs / "rivals.md", "the page of rivals"):
        write(results, arguments.docs)


if __name__ == "__main__":
    main()
