"""The pictures of docs/reality.md."""

import math

import matplotlib.pyplot as plt
from reality_numbers import FLOOR, LAWS
from reality_tables import SINKING, terminal_speed

COLOURS = {"published": "tab:orange", "form": "tab:blue"}
MODES = {
    "steady": ("v", "0.6", "steady: falls flat, dives or glides"),
    "flutter": ("o", "tab:blue", "flutter"),
    "mixed": ("D", "tab:purple", "mixed (chaotic)"),
    "tumbling": ("s", "tab:red", "tumbling"),
}


def draw_coefficients(reality):
    figure, axes = plt.subplots(figsize=(7.5, 6.5))
    ends = (0.008, 3)
    axes.plot(ends, ends, color="k", linewidth=0.8)
    for share, style in ((1.25, "--"), (1.5, ":")):
        for slope in (share, 1 / share):
            axes.plot(ends, [slope * end for end in ends], style, color="0.5", linewidth=0.8)
    for law, marker in zip(LAWS, "ox"):
        points = [(case.value, case.counted(law)) for case in reality.cases]
        axes.loglog(*zip(*points), marker, color=COLOURS[law], markersize=5, alpha=0.8, label=f"{law} law")
    axes.axhline(FLOOR, color="0.7", linewidth=0.6)
    axes.text(0.05, FLOOR * 1.06, "no drag at all", fontsize=8, color="0.4")
    axes.set(xlim=(0.01, 3), ylim=(0.003, 3), xlabel="measured coefficient [1]", ylabel="this library's [1]")
    axes.set_title("Coefficients of drag, lift and normal force: within 1.25 (dashed), 1.5 (dotted)", fontsize=10)
    axes.grid(True, linewidth=0.3)
    axes.legend(loc="lower right")
    figure.tight_layout()
    return figure


def draw_plate(reality):
    figure, axes = plt.subplots(figsize=(9, 5.5))
    for law in LAWS:
        points = [(float(row["incidence"]), float(row[law])) for row in reality.curve]
        axes.plot(*zip(*points), color=COLOURS[law], linewidth=2, label=f"{law} law, square plate")
    markers = iter("osD^vPX*<")
    for (origin, size), cases in groups_of_plates(reality).items():
        points = [(case.row["flow"]["incidence"], case.value) for case in cases]
        aspect = "infinite" if size == 100 else f"{size:g}"
        axes.plot(*zip(*points), next(markers), markersize=6, label=f"{origin}, span/chord {aspect}")
    axes.set(xlabel="incidence [°]", ylabel="normal force coefficient [1]", xlim=(0, 91), ylim=(0, 2.3))
    axes.set_title("Thin plates: measured (marks) and by both laws", fontsize=10)
    axes.grid(True, linewidth=0.3)
    axes.legend(fontsize=8, ncol=2, loc="upper right")
    figure.tight_layout()
    return figure


def groups_of_plates(reality):
    names = {"E": "Eiffel 1911", "PM": "Pelletier & Mueller 2000", "FJ": "Fage & Johansen 1927"}
    groups = {}
    for case in reality.cases:
        if case.kind == "plates at incidence":
            groups.setdefault((names[case.row["source"]], case.row["shape"]["size"]), []).append(case)
    return groups


def draw_regimes(reality):
    figure, panels = plt.subplots(2, 3, figsize=(13, 5.8))
    columns = (
        ("disc", "Discs: I* (Field et al. 1997)"),
        ("spheroid", "10 : 1 spheroids: I*, the discs' regimes"),
        ("strip", "Strips: Froude number (Belmonte et al. 1998)"),
    )
    for row, law in zip(panels, LAWS):
        for axes, (family, title) in zip(row, columns):
            draw_regime_panel(axes, reality.chosen(family, law), family)
            right, runs = reality.regimes([family], law)
            axes.set_title(f"{title}\n{law} law: {right} of {runs} right", fontsize=9)
            axes.set_ylabel("released at [°]", fontsize=8)
    handles = [plt.Line2D([], [], linestyle="", marker=m, color=c, label=name) for m, c, name in MODES.values()]
    figure.tight_layout(rect=(0, 0.05, 1, 1))
    figure.legend(handles=handles, loc="lower center", ncol=4, fontsize=9)
    return figure


def draw_regime_panel(axes, falls, family):
    borders = (0.62, 0.72) if family == "strip" else (0.01, 0.1)
    middle = "0.9" if family == "strip" else "thistle"
    low, high = (0.27, 2.2) if family == "strip" else (0.0008, 0.7)
    edges, colours = (low, *borders, high), ("lightsteelblue", middle, "mistyrose")
    for begin, end, colour in zip(edges, edges[1:], colours):
        axes.axvspan(begin, end, color=colour, linewidth=0)
    for fall in falls:
        marker, colour, _ = MODES[fall.mode]
        edge = {"markeredgecolor": "k", "markeredgewidth": 0.4}
        axes.plot(fall.parameter, fall.tilt, marker, color=colour, markersize=7, **edge)
    axes.set(xscale="log", xlim=(low, high), ylim=(0, 95))
    if family == "strip":
        ticks = (0.3, 0.5, 0.7, 1, 2)
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()


def draw_plates(reality):
    names = ("1/14", "1/8", "1/5")
    figure, panels = plt.subplots(2, 3, figsize=(11, 8.2))
    for row, law in zip(panels, LAWS):
        for axes, name in zip(row, names):
            draw_path(axes, [row for row in reality.paths if row["law"] == law and row["name"] == name])
            measured = "flutters" if name == "1/14" else "tumbles"
            mode = reality.fall("plate", name, law).mode
            axes.set_title(f"h/l = {name}, {law} law: {mode}; measured: {measured}", fontsize=9)
        row[0].set_ylabel("[cm]", fontsize=8)
    title = "Aluminium plates, 0.81 mm thick, in water, released at 11.5°, every 20 ms (Andersen et al. 2005)"
    figure.suptitle(title, fontsize=10)
    figure.tight_layout()
    return figure


def draw_path(axes, rows, depth=30):
    """The chord at even intervals, as far as the picture reaches [cm]."""
    chord = 0.081 * int(rows[0]["name"].split("/")[1])
    points = [(100 * float(row["x"]), 100 * float(row["z"]), float(row["angle"])) for row in rows[::2]]
    points = [point for point in points if point[1] > -depth]
    points = [point for point in points if abs(point[0] - points[0][0]) < depth]
    for x, z, angle in points:
        dx, dz = chord / 2 * math.cos(angle), chord / 2 * math.sin(angle)
        axes.plot((x - dx, x + dx), (z - dz, z + dz), color=COLOURS[rows[0]["law"]], linewidth=1)
    middle = (min(point[0] for point in points) + max(point[0] for point in points)) / 2
    axes.set(xlim=(middle - 0.55 * depth, middle + 0.55 * depth), ylim=(-depth - 1, 2), aspect="equal")
    axes.tick_params(labelsize=7)
    axes.set_xlabel("[cm]", fontsize=8)


FREE_CUBE = 1.39 * (math.pi / 4) * (6 / math.pi) ** (2 / 3)  # on a side, Haider and Levenspiel's on the equal sphere
SIZES = (0.05, 0.1, 0.2, 0.4)
SPEED_PANELS = {
    "600": ("rise: 600 kg/m³ in water", 0.95, "ball, 0.95 (rising, Karamanev & Nikolov)"),
    "2500": ("fall: 2500 kg/m³ in water", None, "ball, Achenbach 1972"),
}


def draw_speeds(reality):
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.8), sharey=True)
    for axes, (density, (title, ball_drag, ball)) in zip(panels, SPEED_PANELS.items()):
        measured = (
            ("cube", 1.05, "cube, C_D 1.05 (face-on)", "-"),
            ("cube", FREE_CUBE, f"cube, {FREE_CUBE:.2f} (free, Haider & Levenspiel)", "--"),
            ("sphere", ball_drag, ball, ":"),
        )
        draw_measured_speeds(axes, float(density), measured)
        draw_own_speeds(axes, reality, density)
        axes.set_title(title, fontsize=10)
        axes.set_xlabel("edge or diameter [m]")
        axes.set_xticks(SIZES, [f"{size:g}" for size in SIZES])
        axes.grid(True, linewidth=0.3)
        axes.legend(fontsize=7.5, loc="upper left")
    panels[0].set(ylabel="final speed [m/s]", ylim=(0.3, 90))
    panels[0].set_yticks((0.5, 1, 2, 5, 10, 20), ("0.5", "1", "2", "5", "10", "20"))
    for axes in panels:
        axes.minorticks_off()
    figure.tight_layout()
    return figure


def draw_measured_speeds(axes, density, measured):
    for family, drag, name, style in measured:
        speeds = [terminal_speed(family, density, size, drag or SINKING[size]) for size in SIZES]
        axes.loglog(SIZES, speeds, style, color="k", linewidth=1, label=f"measured: {name}")


def draw_own_speeds(axes, reality, density):
    bodies = [(law, family, marker) for law in LAWS for family, marker in (("cube", "s"), ("sphere", "o"))]
    for law, family, marker in bodies:
        colour, name = COLOURS[law], f"{'ball' if family == 'sphere' else family}, {law} law"
        falls = [fall for fall in reality.chosen(family, law) if fall.name == density]
        points = [(fall.parameter, abs(fall.descent)) for fall in falls]
        axes.loglog(*zip(*points), marker, color=colour, label=name)


def draw_balls(reality):
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.4))
    names = {
        "BH": "golf ball, Bearman & Harvey 1976",
        "SHS": "baseball, Sawicki et al. 2003",
        "SS": "golf ball, Smits & Smith 1994",
        "PYFME": "smooth balls, Jothmann 2007",
    }
    for axes, of, label in zip(panels, ("lift", "drag"), ("lift coefficient [1]", "drag coefficient [1]")):
        cases = [case for case in reality.cases if case.kind == "balls" and case.row["flow"]["of"] == of]
        for (origin, name), colour in zip(names.items(), ("tab:blue", "tab:orange", "tab:green", "tab:red")):
            points = sorted((c.row["flow"]["spin"], c.value, c.model["form"]) for c in cases if c.row["source"] == origin)
            if not points:
                continue
            spins, measured, made = zip(*points)
            axes.plot(spins, measured, "o", markersize=5, color=colour, label=name)
            axes.plot(spins, made, "-x", linewidth=1.5, color=colour, label="form law, its roughness")
        axes.axline((0, 0), slope=4 / 3, color="0.6", linewidth=1, label="published law") if of == "lift" else None
        axes.set(xlabel="spin R w / V [1]", ylabel=label, xlim=(0, 0.62), ylim=(0, 0.55))
        axes.grid(True, linewidth=0.3)
        axes.legend(fontsize=8)
    figure.tight_layout()
    return figure


def draw_curves(curves):
    figure, panels = plt.subplots(2, 2, figsize=(12, 9))
    balls = [entry for entry in curves.sets if entry["shape"]["type"] == "ball" and entry["flow"]["of"] == "drag"]
    balls = [entry for entry in balls if "spin" not in entry["columns"]]
    rough = [entry for entry in balls if "roughness" in entry["flow"]]
    draw_drag(panels[0, 0], [entry for entry in balls if entry not in rough], "Smooth spheres")
    draw_drag(panels[0, 1], rough, "Rough spheres, balls without spin", True)
    draw_drag(panels[1, 0], [entry for entry in curves.sets if entry["shape"].get("size") == 100], "Long cylinders")
    axes = panels[1, 1]
    for kind in dict.fromkeys(entry["kind"] for entry in curves.sets if entry.get("settles")):
        points = [point for entry in curves.sets if entry["kind"] == kind for point in entry["made"]]
        axes.loglog(*zip(*((point.reynolds, point.ratio("form")) for point in points)), "o", markersize=3, label=kind)
    axes.axhline(1, color="k", linewidth=0.8)
    axes.set(xlabel="Reynolds number [1]", ylabel="terminal speed, form law over measured [1]", ylim=(0.6, 1.6))
    axes.set_yticks((0.6, 0.8, 1, 1.25, 1.6), ("0.6", "0.8", "1", "1.25", "1.6"))
    axes.minorticks_off()
    axes.set_title("Settling", fontsize=10)
    for axes in panels.flat:
        axes.grid(True, linewidth=0.3)
        axes.legend(fontsize=7)
    figure.tight_layout()
    return figure


def draw_drag(axes, sets, title, apart=False):
    """Marks: measured. The form law at these Reynolds numbers: a line for all smooth bodies, or crosses of each `apart`."""
    series = {}
    for entry in sets:
        key = entry["source"], entry["flow"].get("roughness", 0)
        points = [(point.reynolds, point.value, point.model["form"]) for point in entry["made"]]
        series[key] = sorted(series.get(key, []) + points)
    for marker, ((origin, rough), points) in zip("os^vD*Pp<>hd", series.items()):
        reynolds, measured, made = zip(*points)
        name = f"{origin}, k/D {rough:.2g}" if rough else origin
        (drawn,) = axes.loglog(reynolds, measured, marker, markersize=4, alpha=0.8, label=name)
        if apart or rough:
            axes.loglog(reynolds, made, "x:", color=drawn.get_color(), linewidth=0.8)
    smooth = sorted((reynolds, made) for (_, rough), points in series.items() if not rough for reynolds, _, made in points)
    if smooth and not apart:
        axes.loglog(*zip(*smooth), "-", color="k", linewidth=1.2)
    axes.set(xlabel="Reynolds number [1]", ylabel="drag coefficient [1]")
    axes.set_title(f"{title}: measured (marks), form law ({'crosses' if apart else 'line'})", fontsize=10)
