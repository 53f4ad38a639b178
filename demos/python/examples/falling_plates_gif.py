#!/usr/bin/python3
"""The moving picture of the README: plates of 8, 9 and 10 cm fall in air, seen from the side, in real time.

Needs python3-pil.
"""

import argparse
from pathlib import Path

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont

import bullet_ambient as ba

SCENES = ("plate_8cm", "plate_9cm", "plate_10cm")
DURATION, FRAMES_PER_SECOND, STEPS_PER_FRAME = 6, 20, 4  # GIF counts hundredths of seconds
WIDTH, HEIGHT, VIEW = 230, 280, 0.6  # size of a panel [pixels] and its width [m]
FINER = 3  # factor by which pictures are drawn larger and then scaled down, for smooth edges
GRID = 0.1  # [m]
INK = (60, 70, 80)
PAPER, LINES, PATH, PLATE = (255, 255, 255), (232, 236, 240), (150, 185, 220), (180, 50, 40)


def fall_of(name):
    """Positions (T, 2) in the plane of the fall, the plate's direction (T, 2), and its radius [m]."""
    scene = ba.Scene(name)
    radius = {"plate_8cm": 0.04, "plate_9cm": 0.045, "plate_10cm": 0.05}[name]
    motion = ba.World(scene).run(DURATION, 1 / (FRAMES_PER_SECOND * STEPS_PER_FRAME))
    w, x, y, z = motion.orientation[:, 0].T
    along = np.c_[1 - 2 * (y * y + z * z), 2 * (x * z - w * y)]  # the x axis of the plate, seen from the side
    return motion.position[:, 0, ::2], along, radius


def smooth(path, width):
    """Positions of the camera: moving mean over a window of samples."""
    padded = np.pad(path, ((width, width), (0, 0)), mode="edge")
    kernel = np.ones(2 * width + 1) / (2 * width + 1)
    return np.stack([np.convolve(column, kernel, mode="valid") for column in padded.T], axis=1)


def draw_scale(pen, text, scale):
    """Draws a bar as long as a cell of the grid, at the lower left, and the caption."""
    fonts = Path(matplotlib.get_data_path()) / "fonts/ttf"
    font = ImageFont.truetype(str(fonts / "DejaVuSans.ttf"), 13 * FINER)
    left, bottom = 12 * FINER, (HEIGHT - 12) * FINER
    pen.line([(left, bottom), (left + GRID * scale, bottom)], fill=INK, width=3 * FINER)
    pen.text((left, bottom - 20 * FINER), f"{100 * GRID:.0f} cm", fill=INK, font=font)
    pen.text((left, 8 * FINER), text, fill=INK, font=font)


def draw_panel(fall, camera, now):
    size = np.array([WIDTH, HEIGHT]) * FINER
    scale = size[0] / VIEW
    image = Image.new("RGB", tuple(size), PAPER)
    pen = ImageDraw.Draw(image)
    place = lambda p: tuple((p - camera[now]) * (scale, -scale) + size / 2)  # noqa: E731
    low, high = camera[now] - size / scale / 2, camera[now] + size / scale / 2
    for axis in (0, 1):
        for at in np.arange(np.ceil(low[axis] / GRID), high[axis] / GRID) * GRID:
            ends = [np.array(low), np.array(high)]
            for end in ends:
                end[axis] = at
            pen.line([place(end) for end in ends], fill=LINES, width=FINER)
    position, along, radius = fall
    for i in range(max(0, now - 8 * STEPS_PER_FRAME * FRAMES_PER_SECOND), now, STEPS_PER_FRAME // 2):
        ends = [place(position[i] + side * radius * along[i]) for side in (-1, 1)]
        pen.line(ends, fill=PATH, width=FINER + 1)
    pen.line([place(position[now] + side * radius * along[now]) for side in (-1, 1)], fill=PLATE, width=4 * FINER)
    draw_scale(pen, f"a plate of {100 * 2 * radius:.0f} cm", scale)
    return image.resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)


def main(file):
    falls = [fall_of(name) for name in SCENES]
    cameras = [smooth(fall[0], FRAMES_PER_SECOND * STEPS_PER_FRAME // 2) for fall in falls]
    frames = []
    for now in range(0, len(falls[0][0]), STEPS_PER_FRAME):
        frame = Image.new("RGB", (len(falls) * WIDTH, HEIGHT), PAPER)
        for i, (fall, camera) in enumerate(zip(falls, cameras)):
            frame.paste(draw_panel(fall, camera, now), (i * WIDTH, 0))
        frames.append(frame.quantize(24, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE))
    frames[0].save(file, save_all=True, append_images=frames[1:], duration=1000 // FRAMES_PER_SECOND, loop=0, optimize=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", metavar="FILE.gif")
    main(parser.parse_args().file)
