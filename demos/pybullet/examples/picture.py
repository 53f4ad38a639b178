"""Pictures of a PyBullet world by its TinyRenderer, which needs no window. It draws nothing transparent: water is blended in."""

from pathlib import Path

import matplotlib.image
import numpy as np
import pybullet as p

SIZE = (800, 400)


def add_surface(lower, upper, height=lambda x, y: 0 * x, cells=48, colour=(0.25, 0.55, 0.85, 1), is_dry=None):
    """Adds a surface of water over a rectangle, but for cells whose corner (x, y) `is_dry`: a body without mass and collisions, for pictures alone."""
    x, y = (np.linspace(lower[i], upper[i], cells + 1) for i in (0, 1))
    x, y = np.meshgrid(x, y)
    vertices = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3)
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).reshape(-1, 1)
    if is_dry:
        corner = corner[~is_dry(*vertices[corner[:, 0], :2].T)]
    triangles = np.concatenate([corner + [0, 1, cells + 2], corner + [0, cells + 2, cells + 1]])
    shape = p.createVisualShape(p.GEOM_MESH, vertices=vertices.tolist(), indices=triangles.ravel().tolist(), rgbaColor=colour)
    return p.createMultiBody(0, -1, shape)


def render(eye, target):
    view = p.computeViewMatrix(eye, target, [0, 0, 1])
    lens = p.computeProjectionMatrixFOV(40, SIZE[0] / SIZE[1], 0.1, 20)
    pixels = p.getCameraImage(*SIZE, view, lens, renderer=p.ER_TINY_RENDERER, shadow=1, lightDirection=[1, -2, 3])[2]
    return np.reshape(pixels, (SIZE[1], SIZE[0], 4))[:, :, :3] / 255


def save(path, eye, target, surface=None, share=0.4):
    """Writes a picture from `eye`. `surface`: adds the water, which is blended over what lies below it."""
    pixels = render(eye, target)
    if surface:
        surface()
        pixels = (1 - share) * pixels + share * render(eye, target)
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    matplotlib.image.imsave(path, pixels)
