"""Measurements beside the results of the program `reality`."""

import csv
import json
import math

LAWS = ("published", "form")
FLOOR = 0.02  # what a coefficient of zero counts as in ratios, where more was measured


def read_rows(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def kind_of(row):
    """The class of bodies that a coefficient belongs to."""
    shape, of = row["shape"]["type"], row["flow"]["of"]
    size = row["shape"].get("size", 1)
    if shape == "ball":
        return "balls"
    if of == "normal" or shape == "delta":
        return "plates at incidence"
    if shape.endswith("rod") or shape == "half pipe" or (shape == "plate" and size > 10):
        return "long plates and rods"
    if shape == "cylinder":
        return "cylinders end-on" if row["flow"]["velocity"][2] else "cylinders across"
    if shape == "cone":
        return "cones"
    if shape in ("hemisphere", "cup", "spheroid", "shuttlecock"):
        return "half balls, cups and spheroids"
    return "streamlined" if shape == "drop" else "cubes, polyhedra, plates and discs broadside"


class Case:
    """One measured coefficient and what the laws make of it."""

    def __init__(self, row, model):
        self.row, self.value = row, row["value"]
        self.model = {law: float(model[law]) for law in LAWS}
        self.kind = kind_of(row)

    def counted(self, law):
        return max(self.model[law], FLOOR) if self.value > FLOOR else self.model[law]

    def error(self, law):
        return math.log(self.counted(law) / self.value)


class Point:
    """One point of a set of curves.json. A settling body's error is that of its terminal speed."""

    def __init__(self, row, settles, floor):
        self.floor = floor  # of measured and made coefficients; 0: of their ratio, FLOOR
        self.reynolds, self.value = float(row["reynolds"]), float(row["value"])
        self.model = {law: float(row[law]) for law in LAWS}
        self.speed = {law: float(row[f"speed {law}"]) for law in LAWS} if settles else None

    def ratio(self, law):
        if self.speed:
            return self.speed[law]
        return max(max(self.model[law], self.floor) / max(self.value, self.floor), FLOOR)

    def error(self, law):
        return math.log(self.ratio(law))


class Curves:
    """Sets of measured coefficients over the Reynolds number, with what the laws make of them."""

    def __init__(self, file, results):
        data = json.loads(file.read_text(encoding="utf-8"))
        self.sources, self.sets = data["sources"], data["sets"]
        self.rows = {entry["id"]: entry for entry in self.sets}
        for entry in self.sets:
            settles, floor = entry.get("settles", False), FLOOR if entry["flow"]["of"] == "lift" else 0
            entry["made"] = [Point(row, settles, floor) for row in results if row["id"] == entry["id"]]

    def kinds(self):
        """Kind, whether it was seen or is from memory, its points, and how many no number was fitted on."""
        made = {}
        for entry in self.sets:
            kind = made.setdefault((entry["kind"], entry["verified"]), ([], []))
            kind[0].extend(entry["made"])
            kind[1].extend(entry["made"] if entry["fitted"] == "held" else [])
        return made

    def points(self, kind, verified=True, held=False):
        return self.kinds()[kind, verified][held]


def is_sea(measurements):
    """Whether a file of measurements is that of motions at sea, which names scenes."""
    return "scenes" in json.loads(measurements.read_text(encoding="utf-8"))


class SeaCase:
    """One measured number of a motion and what the library makes of it."""

    def __init__(self, row, model):
        self.row, self.kind, self.value, self.model = row, row["group"], row["value"], float(model)

    def ratio(self):
        return self.model / self.value

    def error(self, law="form"):
        return math.log(self.ratio())


class Sea:
    """Measured motions at sea with what the library makes of them: runs all of them."""

    def __init__(self, measurements):
        from sea_runs import SeaRuns

        runs = SeaRuns(measurements)
        self.sources, self.series, self.rows = runs.data["sources"], runs.data["series"], runs.rows
        self.cases = [SeaCase(row, runs.compute(row)) for row in runs.rows.values()]
        self.curves = list(runs.curves())

    def of_kind(self, kind):
        return [case for case in self.cases if case.kind == kind]

    def kinds(self):
        return list(dict.fromkeys(case.kind for case in self.cases))


def rms(cases, law):
    return math.sqrt(sum(case.error(law) ** 2 for case in cases) / len(cases))


def within(cases, law, factor):
    return sum(abs(case.error(law)) <= math.log(factor) for case in cases)


class Fall:
    def __init__(self, row):
        self.family, self.name, self.law, self.mode = (row[key] for key in ("family", "name", "law", "mode"))
        self.parameter, self.tilt, self.descent, self.drift, self.spin, self.reach, self.miss, self.substeps, self.coarse = (
            float(row[key]) for key in ("parameter", "tilt", "descent", "drift", "spin", "reach", "miss", "substeps", "coarse")
        )

    def expected(self):
        """The regime that was measured; None where nothing was, or within the error of a border."""
        if self.family in ("disc", "spheroid"):
            return "flutter" if self.parameter < 0.01 else "tumbling" if self.parameter >= 0.1 else "mixed"
        if self.family == "strip":
            return "flutter" if self.parameter < 0.62 else "tumbling" if self.parameter > 0.72 else None
        if self.family == "plate":
            return "flutter" if self.name == "1/14" else "tumbling"
        return "tumbling" if self.family in ("card", "long card") else None


class Reality:
    """All that `reality` wrote, with the measurements."""

    def __init__(self, measurements, out):
        data = json.loads(measurements.read_text(encoding="utf-8"))
        self.sources = data["sources"]
        self.curves = Curves(measurements.parent / "curves.json", read_rows(out / "curves.csv"))
        self.rows = {row["id"]: row for row in data["rows"]}
        models = {row["id"]: row for row in read_rows(out / "coefficients.csv")}
        cases = [Case(self.rows[name], model) for name, model in models.items()]
        self.stall = [case for case in cases if case.row["group"] == "stall"]
        cases = [case for case in cases if case.row["group"] != "stall"]
        self.drawn = [case for case in cases if case.row["fitted"] == "drawn"]
        self.cases = [case for case in cases if case.row["verified"] and case not in self.drawn]
        self.from_memory = [case for case in cases if not case.row["verified"]]
        self.falls = [Fall(row) for row in read_rows(out / "falls.csv")]
        self.curve = read_rows(out / "plate.csv")
        self.paths = read_rows(out / "paths.csv")

    def unfitted(self):
        return [case for case in self.cases if case.row["fitted"] != "fit"]

    def unseen(self):
        """Neither fitted on nor in view when the form of the law was chosen."""
        return [case for case in self.cases if case.row["fitted"] in ("none", "fresh")]

    def motions(self, fitted):
        """Row and, by each law, what its releases give: numbers, or names of regimes."""
        made = []
        for row in self.rows.values():
            if "motion" not in row or row["fitted"] != fitted:
                continue
            family, name, what = (row["motion"][key] for key in ("family", "name", "what"))
            falls = {law: [fall for fall in self.chosen(family, law) if fall.name == name] for law in LAWS}
            made.append((row, {law: [getattr(fall, what) for fall in falls[law]] for law in LAWS}))
        return made

    def chosen(self, family, law):
        return [fall for fall in self.falls if fall.family == family and fall.law == law]

    def regimes(self, families, law):
        """Right ones, all."""
        falls = [fall for family in families for fall in self.chosen(family, law) if fall.expected()]
        return sum(fall.mode == fall.expected() for fall in falls), len(falls)

    def fall(self, family, name, law, parameter=None):
        """The first release of a body."""
        falls = [fall for fall in self.chosen(family, law) if fall.name == name]
        return next(fall for fall in falls if parameter is None or fall.parameter == parameter)
