#!/usr/bin/python3
"""What plot_polar.py draws of a table of ambient_preprocess polar."""

import runpy
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

PLOTS = Path(__file__).resolve().parents[3] / "demos/plot"
sys.path.append(str(PLOTS))

import plot_polar

COLUMNS = [*plot_polar.ANGLES, *plot_polar.LABELS]


def coefficients(attack, side_slip):
    """Numbers that tell their angles and column; side forces that are rounding."""
    row = {key: 100 * column + attack + side_slip / 10 for column, key in enumerate(plot_polar.LABELS)}
    return {"attack": attack, "side_slip": side_slip, **row, "C_Y": 1e-9 * attack}


def table(attacks, side_slips):
    return [coefficients(attack, side_slip) for side_slip in side_slips for attack in attacks]


def drawn(rows):
    """Panels by what they show."""
    figure = plot_polar.plt.figure()
    plot_polar.draw(figure, rows, "attack", "side_slip")
    plot_polar.plt.close(figure)
    panels = {axes.get_title(): axes for axes in figure.axes}
    return {"polar": panels["drag polar"], **{key: panels[title] for key, title in plot_polar.LABELS.items()}}


class PolarTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, rows):
        file = self.folder / "polar.csv"
        lines = [",".join(COLUMNS), *(",".join(str(row[key]) for key in COLUMNS) for row in rows)]
        file.write_text("\n".join(lines) + "\n")
        return file

    def run_script(self, *arguments):
        with mock.patch.object(sys, "argv", ["plot_polar.py", *map(str, arguments)]):
            runpy.run_path(str(PLOTS / "plot_polar.py"), run_name="__main__")

    def test_numbers_of_the_table_are_the_lines(self):
        # Rows in disorder: lines run along the angle all the same.
        panels = drawn(table([10, -10, 0], [0, 20]))
        for key in plot_polar.LABELS:
            lines = panels[key].get_lines()
            self.assertEqual(len(lines), 2)
            for line, side_slip in zip(lines, [0, 20]):
                self.assertEqual(list(line.get_xdata()), [-10, 0, 10])
                self.assertEqual(list(line.get_ydata()), [coefficients(a, side_slip)[key] for a in [-10, 0, 10]])
        polar = panels["polar"].get_lines()[1]
        self.assertEqual(list(polar.get_xdata()), [coefficients(a, 20)["C_D"] for a in [-10, 0, 10]])
        self.assertEqual(list(polar.get_ydata()), [coefficients(a, 20)["C_L"] for a in [-10, 0, 10]])
        self.assertEqual(polar.get_label(), "β = 20°")

    def test_coefficients_that_are_rounding_look_like_nothing(self):
        panels = drawn(table([-10, 10], [0]))
        largest = coefficients(10, 0)["C_n"]
        self.assertEqual(panels["C_Y"].get_ylim(), (-0.1 * largest, 0.1 * largest))

    def test_too_many_lines_are_thinned_evenly(self):
        lines = drawn(table([0, 10], range(0, 50, 2)))["polar"].get_lines()
        self.assertLessEqual(len(lines), plot_polar.MOST_LINES)
        self.assertEqual([line.get_label() for line in lines], [f"β = {angle}°" for angle in range(0, 50, 6)])

    def test_the_angle_with_more_values_is_the_axis(self):
        for attacks, side_slips, axis in (([0, 5, 10], [0, 5], "attack"), ([0, 5], [0, 5, 10], "side_slip")):
            picture = self.folder / "polar.png"
            with mock.patch.object(plot_polar.plt.Axes, "set_xlabel", autospec=True) as labels:
                self.run_script(self.write(table(attacks, side_slips)), "-o", picture)
            self.assertIn(plot_polar.ANGLES[axis], [call.args[1] for call in labels.call_args_list])
            self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))

    def test_drag_over_reynolds_numbers_is_drawn_beside_a_balls(self):
        file = self.folder / "drag.csv"
        file.write_text("Re,C_D,C_D_of_ball\n0.1,300,240\n1e6,0.2,0.1\n")
        axes = plot_polar.draw_table(file).axes[0]
        self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "log"))
        self.assertEqual([list(line.get_xdata()) for line in axes.get_lines()], [[0.1, 1e6]] * 2)
        self.assertEqual([list(line.get_ydata()) for line in axes.get_lines()], [[300, 0.2], [240, 0.1]])
        self.assertEqual([line.get_label() for line in axes.get_lines()], ["body", "smooth ball"])
        self.run_script(file, "-o", self.folder / "drag.svg")
        self.assertIn("<svg", (self.folder / "drag.svg").read_text())

    def test_cells_that_are_no_numbers_are_refused(self):
        rows = table([0, 10], [0])
        rows[1]["C_D"] = "much"
        file = self.write(rows)
        with self.assertRaises(SystemExit) as end:
            self.run_script(file, "-o", self.folder / "polar.png")
        self.assertEqual(end.exception.code, f"{file}: is not a table of ambient_preprocess polar")
        self.assertFalse((self.folder / "polar.png").exists())
        file.write_text("Re,C_D\n1,24\n")  # without the ball
        with self.assertRaises(SystemExit) as end:
            self.run_script(file, "-o", self.folder / "polar.png")
        self.assertEqual(end.exception.code, f"{file}: is not a table of ambient_preprocess polar")


if __name__ == "__main__":
    unittest.main()
