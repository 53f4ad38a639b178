"""What the scripts that draw share: their command line, and the file of the picture."""

import argparse

import matplotlib

matplotlib.use("Agg")

from files import writing


def draw_picture(description, draw, dpi, **source):
    """The whole program: SOURCE -o PICTURE. `draw` makes a figure of the source; returns the picture's name."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", **source)
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE")
    arguments = parser.parse_args()
    figure = draw(arguments.source)
    with writing(arguments.output):
        figure.savefig(arguments.output, dpi=dpi)
    return arguments.output
