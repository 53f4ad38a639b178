#!/usr/bin/python3
"""Error of the added mass against processor time: plot_added_mass_cost.py -o PICTURE.png TABLE.csv

One panel per body, one line per method over the faces of the mesh.
"""

from error_curves import ErrorCurves

# Line, marker and colour per method; a family has one colour.
STYLES = {
    "build": ("-", "o", "tab:blue"),
    "build, 1000 panels": ("--", "v", "tab:blue"),
    "panels alone": (":", "s", "tab:green"),
    "point sources": ("-", "x", "tab:orange"),
    "point sources, exact flux": ("-", "D", "tab:red"),
}


if __name__ == "__main__":
    # Off by more than 10 is off.
    curves = ErrorCurves(STYLES, "processor_seconds", "error", largest_error=10)
    curves.run(__doc__, "a table of potential_flow_study", 3, "processor time [s]",
               "error over the largest entry of the block")
