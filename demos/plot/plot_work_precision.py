#!/usr/bin/python3
"""Error against processor time: plot_work_precision.py -o PICTURE.png TABLE.csv

One panel per case, one line per method over the steps of the world. Motions that broke down are left out.
"""

from error_curves import ErrorCurves

# Line, marker and colour per method; a family has one colour.
STYLES = {
    "fast": ("--", "v", "tab:blue"),
    "leapfrog 1e-2": (":", "o", "tab:blue"),
    "leapfrog 1e-3": ("-", "o", "tab:blue"),
    "leapfrog 1e-4": ("-.", "o", "tab:blue"),
    "pair 1e-3": (":", "s", "tab:green"),
    "pair 1e-5": ("-", "s", "tab:green"),
    "pair 1e-7": ("-.", "s", "tab:green"),
    "rk4": ("-", "D", "tab:red"),
    "symplectic euler": ("-", "x", "tab:orange"),
}


if __name__ == "__main__":
    curves = ErrorCurves(STYLES, "microseconds_per_second", "position_error")
    curves.run(__doc__, "a table of work_precision", 5, "processor time [µs per simulated s]", "largest position error [m]")
