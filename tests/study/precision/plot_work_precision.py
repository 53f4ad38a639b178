#!/usr/bin/python3
"""Error against processor time: plot_work_precision.py -o PICTURE.png TABLE.csv

One panel per case, one line per method over the steps of the world. Motions that broke down are left out.
"""

from error_curves import ErrorCurves

# Line, marker and colour per method; a family has shades of one colour, the darker the finer its tolerance.
STYLES = {
    "fast": ("--", "v", "black"),
    "leapfrog 1e-2": (":", "o", "#74b3e8"),
    "leapfrog 1e-3": ("-", "^", "#1f77b4"),
    "leapfrog 1e-4": ("-.", "P", "#0b3558"),
    "pair 1e-3": (":", "s", "#8fd18f"),
    "pair 1e-5": ("-", "X", "#2ca02c"),
    "pair 1e-7": ("-.", "*", "#0e4f14"),
    "rk4": ("-", "D", "tab:red"),
    "symplectic euler": ("-", "x", "tab:orange"),
}


if __name__ == "__main__":
    curves = ErrorCurves(STYLES, "microseconds_per_second", "position_error")
    curves.run(__doc__, "a table of work_precision", 3, "processor time [µs per simulated s]", "largest position error [m]")
