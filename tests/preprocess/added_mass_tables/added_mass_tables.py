#!/usr/bin/python3
"""Added mass of boxes, cylinders, capsules and cones: solves samples, fits tables to them, writes table_data.cpp.

added_mass_tables.py make SAMPLES SOURCE [SECONDS]   solve what SAMPLES lacks, for so long; when all is there, write SOURCE
added_mass_tables.py check SAMPLES [EVERY [KIND]]    solve every so-many-th (20) sample anew, print how far they are off

Boxes are solved by panels of the Python module on two graded meshes and extrapolated; round bodies by Green's identity on
their meridian, docs/theory.md eq. (75), to 1e-5. Exit code 1 if a sample is off by more than 1e-4.
"""

import os
import sys
import time

import numpy as np

import bullet_ambient as ba

RATIO, ROUNDING = 100, 0.9  # the largest of table_places.h
POINTS = 12  # Gauss points of a panel
LEAST_PANEL = 1 / 512  # size of the last panel of a piece over the shortest piece
LEAST_PART = 1e-6  # smallest part of a panel; below it rounding of normal distances dominates
os.environ["BULLET_AMBIENT_CACHE"] = "off"
X, W = np.polynomial.legendre.leggauss(POINTS)
FROM_POINTS = np.linalg.inv(np.polynomial.legendre.legvander(X, POINTS - 1))  # values to coefficients
X, W = (X + 1) / 2, W / 2


def nodes(count):
    """Chebyshev nodes from -1 to 1, denser towards both ends."""
    return -np.cos(np.pi * np.arange(count) / (count - 1))


def table_shapes():
    """The shapes that the tables are fitted to: kind; half sizes, or radius, height (of the straight part), rounding [m]."""
    for ring in range(17):
        longest = RATIO ** np.sin(np.pi / 2 * ring / 16)
        count = (ring + 1) // 2 + 1
        for share in [0] if count == 1 else (1 + nodes(count)) / 2:
            yield "box", (longest, longest**share, 1)
    for i, x in enumerate(nodes(25)):
        yield "cylinder", (1, 2 * RATIO**x, 0)
        if i > 0:  # the first capsule is a ball, without rotational added mass
            yield "capsule", (1, 2 * np.expm1((1 + x) / 2 * np.log1p(RATIO)), 0)
    for x in nodes(21):
        height = 2 * RATIO**x
        for y in nodes(9):
            share = ROUNDING * ((1 + y) / 2) ** 2
            yield "cone", (1, height, height / (1 + height) * share / (1 - share))


def text_of(kind, sizes):
    return kind + "".join(f" {size:.9g}" for size in sizes)


# Boxes.


def box_mesh(half, divisions):
    """Vertices and triangles of a box, with cosine spacing along its edges."""
    vertices, faces = [], []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (-1, 1):
            a = -half[u] * np.cos(np.pi * np.arange(divisions[u] + 1) / divisions[u])
            b = -half[v] * np.cos(np.pi * np.arange(divisions[v] + 1) / divisions[v])
            points = np.empty((len(a), len(b), 3))
            points[..., u], points[..., v], points[..., axis] = a[:, None], b[None], side * half[axis]
            first = sum(len(x) for x in vertices)
            vertices.append(points.reshape(-1, 3))
            i, j = np.meshgrid(range(len(a) - 1), range(len(b) - 1), indexing="ij")
            p = first + i * len(b) + j
            p, q, r, s = (x.ravel() for x in (p, p + len(b), p + len(b) + 1, p + 1))
            # Diagonals run towards the corners, so that none is cut off.
            cut = ((2 * i < len(a) - 1) == (2 * j < len(b) - 1)).ravel()[:, None]
            one = np.where(cut, np.stack([p, q, r], 1), np.stack([p, q, s], 1))
            other = np.where(cut, np.stack([p, r, s], 1), np.stack([q, r, s], 1))
            both = np.vstack([one, other])
            faces.append(both if side > 0 else both[:, ::-1])
    vertices, where = np.unique(np.vstack(vertices).round(12), axis=0, return_inverse=True)
    return vertices, where.ravel()[np.vstack(faces)]


def solve_box(half, most=11000, coarse=3, fine=5):
    """Diagonal of the added mass about the centre. Order: twice that of the grading times the exponent 2/3 of an edge."""
    half, least, longest = np.array(half, float), np.array([2, 2, 2]), 2
    while True:
        n = np.maximum(2, 2 * np.round(longest * np.sqrt(half / half.max()) / 2).astype(int))
        if 4 * fine**2 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]) > most:
            break
        least, longest = n, longest + 2
    solved = [
        np.diag(ba.FluidBody.from_mesh(*box_mesh(half, k * least), origin=(0, 0, 0), panels=0).added_mass)
        for k in (coarse, fine)
    ]
    return solved[1] + (solved[1] - solved[0]) / ((fine / coarse) ** (8 / 3) - 1)


# Bodies of revolution. A piece of a meridian has begin, end and, of an arc that bulges into the fluid, a centre; pieces run
# from the top of the body to its bottom.


def meridian(kind, radius, height, rounding):
    top, bottom, up, down = (radius, height / 2), (radius, -height / 2), (0, height / 2), (0, -height / 2)
    if kind == "cylinder":
        pieces = [(up, top), (top, bottom), (bottom, down)]
    elif kind == "capsule":
        pieces = [((0, height / 2 + radius), top, up), (top, bottom), (bottom, (0, -height / 2 - radius), down)]
    elif rounding == 0:
        pieces = [(up, bottom), (bottom, down)]
    else:
        out = rounding * np.array([height, radius]) / np.hypot(height, radius)
        low = np.array([0, -rounding])
        pieces = [(np.array(up) - low, up + out, up), (up + out, bottom + out), (bottom + out, bottom + low, bottom)]
        pieces.append((bottom + low, down + low))
    return [[np.array(point, float) for point in piece] for piece in pieces]


def angle_of(piece):
    (a, b), (c, d) = piece[0] - piece[2], piece[1] - piece[2]
    return np.arctan2(b * c - a * d, a * c + b * d)


def length_of(piece):
    if len(piece) == 3:
        return angle_of(piece) * np.linalg.norm(piece[0] - piece[2])
    return np.linalg.norm(piece[1] - piece[0])


def points_at(piece, fractions):
    """Points and unit normals into the fluid."""
    if len(piece) == 2:
        along = (piece[1] - piece[0]) / length_of(piece)
        points = piece[0] + fractions[..., None] * (piece[1] - piece[0])
        return points, np.broadcast_to([-along[1], along[0]], points.shape)
    arm, angles = piece[0] - piece[2], fractions * angle_of(piece)
    c, s = np.cos(angles), np.sin(angles)
    turned = np.stack([c * arm[0] + s * arm[1], c * arm[1] - s * arm[0]], -1)
    return piece[2] + turned, turned / np.linalg.norm(arm)


def panels_of(pieces):
    """Pieces with the ends of a panel in parts of the piece, halved towards both ends of the piece."""
    shortest = min(map(length_of, pieces))
    for piece in pieces:
        ends = [0.5]
        while ends[-1] * length_of(piece) > LEAST_PANEL * shortest:
            ends.append(ends[-1] / 2)
        edges = np.array([0, *ends[::-1], *(1 - np.array(ends[1:])), 1])
        for begin, end in zip(edges[:-1], edges[1:]):
            yield piece, begin, end


def elliptic_integrals(complementary):
    """K and E by the arithmetic-geometric mean from the complementary modulus: good for the closest ring, too."""
    a, g, power = np.ones_like(complementary), complementary, 0.5
    total = power * (1 - g) * (1 + g)
    while np.any(a - g > 1e-9 * a):
        c, (a, g), power = (a - g) / 2, ((a + g) / 2, np.sqrt(a * g)), 2 * power
        total = total + power * c**2
    K = np.pi / (a + g)
    return K, K * (1 - total)


def ring_kernels(target, source, normal):
    """Potentials of rings of sources and dipoles, for motions along (m = 0) and across the axis (m = 1): (4, ...)."""
    (x, z), (r, h), (nr, nz) = (np.moveaxis(v, -1, 0) for v in (target, source, normal))
    rise = h - z
    far, near = np.hypot(r + x, rise), np.hypot(r - x, rise)
    K, E = elliptic_integrals(near / far)
    twice, squares = 2 * r * x, r**2 + x**2 + rise**2
    first_0 = 4 * K / far
    first_1 = (squares * first_0 - 4 * far * E) / twice
    third_0 = 4 * E / (far * near**2)
    third_1 = (squares * third_0 - first_0) / twice
    third_11 = (squares * third_1 - first_1) / twice
    along, across = nr * r + nz * rise, nr * x
    dipoles = along * third_0 - across * third_1, along * third_1 - across * third_11
    return np.stack([first_0, first_1, -dipoles[0], -dipoles[1]]) / (4 * np.pi)


def lagrange(x):
    """Values at x of the polynomials that are 1 at one Gauss point and 0 at the others: (..., POINTS)."""
    return np.polynomial.legendre.legvander(2 * x - 1, POINTS - 1) @ FROM_POINTS


def panel_integrals(targets, panel):
    """Integrals over a panel of kernels times polynomials: (4, targets, POINTS). Parts near a target are halved."""
    piece, begin, end = panel
    result = np.zeros((4, len(targets), POINTS))
    which, low, high = np.arange(len(targets)), np.zeros(len(targets)), np.ones(len(targets))
    while len(which):
        at = np.stack([low, (low + high) / 2, high], 1)
        ends = points_at(piece, begin + at * (end - begin))[0]
        distance = np.linalg.norm(ends - targets[which][:, None], axis=-1).min(1)
        length = np.linalg.norm(np.diff(ends, axis=1), axis=-1).sum(1)
        near = (distance < 1.2 * length) & (high - low > LEAST_PART)
        w, a, b = which[~near], low[~near], high[~near]
        x = a[:, None] + X * (b - a)[:, None]
        points, normals = points_at(piece, begin + x * (end - begin))
        weights = W * ((b - a) * length_of(piece) * (end - begin))[:, None] * points[..., 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            kernels = weights * ring_kernels(targets[w][:, None], points, normals)
        kernels[:, (points == targets[w][:, None]).all(-1)] = 0
        np.add.at(result, (slice(None), w), (kernels[:, :, None] @ lagrange(x))[:, :, 0])
        middle = (low + high)[near] / 2
        which = np.tile(which[near], 2)
        low, high = np.concatenate([low[near], middle]), np.concatenate([middle, high[near]])
    return result


def solve_pieces(pieces):
    """v_z, v_x, w_y and the coupling [w_y, v_x] about the origin."""
    panels = list(panels_of(pieces))
    nodes_of = [points_at(piece, begin + X * (end - begin)) for piece, begin, end in panels]
    points, normals = (np.concatenate([node[k] for node in nodes_of]) for k in (0, 1))
    weights = np.concatenate([W * length_of(piece) * (end - begin) for piece, begin, end in panels])
    source_0, source_1, dipole_0, dipole_1 = np.concatenate([panel_integrals(points, panel) for panel in panels], 2)
    rings = np.pi * weights * points[:, 0]
    across = np.stack([normals[:, 0], normals[:, 0] * points[:, 1] - normals[:, 1] * points[:, 0]], 1)
    heave = np.linalg.solve(np.eye(len(points)) / 2 - dipole_0, -source_0 @ normals[:, 1])
    swing = np.linalg.solve(np.eye(len(points)) / 2 - dipole_1, -source_1 @ across)
    K = -swing.T @ (rings[:, None] * across)
    return np.array([-2 * heave @ (rings * normals[:, 1]), K[0, 0], K[1, 1], (K[0, 1] + K[1, 0]) / 2])


def solve(kind, sizes):
    return solve_box(sizes) if kind == "box" else solve_pieces(meridian(kind, *sizes))


# The fit. Scales and places are those of known_added_mass.cpp.


def log_ratio(a, b):
    return np.log(a / b) / np.log(RATIO)


def box_points(half, K):
    """Places, and values of rotation and translation, of the three axes."""
    for k in range(3):
        a, b, c = half[k], half[(k + 1) % 3], half[(k + 2) % 3]
        across, total = log_ratio(max(b, c), min(b, c)), b + c
        place = log_ratio(a * a, b * c) / 2, 2 * across**2 - 1
        yield place, (K[k] * (a + 0.2 * total) / (a * a * total**4), np.log(K[3 + k] * total / (b * c) ** 2))


def round_point(kind, sizes, K):
    """Place and values of v_z, v_x, w_y, coupling."""
    radius, height, rounding = sizes
    r, h, oblong, place = radius, height, 1, (log_ratio(height, 2 * radius), 0)
    if kind == "capsule":
        spheroid = {"type": "ellipsoid", "semi_axes": [radius, radius, radius + height / 2], "faces": 1300}
        k = np.diag(ba.FluidBody.from_shape(spheroid).added_mass)
        place = 2 * np.log1p(height / (2 * radius)) / np.log1p(RATIO) - 1, 0
        return place, (np.log(K[0] / k[5]), np.log(K[1] / k[3]), K[2] / k[0], 0)
    if kind == "cone":
        share = rounding / (rounding + radius * height / (radius + height))
        place = place[0], 2 * np.sqrt(share / ROUNDING) - 1
        r, h, oblong = radius + rounding, height + 2 * rounding, (radius + height) / (radius + height + rounding)
    total = r + h
    scales = r**3, (r * h) ** 2 / total, r * r * total**3 * oblong**2, r * r * h * total
    return place, (np.log(K[0] / scales[0]), np.log(K[1] / scales[1]), K[2] / scales[2], K[3] / scales[3])


def fit(rows, columns, corner, places, values, damping=3e-5):
    """Coefficients of the terms T_i(x) T_j(y) with i/rows + j/columns below `corner`, by damped least squares.

    Corners of the square that no box reaches have no samples; an undamped series may grow there.
    """
    x, y = np.clip(np.array(places).T, -1, 1)
    terms = [(i, j) for i in range(rows) for j in range(columns) if i / rows + j / columns < corner]
    basis = np.stack([np.cos(i * np.arccos(x)) * np.cos(j * np.arccos(y)) for i, j in terms], 1)
    assert len(values) >= len(terms)
    above = np.vstack([basis, damping * np.eye(len(terms))])
    solution = np.linalg.lstsq(above, np.concatenate([values, np.zeros(len(terms))]), rcond=None)[0]
    coefficients = np.zeros((rows, columns))
    coefficients[tuple(np.array(terms).T)] = solution
    return coefficients, np.abs(basis @ solution - values).max()


def tables(samples):
    """(kind, name, coefficients, largest residual) of every series."""
    points = {kind: [] for kind in ("box", "cylinder", "capsule", "cone")}
    for kind, sizes in table_shapes():
        K = samples[text_of(kind, sizes)]
        points[kind] += box_points(sizes, K) if kind == "box" else [round_point(kind, sizes, K)]
    orders = {"box": [(21, 11, 1), (17, 9, 1)], "cone": 4 * [(19, 9, 1.4)]}
    names = {"box": ("rotation", "translation"), "cone": ("v_z", "v_x", "w_y", "coupling")}
    for kind, made in points.items():
        places, values = zip(*made)
        for k, name in enumerate(names.get(kind, names["cone"][:3])):
            order = orders.get(kind, 4 * [(21, 1, 2)])[k]
            yield (kind, name, *fit(*order, places, np.array(values)[:, k]))


def source_of(origin, series):
    text = f"// Generated by added_mass_tables.py make, from samples by {origin}.\n\n"
    text += '#include "preprocess/added_mass_tables/table_places.h"\n\n// clang-format off\nnamespace ambient {\n'
    for kind in dict.fromkeys(kind for kind, *_ in series):
        own = [(name, coefficients) for k, name, coefficients, _ in series if k == kind]
        text += "\nnamespace {\n\n"
        for name, coefficients in own:
            numbers = [f"{c:.7f}," for c in coefficients.ravel()]
            lines = [" ".join(numbers[i : i + 8]) for i in range(0, len(numbers), 8)]
            text += f"constexpr double {kind}_{name}[] = {{\n    " + "\n    ".join(lines) + "};\n"
        members = [f"{{{c.shape[0]}, {c.shape[1]}, {kind}_{name}}}" for name, c in own] + ["{}"] * (len(own) == 3)
        type_ = "BoxTable" if kind == "box" else "RoundTable"
        text += f"\n}}  // namespace\n\nconst {type_}& {kind}Table() {{\n"
        text += f"  static constexpr {type_} kTable = {{{', '.join(members)}}};\n  return kTable;\n}}\n"
    return text + "\n}  // namespace ambient\n"


def read(file):
    """Solver that made a file of samples, and its samples by text."""
    lines = open(file).read().splitlines() if os.path.exists(file) else []
    named = dict(line.split(": ") for line in lines if ": " in line)
    origin = lines[0].split(" by ")[1] if lines else f"bullet_ambient {ba.library_version}"
    return origin, {key: np.array(value.split(), float) for key, value in named.items()}


def make(file, source, seconds=1e9):
    origin, samples = read(file)
    start, left = time.monotonic(), 0
    with open(file, "a") as out:
        if not samples:
            out.write(f"# Added mass of simple shapes by {origin}\n")
        for kind, sizes in table_shapes():
            if text_of(kind, sizes) in samples:
                continue
            if time.monotonic() - start > float(seconds):
                left += 1
                continue
            samples[text_of(kind, sizes)] = K = solve(kind, sizes)
            out.write(text_of(kind, sizes) + ":" + "".join(f" {k:.9g}" for k in K) + "\n")
            out.flush()
    if left:
        return print(f"{left} shapes are left: run it again")
    series = list(tables(samples))
    for kind, name, coefficients, residual in series:
        print(f"{kind} {name}: {' x '.join(map(str, coefficients.shape))}, largest residual {residual:.1e}")
    with open(source, "w") as out:
        out.write(source_of(origin, series))


def check(file, every=20, kind=None):
    samples, worst = read(file)[1], 0
    chosen = [shape for shape in table_shapes() if kind in (None, shape[0])]
    for shape in chosen[:: int(every)]:
        K, known = solve(*shape), samples[text_of(*shape)]
        scales = np.abs(known) if shape[0] == "box" else np.array([*known[:3], np.sqrt(known[1] * known[2])])
        off = np.abs(K - known) / scales
        print(f"{text_of(*shape)}: {off.max():.1e}")
        worst = max(worst, off.max())
    return int(worst > 1e-4)


if __name__ == "__main__":
    words = sys.argv[1:]
    if words[:1] not in (["make"], ["check"]) or not 2 <= len(words) <= 4:
        sys.exit(__doc__)
    sys.exit(make(*words[1:]) if words[0] == "make" else check(*words[1:]))
