#!/usr/bin/python3
"""Added mass of a closed mesh by point sources inside it, in plain dense numpy: point_sources.py MESH.obj

The method of Padilla, Segall and Sorkine-Hornung (2025) after Weissmann and Pinkall (2012), as plain numpy: one source
per vertex, moved inwards along the vertex normal; the flux of every source through the cell of every vertex, a third of
each of its triangles; six right-hand sides; potentials summed at the barycentres. The flux is exact, by solid angles, or
quicker, from the normal velocity at the vertex. Prints the processor and the wall time of all that follows the reading of
the mesh, the least of several takes, and the matrix about the mesh's origin per unit density, rotation first.
"""

import argparse
import time

import numpy as np


def read_mesh(file):
    lines = [line.split() for line in open(file)]
    vertices = np.array([line[1:4] for line in lines if line and line[0] == "v"], dtype=float)
    triangles = np.array([line[1:4] for line in lines if line and line[0] == "f"], dtype=int) - 1
    return vertices, triangles


def per_vertex(triangles, of_triangle, count):
    """A third of every triangle's rows for each of its vertices."""
    result = np.zeros((count,) + of_triangle.shape[1:])
    for k in range(3):
        np.add.at(result, triangles[:, k], of_triangle / 3)
    return result


def distances(points, sources):
    """P x S, by matrix products."""
    squares = (points**2).sum(1)[:, None] + (sources**2).sum(1)[None] - 2 * points @ sources.T
    return np.sqrt(squares)


def solid_angles(vertices, triangles, sources):
    """T x S, of the triangles seen from the sources; Van Oosterom and Strackee 1983."""
    corners = vertices[triangles]
    to_vertices = distances(vertices, sources)
    lengths = [to_vertices[triangles[:, k]] for k in range(3)]
    twice_area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    triple = np.einsum("ti,ti->t", corners[:, 0], twice_area)[:, None] - twice_area @ sources.T
    below = lengths[0] * lengths[1] * lengths[2]
    source_squares = (sources**2).sum(1)[None]
    for k in range(3):
        p, q = corners[:, k], corners[:, (k + 1) % 3]
        dot = np.einsum("ti,ti->t", p, q)[:, None] - (p + q) @ sources.T + source_squares
        below += dot * lengths[(k + 2) % 3]
    return 2 * np.arctan2(triple, below)


def cell_fluxes(vertices, triangles, sources):
    """V x S, of unit sources through a third of each triangle of a vertex."""
    return per_vertex(triangles, solid_angles(vertices, triangles, sources), len(vertices)) / (4 * np.pi)


def vertex_fluxes(vertices, normals, areas, sources):
    """V x S, with the normal velocity at the vertex for that of its whole cell."""
    r = distances(vertices, sources)
    along = np.einsum("vi,vi->v", vertices, normals)[:, None] - normals @ sources.T
    return areas[:, None] * along / (4 * np.pi * r**3)


def added_mass(vertices, triangles, offset, exact_flux):
    corners = vertices[triangles]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    area_normals = np.cross(b - a, c - a) / 2
    barycentres = (a + b + c) / 3
    edge = np.mean([np.linalg.norm(x - y, axis=1).mean() for x, y in ((a, b), (b, c), (c, a))])
    normals = per_vertex(triangles, area_normals, len(vertices))
    areas = np.linalg.norm(normals, axis=1)
    normals /= areas[:, None]
    sources = vertices - offset * edge * normals

    # Outward flux of the six unit motions through the triangles, exact for linear velocities.
    motion = np.hstack([np.cross(barycentres, area_normals), area_normals])
    if exact_flux:
        flux = cell_fluxes(vertices, triangles, sources)
    else:
        flux = vertex_fluxes(vertices, normals, areas, sources)
    strengths = np.linalg.solve(flux, per_vertex(triangles, motion, len(vertices)))
    potentials = (-1 / (4 * np.pi * distances(barycentres, sources))) @ strengths
    matrix = -potentials.T @ motion
    return (matrix + matrix.T) / 2


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("--offset", type=float, default=1, help="of the sources, in mean edge lengths")
    parser.add_argument("--exact-flux", action="store_true", help="through cells, instead of the velocity at vertices")
    parser.add_argument("--takes", type=int, default=1)
    options = parser.parse_args()
    mesh = read_mesh(options.mesh)
    processor, wall = [], []
    for _ in range(options.takes):
        begin, start = time.process_time(), time.perf_counter()
        matrix = added_mass(*mesh, options.offset, options.exact_flux)
        processor.append(time.process_time() - begin)
        wall.append(time.perf_counter() - start)
    print(min(processor), min(wall))
    for row in matrix:
        print(*(repr(float(x)) for x in row))


if __name__ == "__main__":
    main()
