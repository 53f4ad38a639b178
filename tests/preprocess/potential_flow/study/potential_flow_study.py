#!/usr/bin/python3
"""Accuracy, order of convergence and speed of the added mass, as Markdown tables: potential_flow_study.py PREPROCESS

JSON shapes are built by the program ambient_preprocess without tables, meshes by the Python module. Errors are over the
largest entry of the block, of the coupling over the root of the product of the two largest, see docs/accuracy.md.
"""

import argparse
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

import bullet_ambient as ba
import point_sources

PREPROCESS = None
WANTED = {"smooth": 0.005, "sharp": 0.01, "sheet": 0.002}
GOLDEN = (1 + 5**0.5) / 2

# Meshes: vertices and triangles.


def weld(parts):
    """One mesh of parts with equal vertices made one."""
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
    faces = np.vstack([triangles + start for (_, triangles), start in zip(parts, starts)])
    vertices = np.vstack([vertices for vertices, _ in parts])
    _, first, number = np.unique(vertices.round(9) + 0.0, axis=0, return_index=True, return_inverse=True)
    return vertices[first], number.ravel()[faces]


def lattice(n):
    """Nodes (i, j) of a triangle divided n by n, and its triangles."""
    number = {node: k for k, node in enumerate((i, j) for i in range(n + 1) for j in range(n + 1 - i))}
    up = [[(i, j), (i + 1, j), (i, j + 1)] for i, j in number if i + j < n]
    down = [[(i + 1, j), (i + 1, j + 1), (i, j + 1)] for i, j in number if i + j < n - 1]
    return np.array(list(number)), np.array([[number[node] for node in face] for face in up + down])


def divided(mesh, n, graded=False):
    """Each triangle in n^2, graded quadratically towards its edges or not."""
    nodes, faces = lattice(n)
    weights = np.column_stack([n - nodes.sum(1), nodes]) / n
    if graded:
        weights = 1 - np.cos(np.pi * weights)
        weights /= weights.sum(1)[:, None]
    return weld([(weights @ mesh[0][face], faces) for face in mesh[1]])


def simplicial(vertices):
    """A convex solid of equilateral triangles, seen from outside, by its corners."""
    vertices, faces = np.array(vertices, float), []
    distance = np.linalg.norm(vertices[:, None] - vertices[None], axis=-1)
    near = np.isclose(distance, distance[distance > 0].min())
    for a, b, c in np.argwhere(near[:, :, None] & near[None] & near[:, None]):
        if a < b and a < c and np.linalg.det(vertices[[a, b, c]]) > 0:
            faces.append((a, b, c))
    return vertices, np.array(faces)


def icosahedron():
    corners = [(0, a, b * GOLDEN) for a in (-1, 1) for b in (-1, 1)]
    mesh = simplicial([np.roll(corner, k) for corner in corners for k in range(3)])
    return mesh[0] / np.linalg.norm(mesh[0][0]), mesh[1]


def dodecahedron(centred):
    """Pentagons of three triangles, or of five about their centre."""
    dual, faces = icosahedron()
    corners, triangles = dual[faces].sum(1), []
    corners /= np.linalg.norm(corners, axis=1)[:, None]
    for v, axis in enumerate(dual):
        around = np.argwhere((faces == v).any(1)).ravel()
        x = np.cross(axis, corners[around[0]])
        x /= np.linalg.norm(x)
        angles = np.arctan2(corners[around] @ np.cross(axis, x), corners[around] @ x)
        around = around[np.argsort(angles)]
        if centred:
            corners = np.vstack([corners, corners[around].mean(0)])
            triangles += [(len(corners) - 1, around[k], around[(k + 1) % 5]) for k in range(5)]
        else:
            triangles += [(around[0], around[k], around[k + 1]) for k in (1, 2, 3)]
    return corners, np.array(triangles)


def cap(n, position, inwards=False):
    """Six sectors of rings 0 to n: position(ring / n, azimuth)."""
    nodes, faces = lattice(n)
    ring = nodes.sum(1)
    parts = []
    for sector in range(6):
        azimuth = np.pi / 3 * (sector + nodes[:, 1] / np.maximum(ring, 1)) * (ring > 0)
        parts.append((position(ring / n, azimuth), faces[:, ::-1] if inwards else faces))
    return weld(parts)


def dome(radius, n, up, graded=False, inwards=False):
    """Half a sphere, z > 0 or z < 0."""

    def position(fraction, azimuth):
        polar = np.pi / 2 * (np.sin(np.pi / 2 * fraction) if graded else fraction)
        across, height = np.sin(polar), np.where(fraction == 1, 0, np.cos(polar))
        return radius * np.column_stack([across * np.cos(azimuth), across * np.sin(azimuth), up * height])

    return cap(n, position, inwards != (up < 0))


def hemisphere(n):
    round_side = dome(1, n, 1)
    flat = cap(n, lambda f, a: np.column_stack([np.cos(a), np.sin(a), 0 * a]) * np.sin(np.pi / 2 * f)[:, None], True)
    return weld([round_side, flat])


def bowl(thickness, n, rows, graded):
    """Half a spherical shell, z < 0, outer radius 1, with a flat rim."""
    share = np.arange(rows + 1) / rows
    radii = 1 - thickness * ((1 - np.cos(np.pi * share)) / 2 if graded else share)
    ring = np.array([(np.cos(a), np.sin(a), 0) for a in np.pi / 3 / n * np.arange(6 * n)])
    rim, k = [], np.arange(6 * n)
    for row in range(rows):
        a, b = k + 6 * n * row, (k + 1) % (6 * n) + 6 * n * row
        c, d = b + 6 * n, a + 6 * n
        first = (k % n < (n + 1) // 2)[:, None]
        rim.append(np.where(first, np.column_stack([a, b, c]), np.column_stack([a, b, d])))
        rim.append(np.where(first, np.column_stack([a, c, d]), np.column_stack([b, c, d])))
    rim = np.vstack([radius * ring for radius in radii]), np.vstack(rim)
    mesh = weld([dome(1, n, -1, graded), dome(radii[-1], n, -1, graded, inwards=True), rim])
    return to_volume(mesh, 2 * np.pi / 3 * (1 - (1 - thickness) ** 3))


def torus(n):
    u, v = (np.pi * 2 / n * x.ravel() for x in np.meshgrid(range(n), range(n), indexing="ij"))
    r = 2 + np.cos(v)
    i, j = (x.ravel() for x in np.meshgrid(range(n), range(n), indexing="ij"))
    at = lambda i, j: i % n * n + j % n
    a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    faces = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return to_volume((np.column_stack([r * np.cos(u), r * np.sin(u), np.sin(v)]), faces), 4 * np.pi**2)


def cylinder(faces):
    """Radius 1, height 2; caps and wall are graded towards the rims."""
    n = round((faces / 28) ** 0.5)
    disc = lambda z: lambda f, a: np.column_stack([np.cos(a), np.sin(a), 0 * a]) * np.sin(np.pi / 2 * f)[:, None] + [0, 0, z]
    rows, around = np.cos(np.pi * np.arange(n + 1) / (n)), np.pi / 3 / n * np.arange(6 * n)
    wall = np.array([(np.cos(a), np.sin(a), z) for z in rows for a in around])
    i, k = (x.ravel() for x in np.meshgrid(range(len(rows) - 1), range(6 * n), indexing="ij"))
    a, b = 6 * n * i + k, 6 * n * i + (k + 1) % (6 * n)
    faces = np.vstack([np.column_stack([a, a + 6 * n, b]), np.column_stack([b, a + 6 * n, b + 6 * n])])
    return to_volume(weld([cap(n, disc(1)), cap(n, disc(-1), True), (wall, faces)]), 2 * np.pi)


def volume_of(mesh):
    a, b, c = np.moveaxis(mesh[0][mesh[1]], 1, 0)
    return np.einsum("ti,ti->", a, np.cross(b, c)) / 6


def to_volume(mesh, volume):
    return mesh[0] * (volume / volume_of(mesh)) ** (1 / 3), mesh[1]


def ellipsoid(semi_axes, faces, twist=0):
    vertices, triangles = divided(icosahedron(), int((faces / 20) ** 0.5))
    vertices = vertices / np.linalg.norm(vertices, axis=1)[:, None] * semi_axes
    c, s = np.cos(twist * vertices[:, 2]), np.sin(twist * vertices[:, 2])
    x, y, z = vertices.T
    return to_volume((np.column_stack([c * x - s * y, s * x + c * y, z]), triangles), 4 * np.pi / 3 * np.prod(semi_axes))


# References: matrices about the origin, rotation first; from tests/reference.


def ellipsoid_added_mass(semi_axes):
    """Lamb, Hydrodynamics, art. 114 and 115; Carlson's integral by duplication."""
    q, volume, shape = np.square(semi_axes, dtype=float), 4 * np.pi / 3 * np.prod(semi_axes), np.zeros(3)
    for k in range(3):
        (x, y, z), total, factor = (q[k - 2], q[k - 1], q[k]), 0, 1
        for _ in range(30):
            step = np.sqrt(x * y) + np.sqrt(x * z) + np.sqrt(y * z)
            total, factor = total + factor / (np.sqrt(z) * (z + step)), factor / 4
            x, y, z = (x + step) / 4, (y + step) / 4, (z + step) / 4
        shape[k] = np.prod(semi_axes) * 2 / 3 * (3 * total + factor / z**1.5)
    K = np.zeros(6)
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        d = q[i] - q[j]
        below = 2 * d + (q[i] + q[j]) * (shape[i] - shape[j])
        K[k] = 0 if d == 0 else volume / 5 * d * d * (shape[j] - shape[i]) / below
        K[k + 3] = volume * shape[k] / (2 - shape[k])
    return np.diag(K)


def round_added_mass(v_z, v_x, w_y, coupling=0):
    K = np.diag([w_y, w_y, 0, v_x, v_x, v_z])
    K[1, 3] = K[3, 1] = coupling
    K[0, 4] = K[4, 0] = -coupling
    return K


def twisted_added_mass():
    w, v, both = [0.1958336, 0.1518064, 0.2966526], [1.103731, 2.667684, 1.50394], [0.1830658, 0.142929, -0.3216112]
    return np.block([[np.diag(w), np.diag(both)], [np.diag(both), np.diag(v)]])


HEMISPHERE = round_added_mass(
    1.2151482353124803 * 2 * np.pi / 3, 0.368533971412441 * 2 * np.pi / 3, 0.2314263542669546, 0.09588537248611967
)
CYLINDER = round_added_mass(0.5853635661072294 * 2 * np.pi, 0.579293987998501 * 2 * np.pi, 0.8098845194495637)
COIN = round_added_mass(4.864633361069023 * 0.2 * np.pi, 0.14245202593087108 * 0.2 * np.pi, 0.4092714516339417)
CAPSULE = round_added_mass(0.2331602152339004 * 10 / 3 * np.pi, 0.6964793056840268 * 10 / 3 * np.pi, 2.9488477137036364)
TORUS = round_added_mass(1.0639074506992998 * 4 * np.pi**2, 0.3996840651707634 * 4 * np.pi**2, 60.06474834455299)
CUBE = np.diag(3 * [1.2563629570258183] + 3 * [8 * 0.638415712936517])
SHEETS = {  # w_x, w_y, v_z
    "disc": ({"semi_axes": [1, 1]}, 16 / 45, 16 / 45, 8 / 3),
    "elliptic disc 2 : 1": ({"semi_axes": [2, 1]}, 0.7952296188000137, 4.391314229675565, 6.917582852374852),
    "rectangular sheet 1 : 1": ({"size": [1, 1]}, 0.02006632645189589, 0.020066324715834742, 0.45475441745843426),
    "rectangular sheet 2 : 1": ({"size": [2, 1]}, 0.044566633979973964, 0.2590180648712568, 1.1888968942746714),
    "rectangular sheet 4 : 1": ({"size": [4, 1]}, 0.09365025603441024, 2.8631857593998693, 2.739180274446267),
}

# Builds and errors.


class Built:
    """Added mass of a JSON shape, by the program, or of a mesh, by the module, at so many panels; 0: each triangle is one."""

    def __init__(self, source, panels=4200, threads=0):
        begin, start = sum(os.times()[:4]), time.perf_counter()
        if isinstance(source, dict):
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "shape.json"
                file.write_text(json.dumps(source))
                words = [PREPROCESS, "build", file, "-o", file.with_suffix(".ambient"), "--no-tables", "--json"]
                words += ["--origin", "0,0,0", "--panels", str(panels), "--threads", str(threads)]
                made = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
            self.faces, self.added_mass = made["faces"], np.array(made["added_mass"])
        else:
            body = ba.FluidBody.from_mesh(*source, origin=(0, 0, 0), panels=panels, threads=threads)
            self.faces, self.added_mass = len(source[1]), body.added_mass
        self.seconds, self.wall = sum(os.times()[:4]) - begin, time.perf_counter() - start


def errors(K, exact):
    """Of rotation, translation, coupling; scales of the blocks. A sphere has the inertia of a solid one for rotation."""
    largest = lambda i, j, of: np.abs(of[i : i + 3, j : j + 3]).max()
    translation = largest(3, 3, exact)
    rotation = largest(0, 0, exact) or 0.8 * translation * (6 * translation / (4 * np.pi)) ** (2 / 3)
    scales = np.array([rotation, translation, np.sqrt(rotation * translation)])
    return np.array([largest(0, 0, K - exact), largest(3, 3, K - exact), largest(0, 3, K - exact)]) / scales, scales


def zeros(K, symmetry, scales):
    """Largest entry that vanishes by the symmetry of the body."""
    i, j = np.indices((6, 6))
    blocks = i % 3 == j % 3
    across = (i // 3 != j // 3) & ~blocks & (i % 3 != 2) & (j % 3 != 2)
    kept = {"mirrors": i == j, "two": (i == j) | across, "turns": blocks, "sheet": (i == j) & np.isin(i, (0, 1, 5))}
    scale = np.where(i // 3 != j // 3, scales[2], np.where(i < 3, scales[0], scales[1]))
    return np.abs(np.where(kept[symmetry], 0, K) / scale).max()


def extrapolated(make, order=2):
    """Limit of meshes of about 1800 and 4800 triangles for errors of this order, and its distance from the finer one."""

    def solve():
        coarse, fine = Built(make(1800), 0), Built(make(4800), 0)
        step = (fine.added_mass - coarse.added_mass) / ((fine.faces / coarse.faces) ** (order / 2) - 1)
        limit = fine.added_mass + step
        return limit, errors(fine.added_mass, limit)[0][:2].max()

    return solve


def cases():
    """Name, target, symmetry, source, reference of the table of accuracy."""
    for height in (1, 2, 5, 10, 20, 50, 1 / 2, 1 / 10, 1 / 50):
        name = "sphere" if height == 1 else f"spheroid {height} : 1" if height > 1 else f"spheroid 1 : {1 / height:.0f}"
        for faces in (1300, 3000):
            shape = {"type": "ellipsoid", "semi_axes": [1, 1, height], "faces": faces}
            yield name, "smooth", "mirrors", shape, ellipsoid_added_mass([1, 1, height])
    for faces in (1300, 3000):
        yield "twisted ellipsoid", "smooth", "turns", ellipsoid([1.2, 0.6, 1], faces, twist=1), twisted_added_mass()
    for n in (26, 36):
        yield "torus 2 : 1", "smooth", "mirrors", torus(n), TORUS
    yield "capsule, height 2", "smooth", "mirrors", {"type": "capsule", "radius": 1, "height": 2}, CAPSULE

    for height, known in ((0.02, None), (0.2, COIN), (2, CYLINDER), (20, None)):
        make = lambda faces, h=height: {"type": "cylinder", "radius": 1, "height": h, "faces": faces}
        yield f"cylinder, L/D {height / 2:g}", "sharp", "mirrors", make(1300), extrapolated(make) if known is None else known
    for height in (0.5, 1.0, 4.0):
        make = lambda faces, h=height: {"type": "cone", "radius": 1, "height": h, "faces": faces}
        yield f"cone, height over radius {height}", "sharp", "two", make(1300), extrapolated(make)
    yield "hemisphere", "sharp", "two", to_volume(hemisphere(10), 2 * np.pi / 3), HEMISPHERE
    for thickness in (0.2, 0.1, 0.05):
        make = lambda faces, t=thickness: bowl(t, 14, 4, True) if faces < 2000 else bowl(t, 20, 5, True)
        yield f"bowl, thickness {100 * thickness:g} %", "sharp", "two", bowl(thickness, 10, 1, False), extrapolated(make)

    box = lambda half, faces: {"type": "box", "half_sizes": half, "faces": faces}
    twelve = lambda half: (simplicial_box() * half, BOX_FACES)
    yield "cube", "sharp", "mirrors", twelve([1, 1, 1]), CUBE
    yield "cube", "sharp", "mirrors", box([1, 1, 1], 1300), CUBE
    yield "cube, equal triangles", "sharp", "mirrors", divided(twelve([1, 1, 1]), 16), CUBE
    for name, half in (("1/2", [1, 1, 0.5]), ("1/20", [1, 1, 0.05]), ("rod", [1, 0.05, 0.05])):
        name = "box 1 : 1/20 : 1/20" if name == "rod" else f"box 1 : 1 : {name}"
        for source in (twelve(half), box(half, 1300)):
            yield name, "sharp", "mirrors", source, extrapolated(lambda faces, h=half: box(h, faces), 2.6)
    tetrahedron = simplicial([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
    octahedron = simplicial(np.vstack([np.eye(3), -np.eye(3)]))
    solids = {"tetrahedron": 2 * [tetrahedron], "octahedron": 2 * [octahedron], "icosahedron": 2 * [icosahedron()]}
    solids["dodecahedron"] = [dodecahedron(False), dodecahedron(True)]
    for name, (mesh, coarse) in solids.items():
        make = lambda faces, c=coarse: divided(c, int((faces / len(c[1])) ** 0.5), graded=True)
        yield name, "sharp", "mirrors", mesh, extrapolated(make, 2.6)
    for name, (shape, w_x, w_y, v_z) in SHEETS.items():
        yield name, "sheet", "sheet", {"type": "sheet", **shape}, np.diag([w_x, w_y, 0, 0, 0, v_z])


def simplicial_box():
    return np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)


BOX_FACES = np.array(
    [(0, 1, 3), (0, 3, 2), (4, 7, 5), (4, 6, 7), (0, 5, 1), (0, 4, 5), (2, 3, 7), (2, 7, 6), (0, 6, 4), (0, 2, 6)]
    + [(1, 5, 7), (1, 7, 3)]
)

# Tables.


def head(*columns):
    return "| " + " | ".join(columns) + " |\n|" + len(columns) * "---|"


def accuracy(options):
    yield head("shape", "faces", "rotation", "translation", "coupling", "zeros", "reference", "wanted", "processor")
    for name, target, symmetry, source, reference in cases():
        if options.shape not in name:
            continue
        exact, correction = reference() if callable(reference) else (reference, 0)
        built, wanted = Built(source), WANTED[target]
        error, scales = errors(built.added_mass, exact)
        zero = zeros(built.added_mass, symmetry, scales)
        coupling = f"{100 * error[2]:.2f} %" if np.abs(exact[:3, 3:]).max() > 1e-3 else ""
        known = f"{100 * correction:.2f} %" if correction else "known"
        missed = " **missed**" if error.max() > wanted or zero > 1e-4 else ""
        yield (
            f"| {name} | {built.faces} | {100 * error[0]:.2f} % | {100 * error[1]:.2f} % | {coupling} | {zero:.1e} | "
            f"{known} | {100 * wanted:g} %{missed} | {built.seconds:.1f} s |"
        )


def convergence(options):
    """Every triangle is a panel."""
    cube = simplicial_box(), BOX_FACES
    graded = lambda faces: {"type": "box", "half_sizes": [1, 1, 1], "faces": faces}
    rectangle = SHEETS["rectangular sheet 2 : 1"]
    sheet = lambda faces: {"type": "sheet", "size": [2, 1], "faces": faces}
    sequences = {
        "spheroid 2 : 1": ([ellipsoid([1, 1, 2], 20 * n * n) for n in (4, 6, 9, 13)], ellipsoid_added_mass([1, 1, 2])),
        "cube, triangles of equal size": ([divided(cube, n) for n in (2, 4, 8, 16)], CUBE),
        "cube, triangles graded towards the edges": (map(graded, (192, 432, 1200, 3072)), CUBE),
        "rectangular sheet 2 : 1, graded towards the boundary": (
            map(sheet, (150, 400, 1200, 3600)),
            np.diag([rectangle[1], rectangle[2], 0, 0, 0, rectangle[3]]),
        ),
    }
    yield head("body", "panels", "rotation", "order", "translation", "order")
    for name, (sources, exact) in sequences.items():
        last = None
        for source in sources:
            built = Built(source, 0)
            row = np.array([built.faces, *errors(built.added_mass, exact)[0][:2]])
            order = ["", ""] if last is None else [f"{x:.1f}" for x in 2 * np.log(last[1:] / row[1:]) / np.log(row[0] / last[0])]
            yield f"| {name} | {built.faces} | {row[1]:.1e} | {order[0]} | {row[2]:.1e} | {order[1]} |"
            last = row


def timed_point_sources(mesh, takes, exact_flux):
    """Added mass, and least processor and wall time of several takes [s]."""
    times = []
    for _ in range(takes):
        begin, start = time.process_time(), time.perf_counter()
        K = point_sources.added_mass(*mesh, 1, exact_flux)
        times.append((time.process_time() - begin, time.perf_counter() - start))
    return K, *np.min(times, 0)


def timed_build(mesh, takes, *settings):
    runs = [Built(mesh, *settings) for _ in range(takes)]
    return runs[0].added_mass, min(run.seconds for run in runs), min(run.wall for run in runs)


def race(options, takes=3):
    yield head("body", "method", "vertices", "rotation", "translation", "processor", "wall")
    for height in (1, 0.5, 0.1):
        mesh, exact = ellipsoid([1, 1, height], 2900), ellipsoid_added_mass([1, 1, height])
        results = {
            "complete build, 2 threads": timed_build(mesh, takes, 4200, 2),
            "point sources, velocity at vertices": timed_point_sources(mesh, takes, False),
            "point sources, exact flux": timed_point_sources(mesh, takes, True),
        }
        for method, (K, processor, wall) in results.items():
            rotation, translation, _ = errors(K, exact)[0]
            text = f"| spheroid 1 : 1 : {height} | {method} | {len(mesh[0])} | {rotation:.1e} | {translation:.1e} |"
            yield f"{text} {processor:.2f} s | {wall:.2f} s |"


def curve(options, takes=2):
    """CSV of error over run time."""
    bodies = {
        "spheroid 1 : 1/2": (lambda faces: ellipsoid([1, 1, 0.5], faces), ellipsoid_added_mass([1, 1, 0.5])),
        "spheroid 1 : 1/10": (lambda faces: ellipsoid([1, 1, 0.1], faces), ellipsoid_added_mass([1, 1, 0.1])),
        "twisted ellipsoid": (lambda faces: ellipsoid([1.2, 0.6, 1], faces, twist=1), twisted_added_mass()),
        "torus 2 : 1": (lambda faces: torus(int((faces / 2) ** 0.5)), TORUS),
        "cylinder, L/D 1": (cylinder, CYLINDER),
        "cube, equal triangles": (lambda n: divided((simplicial_box(), BOX_FACES), int(np.ceil((n / 12) ** 0.5))), CUBE),
    }
    yield "case,method,faces,processor_seconds,error"
    for name, (make, exact) in bodies.items():
        for faces in (80, 320, 1280, 2880):
            mesh = make(faces)
            results = {
                "build": timed_build(mesh, takes),
                "build, 1000 panels": timed_build(mesh, takes, 1000),
                "panels alone": timed_build(mesh, takes, 0),
                "point sources": timed_point_sources(mesh, takes, False),
                "point sources, exact flux": timed_point_sources(mesh, takes, True),
            }
            for method, (K, processor, _) in results.items():
                yield f'"{name}","{method}",{len(mesh[1])},{processor:.4f},{errors(K, exact)[0][:2].max():.3e}'


def main():
    global PREPROCESS
    tables = {"accuracy": accuracy, "convergence": convergence, "race": race}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("preprocess", help="the program ambient_preprocess")
    parser.add_argument("--table", choices=tables, help="which table to make (default: all)")
    parser.add_argument("--shape", default="", help="only shapes whose name holds this, in the table of accuracy")
    parser.add_argument("--out", help="write the tables to this file")
    parser.add_argument("--curve", help="write the error over the run time to this CSV file, and no tables")
    options = parser.parse_args()
    PREPROCESS = options.preprocess
    os.environ["BULLET_AMBIENT_CACHE"] = "off"
    chosen = [curve] if options.curve else [tables[options.table]] if options.table else list(tables.values())
    lines = []
    for table in chosen:
        for line in table(options):
            print(line, flush=True)
            lines.append(line)
        if not options.curve:
            lines.append("")
    if file := options.curve or options.out:
        Path(file).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
