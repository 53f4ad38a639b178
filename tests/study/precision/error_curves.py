"""Error over cost: one panel per case, one line per method."""

import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt

sys.path.append(str(Path(__file__).resolve().parents[3] / "demos/plot"))

from files import read_table
from picture import draw_picture


class ErrorCurves:
    """`styles` has line, marker and colour per method; `cost` and `error` are columns of the table."""

    def __init__(self, styles, cost, error, largest_error=math.inf):
        self.styles, self.cost, self.error, self.largest_error = styles, cost, error, largest_error

    def draw_case(self, axes, runs, case):
        for method, (line, marker, colour) in self.styles.items():
            chosen = [run for run in runs if run["case"] == case and run["method"] == method]
            points = [(float(run[self.cost]), float(run[self.error])) for run in chosen]
            points = [(cost, error) for cost, error in points if math.isfinite(error) and error > 0]
            if points:
                axes.loglog(*zip(*points), line, marker=marker, color=colour, markersize=5, linewidth=1.3, label=method)
        axes.set_ylim(top=min(axes.get_ylim()[1], self.largest_error))
        axes.set_title(case.replace("_", " "), fontsize=12)
        axes.grid(True, which="major", linewidth=0.3)
        axes.tick_params(labelsize=10)

    def draw(self, runs, columns, cost_label, error_label):
        cases = list(dict.fromkeys(run["case"] for run in runs))
        rows = math.ceil(len(cases) / columns)
        figure, panels = plt.subplots(rows, columns, figsize=(12.5, 3.4 * rows + 0.8), squeeze=False)
        for axes, case in zip(panels.flat, cases):
            self.draw_case(axes, runs, case)
        for axes in panels.flat[len(cases):]:
            axes.axis("off")
        for row in panels:
            row[0].set_ylabel(error_label, fontsize=11)
        for axes in panels[-1]:
            axes.set_xlabel(cost_label, fontsize=11)
        legends = (axes.get_legend_handles_labels() for axes in panels.flat)
        handles, labels = max(legends, key=lambda pair: len(pair[1]))
        figure.tight_layout(rect=(0, 0, 1, 1 - 0.8 / figure.get_figheight()))
        figure.legend(handles, labels, loc="upper center", ncol=5, fontsize=11)
        return figure

    def run(self, description, kind, columns, cost_label, error_label):
        """The whole program: a table in, a picture out."""

        def draw(table):
            runs = read_table(table, kind, ("case", "method", self.cost, self.error))
            return self.draw(runs, columns, cost_label, error_label)

        draw_picture(description, draw, 80, metavar="TABLE.csv")
