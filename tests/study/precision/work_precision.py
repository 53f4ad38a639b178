#!/usr/bin/python3
"""Error of motions against processor time, for every integrator and step, as CSV: work_precision.py [--out TABLE.csv] [CASE ...]

Needs the Python module: PYTHONPATH=build/release/python.
"""

import argparse
import csv
import sys
import tempfile
import time

import numpy as np
from bullet_ambient import Scene, World

SAMPLE = 1 / 30  # from one compared place to the next [s]
COLUMNS = ("case", "method", "time_step", "position_error", "angle_error", "microseconds_per_second",
           "evaluations_per_second", "coarse")

# A wooden cube of 20 cm and 600 kg/m^3, slightly tilted.
CUBE = {"bodies.0.shape": {"type": "box", "size": [0.2, 0.2, 0.2]}, "bodies.0.mass": 4.8,
        "bodies.0.orientation": [0.98873657, 0.12, 0.08, 0.04]}
# Drag stops a plate of 0.2 g from 300 m/s within a few of its lengths.
FEATHER = {"bodies.0.linear_velocity": [300, 0, 0], "bodies.0.angular_velocity": [5, 9, 2]}
# Scene, duration [s], short enough that chaos does not hide the error, and what is changed.
CASES = {
    "plate_8cm": ("plate_8cm", 1, {}),
    "plate_10cm": ("plate_10cm", 1, {}),
    "golf": ("golf_dimpled_spin", 3, {}),
    "football": ("football", 2, {}),
    "ellipsoid": ("underwater_ellipsoid", 2, {}),
    "balloon": ("balloon", 1, {}),
    "stiff_feather": ("plate_8cm", 1, FEATHER),
    "flap": ("flap_in_current", 1, {}),
    "chain": ("chain_in_water", 1, {}),
    "pile": ("box_pile", 0.5, {}),
    "plate_8cm_form": ("plate_8cm", 1, {"law": "form"}),
    "card": ("tumbling_card", 1, {"law": "published"}),
    "card_form": ("tumbling_card", 1, {}),
    "cube": ("sphere_rise", 1, {"law": "published", **CUBE}),
    "cube_form": ("sphere_rise", 1, {"law": "form", **CUBE}),
}
# Method, tolerance, largest number of substeps, precision of the loads.
METHODS = {
    "fast": ("leapfrog", 1e-3, 1, "single"),
    "leapfrog 1e-2": ("leapfrog", 1e-2, 0, "single"),
    "leapfrog 1e-3": ("leapfrog", 1e-3, 0, "single"),
    "leapfrog 1e-4": ("leapfrog", 1e-4, 256, "single"),
    "pair 1e-3": ("dormand_prince", 1e-3, 0, "single"),
    "pair 1e-5": ("dormand_prince", 1e-5, 0, "double"),
    "pair 1e-7": ("dormand_prince", 1e-7, 0, "double"),
    "rk4": ("rk4", 1e-3, 0, "single"),
    "symplectic euler": ("symplectic_euler", 1e-3, 0, "single"),
}
REFERENCE = ("dormand_prince", 1e-9, 0, "double")


class Run:
    """The motion by one method, at all multiples of SAMPLE, and the least cost of `takes` runs."""

    def __init__(self, scene, method, rate, cache, takes=1):
        name, tolerance, most, precision = method
        changes = {"time_step": 1 / rate, "integrator": {"method": name, "tolerance": tolerance, "max_substeps": most}}
        changes.update({f"bodies.{i}.load_precision": precision for i in range(len(scene.bodies))})
        self.seconds, self.motion = np.inf, None
        for _ in range(takes):
            with World(scene.replace(changes), cache=cache) as world:
                begin = time.process_time()
                try:
                    self.motion = world.run(scene.duration, SAMPLE)
                except ArithmeticError:  # a state is not finite
                    self.motion = None
                self.seconds = min(self.seconds, time.process_time() - begin)
                work = [body.work for body in world.bodies.values()]
        self.evaluations, self.coarse = (sum(of[key] for of in work) for key in ("load_evaluations", "coarse"))

    def error(self, reference):
        """Largest distance [m] and angle [rad] over all samples and bodies."""
        if self.motion is None:
            return np.inf, np.inf
        position = np.linalg.norm(self.motion.position - reference.motion.position, axis=-1).max()
        a, b = self.motion.orientation, reference.motion.orientation
        chord = np.minimum(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
        return position, 4 * np.arcsin(chord / 2).max()


def rows(case, takes, cache):
    name, duration, changes = CASES[case]
    scene = Scene(name, {"duration": duration, **changes})
    # Contacts have errors of first order in the world's step, with any integrator of flight.
    reference = Run(scene, REFERENCE, 7680, cache)
    if reference.motion is None:
        sys.exit(f"work_precision.py: {case}: the reference is not finite")
    for rate in (30, 60, 120, 240, 480, 960):
        for method, settings in METHODS.items():
            run = Run(scene, settings, rate, cache, takes)
            numbers = (1 / rate, *run.error(reference), 1e6 * run.seconds / duration, run.evaluations / duration, run.coarse)
            yield (case, method, *(f"{number:.5g}" for number in numbers))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", nargs="*", choices=[[], *CASES], metavar="CASE", help="which (default: all)")
    parser.add_argument("--takes", type=int, default=3, help="runs of which the fastest counts (default: 3)")
    parser.add_argument("--out", type=argparse.FileType("w"), default=sys.stdout, help="file of the table")
    arguments = parser.parse_args()
    table = csv.writer(arguments.out, lineterminator="\n")
    table.writerow(COLUMNS)
    with tempfile.TemporaryDirectory() as cache:
        for case in arguments.case or CASES:
            table.writerows(rows(case, arguments.takes, cache))


if __name__ == "__main__":
    main()
