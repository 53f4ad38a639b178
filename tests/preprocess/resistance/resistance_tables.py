#!/usr/bin/python3
"""Fits the tables of known_viscous_flow.h to samples: resistance_tables.py SAMPLES SOURCE

SAMPLES is what resistance_samples prints; SOURCE, resistance_tables.cpp, is written. Largest residuals are printed.
"""

import sys

import numpy as np

RATIO, ELLIPSOID_RATIO = 100, 20  # kLargestRatio of table_places.h; kLargestEllipsoidRatio of resistance_tables.h
NAMES = ["wake_laminar", "wake_bubble", "wake_turbulent", "wake_rough", "thickness", "friction_laminar", "friction_bubble", "friction_turbulent"]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(400)


def read(file):
    samples = {}
    for line in open(file):
        words, numbers = line.split(":")
        kind, *sizes = words.split()
        samples.setdefault(kind, []).append((np.array(sizes, float), np.array(numbers.split(), float)))
    return samples


def ellipsoid_resistance(a):
    """The diagonal, rotation first; docs/theory.md eq. (95), with l = (t / (1 - t))^2 longest^2 as variable."""
    a = np.array(a, float)
    t = (NODES + 1) / 2
    l = a.max() ** 2 * (t / (1 - t)) ** 2
    step = WEIGHTS / 2 * a.max() ** 2 * 2 * t / (1 - t) ** 3
    delta = np.sqrt(np.prod(a[:, None] ** 2 + l, axis=0))
    alpha = a**2 * (step / ((a[:, None] ** 2 + l) * delta)).sum(1)
    k, m = [1, 2, 0], [2, 0, 1]
    rotation = 16 * np.pi / 3 * (a[k] ** 2 + a[m] ** 2) / (alpha[k] + alpha[m])
    return np.concatenate([rotation, 16 * np.pi / (alpha.sum() + alpha)])


def log_ratio(a, b, most):
    return np.log(a / b) / np.log(most)


def axis_place(sizes, k, most):
    """BoxAxis::place(), for sizes up to `most` : 1."""
    a, b, c = sizes[k], sizes[(k + 1) % 3], sizes[(k + 2) % 3]
    return log_ratio(a * a, b * c, most) / 2, 2 * log_ratio(max(b, c), min(b, c), most) ** 2 - 1


def fit(rows, columns, places, values, damping=1e-4):
    """Coefficients of the terms T_i(x) T_j(y) with i/rows + j/columns < 1 and the largest residual."""
    x, y = np.clip(np.array(places).T, -1, 1)
    terms = [(i, j) for i in range(rows) for j in range(columns) if i / rows + j / columns < 1]
    basis = np.stack([np.cos(i * np.arccos(x)) * np.cos(j * np.arccos(y)) for i, j in terms], 1)
    above = np.vstack([basis, damping * np.eye(len(terms))])
    solution = np.linalg.lstsq(above, np.concatenate([values, np.zeros(len(terms))]), rcond=None)[0]
    coefficients = np.zeros((rows, columns))
    coefficients[tuple(np.array(terms).T)] = solution
    return coefficients, np.abs(basis @ solution - values).max()


def array_text(name, numbers):
    lines = [" ".join(f"{n:.5g}," for n in numbers[i : i + 10]) for i in range(0, len(numbers), 10)]
    return f"constexpr double {name}[] = {{\n    " + "\n    ".join(lines) + "};\n"


def series(name, rows, columns, places, values):
    coefficients, residual = fit(rows, columns, places, np.array(values))
    print(f"{name}: {rows} x {columns}, largest residual {residual:.1e}")
    return array_text(name, coefficients.ravel()), f"{{{rows}, {columns}, {name}}}"


def box_ellipsoid(half):
    """Semi-axes of a ball have three times the mean squares of its surface: so for a box."""
    ends = np.array([half[1] * half[2], half[2] * half[0], half[0] * half[1]])
    return half * np.sqrt((2 * ends / ends.sum()) + 1)


def cylinder_ellipsoid(radius, height):
    side, ends = height / (height + radius), radius / (height + radius)
    across = radius * np.sqrt(3 * (side / 2 + ends / 4))
    return [across, across, height * np.sqrt(3 * (side / 12 + ends / 4))]


def round_ellipsoid(kind, radius, height):
    """That of the cylinder's mean squares; of others that in the same box."""
    if kind == "cylinder":
        return cylinder_ellipsoid(radius, height)
    return [radius, radius, height / 2 + (radius if kind == "capsule" else 0)]


def round_series(kind, samples):
    """Over the ellipsoid; the coupling over its v_x and the height."""
    places, rows = [], []
    for (radius, height), (v_z, v_x, w_z, w_y, coupling) in samples:
        R = ellipsoid_resistance(round_ellipsoid(kind, radius, height))
        capsule = 2 * np.log1p(height / (2 * radius)) / np.log1p(RATIO) - 1
        places.append((capsule if kind == "capsule" else log_ratio(height, 2 * radius, RATIO), 0))
        rows.append([v_z / R[5], v_x / R[3], w_z / R[2], w_y / R[0], coupling / (R[3] * height) if height else 0])
    names = ["v_z", "v_x", "w_z", "w_y"] + (["coupling"] if kind == "cone" else [])
    return [series(f"{kind}_{name}", {"cylinder": 9, "capsule": 6, "cone": 8}[kind], 1, places, np.array(rows)[:, k]) for k, name in enumerate(names)]


def box_series(samples):
    places, rotation, translation = [], [], []
    for half, values in samples:
        over = values / ellipsoid_resistance(box_ellipsoid(half))
        for k in range(3):
            places.append(axis_place(half, k, RATIO))
            rotation.append(over[k])
            translation.append(over[3 + k])
    return [series("box_rotation", 10, 6, places, rotation), series("box_translation", 10, 5, places, translation)]


def layer_series(samples):
    """Roots of k, which is what the law takes; logarithms of the others."""
    places = [axis_place(half, k, ELLIPSOID_RATIO) for half, _ in samples for k in range(3)]
    values = np.array([numbers[8 * k : 8 * k + 8] for _, numbers in samples for k in range(3)])
    values = np.hstack([np.cbrt(values[:, :4]), np.log(values[:, 4:])])
    return [series(f"ellipsoid_{name}", 10, 5, places, values[:, k]) for k, name in enumerate(NAMES)]


def table(kind, type_, made):
    arrays, members = zip(*made)
    members = ", ".join(members + ("{}",) * (type_ == "RoundResistance" and len(members) == 4))
    if type_ == "LayerTable":
        members = "{" + members + "}"
    return (
        "\nnamespace {\n\n" + "".join(arrays) + f"\n}}  // namespace\n\nconst {type_}& {kind}() {{\n"
        f"  static constexpr {type_} kTable = {{{members}}};\n  return kTable;\n}}\n"
    )


def main(samples_file, source):
    samples = read(samples_file)
    text = "// Generated by resistance_tables.py from resistance_samples.txt beside it.\n\n"
    text += '#include "preprocess/resistance/resistance_tables.h"\n\n// clang-format off\nnamespace ambient {\n'
    text += table("boxResistance", "BoxResistance", box_series(samples["box"]))
    for kind in ("cylinder", "capsule", "cone"):
        text += table(f"{kind}Resistance", "RoundResistance", round_series(kind, samples[kind]))
    text += table("ellipsoidLayers", "LayerTable", layer_series(samples["ellipsoid"]))
    heights = [sizes[1] / (2 * sizes[0]) for sizes, _ in samples["layers"]]
    steps = np.array([numbers for _, numbers in samples["layers"]])
    text += f"\nconst std::array<CapsuleLayers, {len(heights)}>& capsuleLayers() {{\n"
    text += f"  static constexpr std::array<CapsuleLayers, {len(heights)}> kTable = {{{{\n"
    for height, numbers in zip(heights, steps):
        ways = ["{" + ", ".join(f"{n:.5g}" for n in half) + "}" for half in (numbers[:8], numbers[8:])]
        text += f"    {{{height:.6g}, {', '.join(ways)}}},\n"
    text += "  }};\n  return kTable;\n}\n"
    with open(source, "w") as out:
        out.write(text + "\n}  // namespace ambient\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
