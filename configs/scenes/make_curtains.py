#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes curtains.xml, the scene of the README's picture, with its meshes and textures, beside itself.

Python 3, standard library only. Lengths are in metres, y is up.
"""

import math
import pathlib
import random

from make_rooms import metal, rough_plastic
from scene_writer import Writer, scale, translate, turn_y, write_grid, write_lathe, write_png

HERE = pathlib.Path(__file__).resolve().parent
SCRIPT = pathlib.Path(__file__).name
GAP = 2.1, 0.22  # middle and width, along z, of the gap between the curtains


def curtain(low, high):
    """Points of a pleated cloth from z = low to high before the wall x = 0; pleats open towards the floor."""
    def point(u, v):
        pleat = math.sin(2 * math.pi * (high - low) / 0.17 * u + 0.5 * math.sin(9 * u))
        return 0.14 + (0.035 + 0.03 * v) * pleat, 2.62 * (1 - v) + 0.004, low + (high - low) * u
    return point


def cushion(u, v):
    """Points of a box with round edges and soft faces: a superellipsoid of half axes 1."""
    def power(x, e):
        return math.copysign(abs(x) ** e, x)
    a, b = math.pi * (v - 0.5), 2 * math.pi * u
    return power(math.cos(a), 0.35) * power(math.cos(b), 0.35), power(math.sin(a), 0.5), power(math.cos(a), 0.35) * power(math.sin(b), 0.35)


def leaf(u, v):
    """Points of a blade, 1 high, that bends towards x."""
    width = 0.085 * (0.55 + 0.9 * v) * (1 - v ** 4) if v < 1 else 0.0
    side = 2 * u - 1
    return 0.25 * v ** 2 + 0.35 * width * side * side, v - 0.08 * v ** 2, width * side


def make_meshes():
    folder = HERE / "meshes"
    middle, gap = GAP
    write_grid(folder / "curtain-left.obj", curtain(middle + gap / 2, 3.25), 144, 2, "A curtain", SCRIPT)
    write_grid(folder / "curtain-right.obj", curtain(0.95, middle - gap / 2), 144, 2, "A curtain", SCRIPT)
    write_grid(folder / "cushion.obj", cushion, 36, 18, "A cushion", SCRIPT)
    write_grid(folder / "leaf.obj", leaf, 4, 14, "A leaf", SCRIPT)
    bottle = [(0.0, 0.0), (0.05, 0.0)]
    bottle += [(0.05 + 0.075 * math.sin(math.pi * t / 14) ** 0.8, 0.26 * t / 14) for t in range(1, 13)]
    bottle += [(0.034, 0.265), (0.028, 0.3), (0.03, 0.37), (0.04, 0.385), (0.03, 0.385), (0.02, 0.3), (0.0, 0.29)]
    write_lathe(folder / "bottle.obj", bottle, 32, "A bottle", SCRIPT)
    bowl = [(0.0, 0.0), (0.06, 0.0), (0.06, 0.012)]
    bowl += [(0.06 + 0.11 * math.sin(math.pi / 2 * t / 10), 0.012 + 0.1 * (1 - math.cos(math.pi / 2 * t / 10))) for t in range(1, 11)]
    bowl += [(0.16 * math.cos(math.pi / 2 * t / 10), 0.112 - 0.09 * math.sin(math.pi / 2 * t / 10)) for t in range(10)]
    bowl += [(0.0, 0.022)]
    write_lathe(folder / "bowl.obj", bowl, 32, "A bowl", SCRIPT)


def make_textures():
    folder = HERE / "textures"
    draw = random.Random(5)
    size, plank = 640, 80  # a tile of 1.28 m; planks of 16 cm
    rows = []
    for row in range(size // plank):
        tones = [draw.uniform(0.8, 1.08) for _ in range(2)]
        start = draw.randrange(size)
        for y in range(plank):
            line, grain = [], 0.0
            for x in range(size):
                at = (x + start) % size
                if x % 23 == 0:
                    grain = 0.06 * math.sin(0.9 * y + 3 * math.sin(0.11 * y + row) + 0.01 * at) * draw.random()
                seam = y == 0 or at % (size // 2) == 0
                tone = 0.45 if seam else tones[at * 2 // size] + grain
                line.append(tuple(round(min(c * tone, 255) / 4) * 4 for c in (186, 146, 104)))
            rows.append([tuple(min(c, 255) for c in pixel) for pixel in line])
    write_png(folder / "parquet.png", rows)

    def painting(x, y):
        u, v = x / 180, y / 120
        edge = 4 * math.sin(11 * u) * math.sin(17 * v)
        bands = ((0.06, (214, 200, 172)), (0.5, (196, 84, 38)), (0.56, (214, 200, 172)), (0.93, (28, 58, 84)), (2, (214, 200, 172)))
        if not 0.04 < u < 0.96:
            return bands[0][1]
        colour = next(c for end, c in bands if v < end)
        return tuple(int(max(0, min(255, c + edge))) for c in colour)

    write_png(folder / "painting.png", [[painting(x, y) for x in range(180)] for y in range(120)])

    def rug(x, y):
        stripe = y < 5 or y >= 123 or 12 <= y < 16 or 112 <= y < 116
        weave = 6 * ((x + y) % 2)
        return tuple(c - weave for c in ((96, 104, 112) if stripe else (226, 220, 208)))

    write_png(folder / "rug.png", [[rug(x, y) for x in range(64)] for y in range(128)])


def bitmap(w, file, **values):
    def write(name):
        w.open("texture", type="bitmap", name=w.name(name))
        w.put(filename=f"textures/{file}", **values)
        w.close("texture")
    return write


def sofa(w, x0, x1, cloth, legs):
    """A sofa along the wall z = 0, three seats wide."""
    def part(center, half):
        w.shape("obj", cloth, [scale(half), translate(center)], filename="meshes/cushion.obj")
    width = (x1 - x0 - 0.36) / 3
    part(((x0 + x1) / 2, 0.24, 0.58), ((x1 - x0) / 2 - 0.03, 0.13, 0.44))
    for k in range(3):
        x = x0 + 0.18 + width * (k + 0.5)
        part((x, 0.43, 0.66), (width / 2 - 0.004, 0.1, 0.4))
        part((x, 0.68, 0.27), (width / 2 - 0.004, 0.28, 0.13))
    for x in (x0 + 0.09, x1 - 0.09):
        part((x, 0.4, 0.58), (0.1, 0.29, 0.46))
    for x in (x0 + 0.1, x1 - 0.1):
        for z in (0.25, 0.92):
            w.shape("cylinder", legs, points={"p0": (x, 0, z), "p1": (x, 0.14, z)}, radius=0.02)


def pillow(w, center, half, turn, tilt, cloth):
    w.shape("obj", cloth, [scale(half), f'<rotate x="1" angle="{tilt}"/>', turn_y(turn), translate(center)], filename="meshes/cushion.obj")


def shelf(w, x0, x1, wood, colours):
    """Boards with books along the wall z = 0."""
    draw = random.Random(11)
    for x in (x0, x1 - 0.025):
        w.box((x, 0, 0.01), (x + 0.025, 2.1, 0.34), wood)
    w.box((x0, 0, 0.005), (x1, 2.1, 0.02), wood)
    boards = (0.06, 0.46, 0.86, 1.26, 1.66, 2.075)
    for y in boards:
        w.box((x0, y, 0.01), (x1, y + 0.025, 0.34), wood)
    for y in boards[:-1]:
        x, end = x0 + 0.03, x1 - draw.uniform(0.06, 0.35)
        while x < end:
            thick, tall, deep = draw.uniform(0.02, 0.05), draw.uniform(0.2, 0.32), draw.uniform(0.17, 0.24)
            if draw.random() < 0.93:
                w.box((x, y + 0.025, 0.05), (x + thick - 0.002, y + 0.025 + tall, 0.05 + deep), draw.choice(colours))
            x += thick


def curtains():
    w = Writer("0.6.0", "A room behind curtains that leave a gap of a hand's width: the sun draws a stripe over floor, table and sofa, and all\n"
               "     else is lit by that stripe. Next event finds it only from within the stripe.", SCRIPT)
    w.camera((4.75, 1.3, 4.25), (2.12, 0.96, 0.95), 63, width=640, height=320)
    for ident, colour in (("plaster", (0.74, 0.73, 0.7)), ("ceiling", (0.82, 0.81, 0.79)), ("trim", (0.8, 0.79, 0.76)),
                          ("sofa", (0.1, 0.2, 0.26)), ("ochre cloth", (0.68, 0.4, 0.1)), ("white cloth", (0.75, 0.72, 0.67)),
                          ("ground", (0.03, 0.05, 0.015)), ("far", (0.07, 0.088, 0.11)), ("facade", (0.8, 0.78, 0.74)), ("pot", (0.55, 0.27, 0.17)), ("earth", (0.06, 0.045, 0.035)),
                          ("book 1", (0.45, 0.1, 0.07)), ("book 2", (0.08, 0.17, 0.3)), ("book 3", (0.66, 0.6, 0.48)),
                          ("book 4", (0.12, 0.25, 0.16)), ("book 5", (0.6, 0.36, 0.1)), ("book 6", (0.16, 0.14, 0.13))):
        w.bsdf(ident, "diffuse", reflectance=colour)
    for ident, colour in (("curtain", (0.5, 0.2, 0.12)), ("leaf", (0.1, 0.24, 0.07)), ("shade", (0.72, 0.66, 0.55))):
        w.bsdf(ident, "twosided", [lambda colour=colour: w.object("bsdf", "diffuse", reflectance=colour)])
    w.bsdf("parquet", "roughplastic", distribution="ggx", alpha=0.13, diffuseReflectance=bitmap(w, "parquet.png", uscale=4.4, vscale=3.6))
    w.bsdf("painting", "diffuse", reflectance=bitmap(w, "painting.png"))
    w.bsdf("rug", "diffuse", reflectance=bitmap(w, "rug.png"))
    rough_plastic(w, "walnut", (0.2, 0.105, 0.055), 0.2)
    w.bsdf("marble", "diffuse", reflectance=(0.72, 0.71, 0.69))
    rough_plastic(w, "glaze", (0.78, 0.77, 0.74), 0.08)
    rough_plastic(w, "blue glaze", (0.05, 0.13, 0.3), 0.08)
    metal(w, "brass", "Au", 0.16)
    metal(w, "black steel", "W", 0.35)

    w.blank("The room; the window, from floor to lintel, is in the wall x = 0.")
    width, height, depth = 5.6, 2.9, 4.5
    w.shape("rectangle", "parquet", [scale((width / 2, depth / 2, 1)), '<rotate x="1" angle="-90"/>', translate((width / 2, 0, depth / 2))])
    w.box((-0.2, -0.2, -0.2), (width + 0.2, -0.001, depth + 0.2), "walnut")
    w.box((-0.2, height, -0.2), (width + 0.2, height + 0.1, depth + 0.2), "ceiling")
    w.box((width, 0, -0.2), (width + 0.1, height, depth + 0.2), "plaster")
    w.box((0, 0, -0.1), (width, height, 0), "plaster")
    w.box((0, 0, depth), (width, height, depth + 0.1), "plaster")
    w.box((-0.2, 0, -0.1), (0, height, 1.2), "plaster")
    w.box((-0.2, 0, 3.0), (0, height, depth + 0.1), "plaster")
    w.box((-0.2, 2.5, 1.2), (0, height, 3.0), "plaster")
    w.box((0, 0, 0), (width, 0.11, 0.018), "trim")
    w.box((0, 0, 0.018), (0.018, 0.11, 1.2), "trim")
    w.box((0, height - 0.09, 0), (width, height, 0.07), "trim")
    w.box((0, height - 0.09, 0.07), (0.07, height, depth), "trim")
    w.blank("Curtains on their rail; sun and sky outside.")
    for side in ("left", "right"):
        w.shape("obj", "curtain", filename=f"meshes/curtain-{side}.obj")
    w.shape("cylinder", "brass", points={"p0": (0.14, 2.66, 0.85), "p1": (0.14, 2.66, 3.35)}, radius=0.018)
    for z in (0.83, 3.37):
        w.sphere((0.14, 2.66, z), 0.032, "brass")
    w.box((-15, -0.3, -30), (-0.2, -0.1, 20), "ground")
    w.box((-15.1, -0.3, -30), (-15, 12, 20), "far")
    w.shape("rectangle", "facade", [scale((0.9, 4.0, 1)), turn_y(90 + 25), translate((-7.0, 3.9, GAP[0] + 0.45 * 7))])
    w.open("emitter", type="directional")
    w.line('<vector name="direction" x="-1" y="-0.9" z="0.35"/>')
    w.put(irradiance=(400, 372, 330))
    w.close("emitter")

    w.blank("A sofa, a painting, a shelf.")
    sofa(w, 1.35, 3.55, "sofa", "black steel")
    pillow(w, (1.78, 0.72, 0.5), (0.24, 0.22, 0.075), 12, -22, "ochre cloth")
    pillow(w, (3.12, 0.71, 0.5), (0.23, 0.21, 0.075), -14, -22, "white cloth")
    pillow(w, (2.9, 0.68, 0.6), (0.17, 0.16, 0.06), -4, -30, "ochre cloth")
    w.box((1.74, 1.22, 0.001), (3.16, 2.1, 0.03), "walnut")
    w.shape("rectangle", "painting", [scale((0.68, 0.41, 1)), translate((2.45, 1.66, 0.032))])
    shelf(w, 3.85, 4.75, "walnut", [f"book {k}" for k in range(1, 7)])
    w.sphere((4.55, 0.97, 0.2), 0.08, "brass")

    w.blank("A rug, a table, and what stands on it.")
    w.shape("rectangle", "rug", [scale((0.95, 1.3, 1)), '<rotate x="1" angle="-90"/>', '<rotate y="1" angle="90"/>', translate((2.15, 0.012, 1.75))])
    w.box((0.85, 0, 0.8), (3.45, 0.011, 2.7), "white cloth")
    x, z = 1.95, 1.62
    w.shape("cylinder", "marble", points={"p0": (x, 0.385, z), "p1": (x, 0.42, z)}, radius=0.5)
    w.shape("disk", "marble", [scale((0.5, 0.5, 1)), '<rotate x="1" angle="-90"/>', translate((x, 0.42, z))])
    w.shape("disk", "marble", [scale((0.5, 0.5, 1)), '<rotate x="1" angle="90"/>', translate((x, 0.385, z))])
    for k in range(3):
        a = math.radians(30 + 120 * k)
        w.shape("cylinder", "walnut", points={"p0": (x + 0.38 * math.cos(a), 0.012, z + 0.38 * math.sin(a)),
                                             "p1": (x + 0.24 * math.cos(a), 0.385, z + 0.24 * math.sin(a))}, radius=0.016)
    w.shape("obj", "blue glaze", [translate((x - 0.2, 0.42, z - 0.16))], filename="meshes/bottle.obj")
    w.shape("obj", "glaze", [translate((x + 0.2, 0.42, z + 0.08))], filename="meshes/bowl.obj")
    for dx, dz, r, cloth in ((-0.05, 0.02, 0.05, "book 5"), (0.055, 0.03, 0.048, "book 1"), (0.0, -0.06, 0.046, "book 5")):
        w.sphere((x + 0.2 + dx, 0.42 + 0.035 + r, z + 0.08 + dz), r, cloth)
    w.box((x - 0.25, 0.42, z + 0.15), (x - 0.03, 0.445, z + 0.31), "book 2", turn=25)
    w.box((x - 0.24, 0.445, z + 0.16), (x - 0.05, 0.465, z + 0.3), "book 3", turn=12)

    w.blank("A plant in the corner, a lamp that is off.")
    w.shape("cylinder", "pot", points={"p0": (0.62, 0, 0.55), "p1": (0.62, 0.36, 0.55)}, radius=0.2)
    w.shape("disk", "earth", [scale((0.2, 0.2, 1)), '<rotate x="1" angle="-90"/>', translate((0.62, 0.345, 0.55))])
    draw = random.Random(3)
    for k in range(15):
        turn, tall = 137.5 * k + draw.uniform(-12, 12), draw.uniform(0.75, 1.25)
        r, a = 0.02 + 0.008 * k, math.radians(137.5 * k)
        w.shape("obj", "leaf", [scale((tall * (0.5 + 0.06 * k), tall, tall)), turn_y(turn),
                                translate((0.62 + r * math.cos(a), 0.34, 0.55 - r * math.sin(a)))], filename="meshes/leaf.obj")
    x, z = 1.12, 0.36
    w.shape("cylinder", "black steel", points={"p0": (x, 0, z), "p1": (x, 0.02, z)}, radius=0.14)
    w.shape("disk", "black steel", [scale((0.14, 0.14, 1)), '<rotate x="1" angle="-90"/>', translate((x, 0.02, z))])
    w.shape("cylinder", "black steel", points={"p0": (x, 0.02, z), "p1": (x, 1.36, z)}, radius=0.012)
    w.shape("cylinder", "shade", points={"p0": (x, 1.33, z), "p1": (x, 1.6, z)}, radius=0.15)
    w.save(HERE / "curtains.xml")


if __name__ == "__main__":
    make_meshes()
    make_textures()
    curtains()
