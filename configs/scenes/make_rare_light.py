#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes scenes in which light is rare, or hard to choose: glass-case, bulb, water, classroom, staircase, plates and
fixtures, with the meshes they need, beside itself.

Python 3, standard library only. Lengths are in metres, y is up.
"""

import math
import pathlib

from make_rooms import metal, rough_plastic, table
from scene_writer import Writer, number, numbers, scale, translate, turn_y, write_torus, write_turned

HERE = pathlib.Path(__file__).resolve().parent
SCRIPT = pathlib.Path(__file__).name


def writer(comment):
    return Writer("3.0.0", comment, SCRIPT)


def area(w, radiance):
    return lambda: w.object("emitter", "area", radiance=radiance)


def facing(origin, target):
    return f'<lookat origin="{numbers(origin)}" target="{numbers(target)}" up="0, 1, 0"/>'


def glass_case():
    w = writer("A matte ring in a case of solid glass, in the light of a sun behind haze. No next event passes the\n"
               "     glass, and a path has to meet a disk of 1.8 degrees.")
    w.camera((1.5, 1.25, 2.6), (0, 0.42, 0), 36, width=384, height=256)
    w.bsdf("ground", "diffuse", reflectance=(0.55, 0.52, 0.47))
    w.bsdf("ring", "diffuse", reflectance=(0.75, 0.32, 0.12))
    w.bsdf("glass", "dielectric", intIOR=1.5, extIOR=1.0)
    w.shape("rectangle", "ground", [scale((4, 4, 1)), '<rotate x="1" angle="-90"/>'])
    w.blank("The ring stands free in the glass, which begins at its surface.")
    w.box((-0.55, 0.001, -0.55), (0.55, 0.95, 0.55), "glass")
    w.shape("obj", "ring", [turn_y(25), translate((0, 0.45, 0))], filename="meshes/torus.obj")
    w.blank("The sun: 1.8 degrees wide, 30 m away; and a dim sky.")
    sun = (12, 22, 16.5)
    distance = math.sqrt(sum(c * c for c in sun))
    radius = distance * math.radians(0.9)
    w.shape("disk", None, [scale((radius, radius, 1)), facing(sun, (0, 0, 0))], [area(w, (4000, 3650, 3040))])
    w.object("emitter", "constant", radiance=(0.12, 0.17, 0.27))
    w.save(HERE / "glass-case.xml")


def bulb():
    w = writer("A room that is lit by one lamp in a bulb of glass: light that no next event finds, since glass is before\n"
               "     it from everywhere.")
    w.camera((0.4, 1.5, 3.6), (2.4, 0.95, 1.2), 62, width=384, height=256)
    for ident, colour in (("white", (0.75, 0.73, 0.7)), ("wood", (0.35, 0.21, 0.12)), ("blue", (0.12, 0.2, 0.42))):
        w.bsdf(ident, "diffuse", reflectance=colour)
    metal(w, "brass", "Au", 0.15)
    w.bsdf("glass", "dielectric", intIOR=1.5, extIOR=1.0)
    w.bsdf("inside", "dielectric", intIOR=1.0, extIOR=1.5)
    w.room((4, 2.6, 4), "wood", "white", "white")
    table(w, (2.4, 1.3), (1.2, 0.8), 0.72, "wood", "brass")
    w.box((3.2, 0, 0.1), (3.9, 0.9, 0.6), "blue")
    w.sphere((2.7, 0.84, 1.45), 0.12, "blue")
    w.sphere((3.5, 1.05, 0.35), 0.15, "brass")
    w.blank("The bulb: a shell of glass about a lamp, on a foot.")
    at = (2.25, 1.02, 1.2)
    w.shape("cylinder", "brass", points={"p0": (at[0], 0.72, at[2]), "p1": (at[0], 0.9, at[2])}, radius=0.02)
    w.sphere(at, 0.11, "glass")
    w.sphere(at, 0.106, "inside")
    w.shape("sphere", None, points={"center": at}, radius=0.05, children=[area(w, (240, 184, 115))])
    w.save(HERE / "bulb.xml")


def water():
    w = writer("A glass of water on a table under a small lamp: three kinds of boundary (air and glass, glass and water, water\n"
               "     and air), and a figure of light on the table that only scattering finds.")
    w.camera((0.3, 0.42, 0.62), (0.01, 0.06, -0.01), 32, width=384, height=256)
    w.bsdf("table", "diffuse", reflectance=(0.55, 0.5, 0.44))
    w.bsdf("wall", "diffuse", reflectance=(0.3, 0.36, 0.4))
    w.bsdf("glass", "dielectric", intIOR=1.5, extIOR=1.0)
    w.bsdf("wet glass", "dielectric", intIOR=1.5, extIOR=1.33)
    w.bsdf("water", "dielectric", intIOR=1.33, extIOR=1.0)
    w.shape("rectangle", "table", [scale((1, 1, 1)), '<rotate x="1" angle="-90"/>'])
    w.shape("rectangle", "wall", [scale((1, 0.6, 1)), translate((0, 0.6, -0.5))])
    for name, material in (("glass", "glass"), ("glass-wet", "wet glass"), ("water", "water")):
        w.shape("obj", material, [translate((0, 0.001, 0))], filename=f"meshes/{name}.obj")
    w.blank("The lamp.")
    w.shape("disk", None, [scale((0.03, 0.03, 1)), facing((-0.55, 0.75, 0.15), (0, 0.05, 0))],
            [area(w, (480, 450, 400))])
    w.save(HERE / "water.xml")


def classroom():
    w = writer("Matte walls, desks and chairs, and daylight through a row of windows: light comes from where one looks for it,\n"
               "     and guiding brings little.")
    w.camera((7.4, 1.6, 5.5), (1.5, 0.9, 1.6), 66, width=384, height=256)
    for ident, colour in (("wall", (0.78, 0.76, 0.7)), ("floor", (0.45, 0.38, 0.3)), ("desk", (0.5, 0.33, 0.18)),
                          ("seat", (0.2, 0.3, 0.25)), ("board", (0.05, 0.12, 0.08)), ("frame", (0.8, 0.8, 0.8))):
        w.bsdf(ident, "diffuse", reflectance=colour)
    w.room((8, 3, 6), "floor", "wall", "wall", open_walls=("z0",))
    w.blank("The wall with five windows, each of six panes.")
    w.box((0, 0, -0.1), (8, 0.9, 0), "wall")
    w.box((0, 2.5, -0.1), (8, 3, 0), "wall")
    ends = [0.0] + [x for k in range(5) for x in (0.4 + 1.5 * k, 1.6 + 1.5 * k)] + [8.0]
    for k in range(0, len(ends), 2):
        w.box((ends[k], 0.9, -0.1), (ends[k + 1], 2.5, 0), "wall")
    for k in range(5):
        left, right = 0.4 + 1.5 * k, 1.6 + 1.5 * k
        for x in (left + 0.4, left + 0.8):
            w.box((x - 0.02, 0.9, -0.06), (x + 0.02, 2.5, -0.03), "frame")
        w.box((left, 1.68, -0.06), (right, 1.72, -0.03), "frame")
    w.object("emitter", "constant", radiance=(3.2, 3.7, 4.5))
    w.blank("The board, and nine desks with chairs.")
    w.box((0, 0.9, 1.5), (0.04, 2.1, 4.5), "board")
    for i in range(3):
        for j in range(3):
            x, z = 2.0 + 1.8 * i, 1.1 + 1.7 * j
            table(w, (x, z), (0.6, 1.2), 0.72, "desk", "frame")
            w.box((x + 0.45, 0.42, z - 0.2), (x + 0.85, 0.46, z + 0.2), "seat")
            w.box((x + 0.81, 0.46, z - 0.2), (x + 0.85, 0.9, z + 0.2), "seat")
            for dx in (0.46, 0.82):
                w.box((x + dx, 0, z - 0.18), (x + dx + 0.02, 0.42, z + 0.18), "frame")
    w.save(HERE / "classroom.xml")


def staircase():
    w = writer("A long staircase between two walls, seen from below, with a window at its upper end and a small lamp about the\n"
               "     corner: light that arrives after many bounces.")
    w.camera((0.9, 1.5, 1.6), (0.75, 2.6, -4), 58, width=256, height=384)
    for ident, colour in (("wall", (0.8, 0.77, 0.7)), ("skirt", (0.35, 0.16, 0.12))):
        w.bsdf(ident, "diffuse", reflectance=colour)
    rough_plastic(w, "step", (0.4, 0.25, 0.14), 0.2)
    metal(w, "rail", "Cr", 0.1)
    steps, rise, run, width = 22, 0.17, 0.28, 1.5
    top, back = steps * rise, -steps * run
    w.blank("Steps and landings.")
    for k in range(steps):
        w.box((0, 0, back - 2 if k == steps - 1 else -(k + 1) * run), (width, (k + 1) * rise, -k * run), "step")
    w.box((-2.1, -0.1, 0), (width, 0, 2), "step")
    w.blank("Walls and ceiling; the window is above the upper landing.")
    w.box((-0.1, 0, back - 2), (0, top + 2.6, 0), "wall")
    w.box((width, 0, back - 2), (width + 0.1, top + 2.6, 2), "wall")
    w.box((-2.1, 0, 2), (width + 0.1, top + 2.6, 2.1), "wall")
    w.box((-2.2, 0, 0), (-2.1, top + 2.6, 2.1), "wall")
    w.box((-2.1, 0, -0.1), (0, top + 2.6, 0), "wall")
    w.box((-2.2, top + 2.6, back - 2.1), (width + 0.1, top + 2.7, 2.1), "wall")
    w.box((0, 0, back - 2.1), (width, top + 0.9, back - 2), "wall")
    w.box((0, top + 2.1, back - 2.1), (width, top + 2.6, back - 2), "wall")
    w.box((0, top + 0.9, back - 2.1), (0.25, top + 2.1, back - 2), "wall")
    w.box((width - 0.25, top + 0.9, back - 2.1), (width, top + 2.1, back - 2), "wall")
    w.object("emitter", "constant", radiance=(6, 7, 8.5))
    w.blank("A rail, and a lamp in the hall below, out of sight.")
    for x in (0.06, width - 0.06):
        w.shape("cylinder", "rail", points={"p0": (x, 0.9, 0), "p1": (x, top + 0.9, back)}, radius=0.025)
    w.box((0, 0, -0.02), (0.02, 0.12, 0), "skirt")
    w.sphere((-1.4, 1.7, 1.0), 0.12, None, [area(w, (42, 28, 15))])
    w.save(HERE / "staircase.xml")


def plates():
    w = writer("Four plates of rising roughness, four lamps of falling size and equal power, after Veach 1997: each plate\n"
               "     mirrors each lamp, and only both samples of direct light together are good everywhere.")
    eye = (0, 2.2, 9)
    w.camera(eye, (0, 1.35, 0), 38, width=384, height=256)
    w.bsdf("matte", "diffuse", reflectance=(0.4, 0.4, 0.4))
    w.shape("rectangle", "matte", [scale((12, 8, 1)), '<rotate x="1" angle="-90"/>', translate((0, -0.2, 0))])
    w.shape("rectangle", "matte", [scale((12, 6, 1)), translate((0, 5.8, -3.5))])
    w.blank("Plates: each halves the angle between the camera and the row of lamps.")
    row = (0, 4.0, -1.5)
    for k, alpha in enumerate((0.01, 0.04, 0.1, 0.25)):
        metal(w, f"plate {k + 1}", "Cr", alpha)
        at = (0, 1.9 - 0.52 * k, -1.2 + 1.3 * k)

        def towards(p):
            d = [b - a for a, b in zip(at, p)]
            return [c / math.hypot(*d) for c in d]

        half = [a + b for a, b in zip(towards(eye), towards(row))]
        tilt = math.degrees(math.atan2(half[2], half[1]))
        w.shape("cube", f"plate {k + 1}", [scale((2.6, 0.02, 0.42)), f'<rotate x="1" angle="{number(tilt)}"/>',
                                           translate(at)])
    w.blank("Lamps of equal power: radiance times the square of the radius.")
    for k, radius in enumerate((0.45, 0.15, 0.05, 0.0166667)):
        radiance = 1.8 / (radius * radius)
        colour = ((1, 0.85, 0.6), (0.8, 1, 0.75), (0.65, 0.85, 1), (1, 0.7, 0.85))[k]
        w.shape("sphere", None, points={"center": (-2.4 + 1.6 * k, row[1], row[2])}, radius=radius,
                children=[area(w, tuple(radiance * c for c in colour))])
    w.save(HERE / "plates.xml")


def fixtures():
    w = writer("A closed room whose lamps stand in fixtures: small disks deep in tubes, and one behind a screen that shines at a\n"
               "     wall. Few points see a lamp; from the lamps all ways lead into the room.")
    w.camera((0.4, 1.5, 3.7), (3.0, 0.85, 1.0), 62, width=384, height=256)
    for ident, colour in (("white", (0.78, 0.76, 0.72)), ("wood", (0.4, 0.26, 0.15)), ("red", (0.5, 0.1, 0.07)),
                          ("black", (0.04, 0.04, 0.04))):
        w.bsdf(ident, "diffuse", reflectance=colour)
    w.bsdf("tube", "twosided", [lambda: w.object("bsdf", "diffuse", reflectance=(0.04, 0.04, 0.04))])
    metal(w, "steel", "Cr", 0.2)
    w.room((5, 2.7, 4), "wood", "white", "white")
    w.blank("Three tubes beneath the ceiling.")
    for x, z in ((1.6, 1.2), (2.9, 1.9), (3.9, 0.9)):
        w.shape("cylinder", "tube", points={"p0": (x, 2.35, z), "p1": (x, 2.7, z)}, radius=0.06)
        w.shape("disk", None, [scale((0.04, 0.04, 1)), '<rotate x="1" angle="90"/>', translate((x, 2.68, z))],
                [area(w, (1500, 1330, 1070))])
    w.blank("A lamp behind a screen.")
    w.box((4.55, 0.2, 2.3), (4.6, 1.4, 3.3), "black")
    w.shape("rectangle", None, [scale((0.05, 0.3, 1)), turn_y(90), translate((4.61, 0.8, 2.8))],
            [area(w, (150, 138, 115))])
    w.blank("What there is to see.")
    table(w, (2.9, 1.9), (1.3, 0.8), 0.72, "wood", "steel")
    w.sphere((2.7, 0.87, 1.8), 0.15, "steel")
    w.shape("obj", "white", [translate((3.25, 0.72, 2.05))], filename="meshes/vase.obj")
    w.box((1.2, 0, 0.1), (2.4, 0.85, 0.55), "red")
    w.sphere((1.7, 1.05, 0.32), 0.2, "white")
    w.box((3.5, 0, 0.2), (4.3, 1.1, 0.7), "white", turn=15)
    w.save(HERE / "fixtures.xml")


def make_meshes():
    folder = HERE / "meshes"
    write_torus(folder / "torus.obj", 0.28, 0.1, 48, 24, "A ring", SCRIPT)
    outer, inner, height, bottom, level = 0.04, 0.037, 0.12, 0.008, 0.085
    write_turned(folder / "glass.obj", [[(0.0, 0.0), (outer, 0.0)], [(outer, 0.0), (outer, height)],
                                        [(outer, height), (inner, height)], [(inner, height), (inner, level)]],
                 48, "A glass, where it meets air", SCRIPT)
    write_turned(folder / "glass-wet.obj", [[(inner, level), (inner, bottom)], [(inner, bottom), (0.0, bottom)]],
                 48, "A glass, where it meets water", SCRIPT)
    write_turned(folder / "water.obj", [[(inner, level), (0.0, level)]], 48, "Water in a glass", SCRIPT)


if __name__ == "__main__":
    make_meshes()
    glass_case()
    bulb()
    water()
    classroom()
    staircase()
    plates()
    fixtures()
