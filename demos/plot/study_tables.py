"""The rows of the tables of docs/experiments.md that come from measure_cost.py and convergence.py."""

# Padilla 2025, table of computation times: name, faces, preprocessing [ms], substeps, without fluid, step [ms], ratio.
PAPER_COSTS = {
    "plate_10cm": ("plate", 896, 532.1, 1, 0.51, 2.58, 5.07),
    "soccer_curl": ("soccer", 500, 92.86, 17, 5.85, 30.22, 5.16),
    "basketball_drop": ("basket", 500, 93.5, 24, 8.47, 42.97, 5.07),
    "golf_smooth": ("golf", 500, 96.03, 1, 0.59, 2.05, 3.49),
    "golf_dimpled_spin": ("golf spin", 500, 93.01, 44, 15.9, 79.07, 4.97),
    "football": ("football", 780, 352.02, 21, 7.89, 47.98, 6.08),
    "underwater_bunny": ("bunny", 932, 588.98, 1, 0.56, 2.73, 4.91),
    "toy_propeller": ("toy", 1048, 1150, 50, 17.19, 129.75, 7.55),
    "balloon": ("balloon", 500, 111.4, 1, 0.56, 2.02, 3.59),
    "paper_copter": ("paper", 2690, 5080, 1, 0.59, 5.44, 9.25),
}


def cost_rows(costs):
    """The paper's value, then this library's."""
    rows = []
    for scene, (name, faces, preparation, substeps, empty, step, ratio) in PAPER_COSTS.items():
        cost = costs[scene]
        rows.append(
            (
                name,
                f"`{scene}`",
                f"{faces}; {cost['faces']}",
                f"{preparation / 1e3:.2f} s; {cost['preparation']:.2f} s",
                f"{substeps}; {cost['substeps']:.1f}",
                f"{empty:.2f} ms; {cost['step_without_fluid'] * 1e6:.1f} µs",
                f"{step:.1f} ms; {cost['step'] * 1e6:.1f} µs",
                f"{ratio:.1f}; {cost['step'] / cost['step_without_fluid']:.1f}",
            )
        )
    return rows


def change(row, kind):
    value, whole = row[kind], row["as_it_is"]
    share = abs(value - whole) / abs(whole)
    tolerance = row["tolerance"]
    missed = not isinstance(tolerance, str) and share > tolerance
    return f"{100 * (value - whole) / abs(whole):+.2f} %" + (" (**above**)" if missed else "")


def convergence_rows(entries):
    rows = []
    for row in entries:
        whole = f"{row['as_it_is']:.3g}" if abs(row["as_it_is"]) < 100 else f"{row['as_it_is']:.1f}"
        tolerance = row["tolerance"] if isinstance(row["tolerance"], str) else f"{100 * row['tolerance']:g} %"
        name = row["name"]
        if "modes" in row:
            modes = row["modes"]
            name += f"; {modes[0]}" + ("" if len(set(modes)) == 1 else f", then {modes[1]}, {modes[2]}")
        unit = row["unit"] if row["unit"] == "°" else " " + row["unit"]
        rows.append(
            (f"`{row['scene']}`", name, whole + unit, change(row, "half_step"), change(row, "half_mesh"), tolerance)
        )
    return rows
