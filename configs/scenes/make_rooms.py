#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes glossy-room, mixed-room, matte-room, diffuse-room, caustic and features with the files they need, beside itself.

Python 3, standard library only. Lengths are in metres, y is up.
"""

import math
import pathlib

from scene_writer import Writer, number, scale, translate, turn_y, write_exr, write_lathe, write_png

HERE = pathlib.Path(__file__).resolve().parent


def table(w, center, size, height, top, legs):
    x, z = center
    a, b = size[0] / 2, size[1] / 2
    w.box((x - a, height - 0.04, z - b), (x + a, height, z + b), top)
    for sx in (-1, 1):
        for sz in (-1, 1):
            lx, lz = x + sx * (a - 0.06), z + sz * (b - 0.06)
            w.box((lx - 0.025, 0, lz - 0.025), (lx + 0.025, height - 0.04, lz + 0.025), legs)


def uplighter(w, center, height, material, radiance):
    """A bowl on a pole whose lamp shines at the ceiling and cannot be seen from below."""
    x, z = center
    w.box((x - 0.15, 0, z - 0.15), (x + 0.15, 0.03, z + 0.15), material)
    w.shape("cylinder", material, points={"p0": (x, 0.03, z), "p1": (x, height, z)}, radius=0.02)
    for low, high in (((-0.18, 0, -0.18), (0.18, 0.02, 0.18)), ((-0.2, 0, -0.2), (-0.18, 0.12, 0.2)),
                      ((0.18, 0, -0.2), (0.2, 0.12, 0.2)), ((-0.18, 0, -0.2), (0.18, 0.12, -0.18)),
                      ((-0.18, 0, 0.18), (0.18, 0.12, 0.2))):
        at = (x, height, z)
        w.box([a + b for a, b in zip(low, at)], [a + b for a, b in zip(high, at)], material)
    w.panel((x, height + 0.05, z), 0.15, 0.15, False, None, radiance)


def metal(w, ident, name, alpha, distribution="ggx"):
    w.bsdf(ident, "roughconductor", material=name, distribution=distribution, alpha=float(alpha))


def rough_plastic(w, ident, colour, alpha):
    w.bsdf(ident, "roughplastic", distribution="ggx", alpha=float(alpha), diffuseReflectance=colour)


def glossy_room():
    w = Writer("0.6.0", "Everything glossy, and all light indirect: a lamp that shines at the ceiling of a room of rough\n"
               "     metal and plastic. Radiance that depends on the direction one looks from is the hard case of guiding.")
    w.camera((0.5, 1.55, 3.7), (3.2, 0.75, 1.0), 62, width=384, height=256)
    w.bsdf("ceiling", "diffuse", reflectance=(0.85, 0.83, 0.8))
    rough_plastic(w, "walls", (0.5, 0.47, 0.42), 0.3)
    rough_plastic(w, "floor", (0.24, 0.12, 0.06), 0.12)
    rough_plastic(w, "lacquer", (0.45, 0.03, 0.03), 0.08)
    rough_plastic(w, "night blue", (0.03, 0.06, 0.22), 0.15)
    metal(w, "steel", "Cr", 0.15)
    metal(w, "aluminium", "Al", 0.08)
    metal(w, "gold", "Au", 0.2)
    metal(w, "copper", "Cu", 0.12, "beckmann")
    metal(w, "dark steel", "W", 0.3)
    w.room((5, 2.7, 4), "floor", "walls", "ceiling")
    w.blank("A sideboard at the back wall, and what stands on it.")
    w.box((1.4, 0.08, 0.05), (3.4, 0.8, 0.5), "lacquer")
    w.box((1.42, 0, 0.1), (3.38, 0.08, 0.45), "dark steel")
    for x in (2.06, 2.72):
        w.box((x - 0.005, 0.1, 0.5), (x + 0.005, 0.78, 0.51), "steel")
    w.sphere((1.75, 0.98, 0.28), 0.18, "gold")
    w.sphere((2.2, 0.92, 0.3), 0.12, "copper")
    w.shape("obj", "aluminium", [translate((2.95, 0.8, 0.28))], filename="meshes/vase.obj")
    w.blank("A picture of brushed metal, a table, a chest, a screen.")
    w.box((1.7, 1.3, 0), (3.1, 2.1, 0.03), "copper")
    table(w, (3.0, 1.9), (1.3, 0.8), 0.72, "aluminium", "dark steel")
    w.sphere((2.75, 0.87, 1.8), 0.15, "night blue")
    w.sphere((3.2, 0.8, 2.05), 0.08, "gold")
    w.sphere((3.35, 0.82, 1.75), 0.1, "lacquer")
    w.box((4.3, 0, 1.3), (4.85, 0.55, 2.1), "night blue", turn=8)
    w.box((4.92, 0.4, 2.3), (4.97, 1.9, 3.6), "steel")
    w.box((0.3, 0, 0.5), (0.9, 1.6, 0.56), "aluminium", turn=35)
    w.blank("The only light.")
    uplighter(w, (4.4, 0.6), 1.75, "dark steel", (210, 185, 148))
    w.save(HERE / "glossy-room.xml")


def diffuse_room():
    w = Writer("0.6.0", "Diffuse surfaces only, lit by a lamp that shines at the ceiling and by a slit of sky between two\n"
               "     curtains: what guiding by incident radiance alone is made for.")
    w.camera((0.45, 1.5, 3.6), (3.0, 0.8, 0.9), 64, width=384, height=256)
    for ident, colour in (("white", (0.8, 0.78, 0.75)), ("plaster", (0.7, 0.62, 0.5)), ("wood", (0.36, 0.22, 0.12)),
                          ("red cloth", (0.5, 0.07, 0.05)), ("green", (0.2, 0.4, 0.18)), ("grey", (0.35, 0.35, 0.37))):
        w.bsdf(ident, "diffuse", reflectance=colour)
    w.room((5, 2.7, 4), "wood", "plaster", "white", open_walls=("x1",))
    w.blank("The wall with the window: 1.2 wide, 1.4 high; the curtains leave a slit.")
    w.box((5, 0, -0.1), (5.1, 0.8, 4.1), "plaster")
    w.box((5, 2.2, -0.1), (5.1, 2.7, 4.1), "plaster")
    w.box((5, 0.8, -0.1), (5.1, 2.2, 1.4), "plaster")
    w.box((5, 0.8, 2.6), (5.1, 2.2, 4.1), "plaster")
    w.box((4.93, 0.6, 1.25), (4.95, 2.3, 1.93), "red cloth")
    w.box((4.93, 0.6, 2.02), (4.95, 2.3, 2.75), "red cloth")
    w.object("emitter", "constant", radiance=(5, 7, 10))
    w.blank("A bed, a table, a shelf.")
    w.box((2.6, 0, 0.1), (4.7, 0.4, 1.3), "white")
    w.box((4.4, 0.4, 0.15), (4.7, 0.6, 1.25), "red cloth")
    table(w, (2.2, 2.5), (1.0, 0.7), 0.72, "wood", "grey")
    w.sphere((2.1, 0.84, 2.5), 0.12, "green")
    w.shape("obj", "white", [translate((2.45, 0.72, 2.4))], filename="meshes/vase.obj")
    w.box((0.6, 0, 0.02), (2.0, 2.0, 0.06), "grey")
    for y in (0.3, 0.9, 1.5, 2.0):
        w.box((0.6, y - 0.03, 0.06), (2.0, y, 0.4), "wood")
    for k in range(11):
        x, tall = 0.66 + 0.1 * k, 0.3 + 0.12 * math.sin(7 * k) ** 2
        w.box((x, 0.9, 0.1), (x + 0.07, 0.9 + tall, 0.34), ("red cloth", "green", "white", "grey")[k % 4])
    uplighter(w, (2.3, 0.35), 1.7, "grey", (150, 125, 90))
    w.save(HERE / "diffuse-room.xml")


def mixed_room():
    furnished_room("mixed-room", "Diffuse, rough, mirroring and transparent things together; light of a sky through a glazed window, and\n"
                   "     of a lamp in a shade.", lambda w: rough_plastic(w, "parquet", (0.33, 0.19, 0.1), 0.2))


def matte_room():
    furnished_room("matte-room", "The mixed room with a matte floor: large diffuse surfaces and smaller glossy things, as in the mixed scene\n"
                   "     of Cavus 2020.", lambda w: w.bsdf("parquet", "diffuse", reflectance=(0.33, 0.19, 0.1)))


def furnished_room(name, comment, add_floor):
    w = Writer("3.0.0", comment)
    w.camera((0.4, 1.5, 3.75), (3.1, 0.85, 0.9), 62, width=384, height=256)
    for ident, colour in (("white", (0.8, 0.79, 0.77)), ("ochre", (0.62, 0.45, 0.22)), ("cloth", (0.15, 0.25, 0.4))):
        w.bsdf(ident, "diffuse", reflectance=colour)
    add_floor(w)
    w.bsdf("china", "plastic", diffuseReflectance=(0.75, 0.75, 0.8), nonlinear=True)
    w.bsdf("mirror", "conductor", material="none")
    metal(w, "brass", "Au", 0.15)
    metal(w, "steel", "Cr", 0.25)
    w.bsdf("pane", "thindielectric")
    w.bsdf("glass", "dielectric", intIOR="bk7", extIOR="air")
    w.bsdf("frosted", "roughdielectric", distribution="ggx", alpha=0.15)
    w.room((5, 2.7, 4), "parquet", "white", "white", open_walls=("x1",))
    w.blank("The wall with the window, and its pane.")
    w.box((5, 0, -0.1), (5.1, 0.7, 4.1), "white")
    w.box((5, 2.3, -0.1), (5.1, 2.7, 4.1), "white")
    w.box((5, 0.7, -0.1), (5.1, 2.3, 1.3), "white")
    w.box((5, 0.7, 2.9), (5.1, 2.3, 4.1), "white")
    w.shape("rectangle", "pane", [scale((0.8, 0.8, 1)), turn_y(-90), translate((5.05, 1.5, 2.1))])
    w.object("emitter", "constant", radiance=(4.5, 5.8, 7.8))
    w.blank("A commode with a mirror over it.")
    w.box((1.5, 0, 0.05), (3.3, 0.8, 0.5), "ochre")
    w.box((1.7, 1.1, 0), (3.1, 2.1, 0.04), "brass")
    w.shape("rectangle", "mirror", [scale((0.65, 0.45, 1)), translate((2.4, 1.6, 0.045))])
    w.sphere((1.8, 0.95, 0.28), 0.15, "china")
    w.shape("obj", "brass", [translate((2.95, 0.8, 0.28))], filename="meshes/vase.obj")
    w.blank("A table with glass on it.")
    table(w, (3.1, 1.9), (1.3, 0.8), 0.72, "china", "steel")
    w.sphere((2.8, 0.87, 1.8), 0.15, "glass")
    w.sphere((3.3, 0.83, 2.0), 0.11, "frosted")
    w.shape("obj", "glass", [scale((0.5, 0.5, 0.5)), translate((3.05, 0.72, 2.12))], filename="meshes/drop.obj")
    w.box((4.1, 0, 0.3), (4.85, 0.45, 1.2), "cloth", turn=-12)
    w.blank("A lamp whose shade lets light out above and below.")
    w.shape("cylinder", "steel", points={"p0": (0.75, 0, 0.6), "p1": (0.75, 1.5, 0.6)}, radius=0.02)
    w.bsdf("shade", "twosided", [lambda: w.object("bsdf", "diffuse", reflectance=(0.7, 0.55, 0.35))])
    w.shape("cylinder", "shade", points={"p0": (0.75, 1.5, 0.6), "p1": (0.75, 1.85, 0.6)}, radius=0.2)
    w.shape("sphere", None, points={"center": (0.75, 1.67, 0.6)}, radius=0.15,
            children=[lambda: w.object("emitter", "area", radiance=(15, 11, 6.6))])
    w.save(HERE / f"{name}.xml")


def caustic():
    w = Writer("3.0.0", "Glass and metal that focus a small lamp on a table: light that next event cannot find, and guiding can.")
    w.camera((0.1, 1.15, 1.75), (0.1, 0.08, 0.02), 46, width=384, height=256)
    w.bsdf("table", "diffuse", reflectance=(0.72, 0.68, 0.62))
    w.bsdf("wall", "diffuse", reflectance=(0.35, 0.4, 0.46))
    w.bsdf("glass", "dielectric", intIOR=1.5, extIOR=1.0)
    w.bsdf("frosted", "roughdielectric", distribution="ggx", alpha=0.05, intIOR=1.5, extIOR=1.0)
    w.bsdf("ring", "twosided", [lambda: w.object("bsdf", "roughconductor", material="Au", distribution="ggx",
                                                 alpha=0.03)])
    w.bsdf("silver", "conductor", material="Ag")
    w.shape("rectangle", "table", [scale((3, 3, 1)), '<rotate x="1" angle="-90"/>'])
    w.shape("rectangle", "wall", [scale((3, 2, 1)), translate((0, 1, -1.2))])
    w.sphere((-0.42, 0.2, 0.05), 0.2, "glass")
    w.shape("cylinder", "ring", points={"p0": (0.12, 0.001, 0.18), "p1": (0.12, 0.14, 0.18)}, radius=0.2)
    w.shape("obj", "glass", [translate((0.5, 0.001, -0.1))], filename="meshes/drop.obj")
    w.sphere((0.02, 0.16, -0.35), 0.16, "frosted")
    w.sphere((-0.1, 0.07, 0.42), 0.07, "silver")
    w.blank("The lamp, high to the left.")
    w.shape("disk", None, [scale((0.25, 0.25, 1)),
                           '<lookat origin="-1.1, 1.7, 0.7" target="0, 0.1, 0" up="0, 1, 0"/>'],
            [lambda: w.object("emitter", "area", radiance=(34, 32, 29))])
    w.save(HERE / "caustic.xml")


def make_images():
    folder = HERE / "textures"
    folder.mkdir(exist_ok=True)

    def tile(x, y):
        inner = 3 <= x % 32 < 31 and 3 <= y % 32 < 31
        shade = 20 * ((x // 32 * 7 + y // 32 * 13) % 3)
        return (170 - shade, 90 - shade // 2, 60) if inner else (190, 185, 175)

    write_png(folder / "tiles.png", [[tile(x, y) for x in range(64)] for y in range(64)])

    def leaf(x, y):
        u, v = (x + 0.5) / 32 - 1, (y + 0.5) / 32 - 1
        width = 0.55 * (1 - v * v) * (0.85 + 0.15 * math.cos(14 * v))
        return 255 if abs(u) < width else 0

    write_png(folder / "leaf.png", [[leaf(x, y) for x in range(64)] for y in range(64)])

    def wave(x, y):
        return int(127.5 + 127.4 * math.sin(2 * math.pi * x / 32) * math.sin(2 * math.pi * y / 32))

    write_png(folder / "waves.png", [[wave(x, y) for x in range(64)] for y in range(64)])

    def studs(x, y):
        u, v = (x % 16 + 0.5) / 8 - 1, (y % 16 + 0.5) / 8 - 1
        r = math.hypot(u, v)
        n = (u, -v, math.sqrt(1 - r * r)) if r < 0.8 else (0, 0, 1)
        return tuple(int(127.5 * c + 128) if c < 1 else 255 for c in n)

    write_png(folder / "studs.png", [[studs(x, y) for x in range(64)] for y in range(64)])

    def sky(x, y):
        u, v = (x + 0.5) / 64, (y + 0.5) / 32
        up = math.cos(math.pi * v)
        if up < 0:
            return (0.12, 0.1, 0.08)
        sun = math.exp(-120 * ((u - 0.3) ** 2 + (v - 0.3) ** 2))
        return (0.35 + 0.2 * (1 - up) + 40 * sun, 0.5 + 0.1 * (1 - up) + 34 * sun, 0.8 + 24 * sun)

    write_exr(folder / "sky.exr", [[sky(x, y) for x in range(64)] for y in range(32)])


def features():
    w = Writer("0.6.0", "A row of samples: one of each feature that the rooms leave out.")
    w.camera((0, 1.6, 4.4), (0, 0.55, 0), 48, "thinlens", width=384, height=256, apertureRadius=0.03,
             focusDistance=4.5)

    def bitmap(file, **values):
        return lambda name=None: w.object("texture", "bitmap", filename=f"textures/{file}", **values) if not name \
            else (w.open("texture", type="bitmap", name=w.name(name)), w.put(filename=f"textures/{file}", **values),
                  w.close("texture"))

    def checkerboard(name):
        w.open("texture", type="checkerboard", name=w.name(name))
        w.put(color0=(0.5, 0.5, 0.48), color1=(0.12, 0.13, 0.15), uscale=8.0, vscale=8.0)
        w.close("texture")

    def diffuse(**values):
        return lambda: w.object("bsdf", "diffuse", **values)

    w.bsdf("floor", "diffuse", reflectance=checkerboard)
    w.bsdf("tiles", "diffuse", reflectance=bitmap("tiles.png", uscale=2.0, vscale=2.0))
    w.bsdf("leaf", "mask", [lambda: w.object("bsdf", "twosided", [diffuse(reflectance=(0.15, 0.4, 0.08))])],
           opacity=bitmap("leaf.png", gamma=1.0))
    w.bsdf("waves", "bumpmap", [lambda: (w.open("texture", type="scale"), w.put(scale=0.02),
                                         bitmap("waves.png", gamma=1.0, uscale=4.0, vscale=4.0)(), w.close("texture")),
                                lambda: w.object("bsdf", "roughplastic", alpha=0.1, diffuseReflectance=(0.1, 0.2, 0.5))])
    w.bsdf("studs", "normalmap", [bitmap("studs.png", gamma=1.0), diffuse(reflectance=(0.6, 0.55, 0.5))])
    w.bsdf("brushed", "roughconductor", material="Al", distribution="ggx", alphaU=0.05, alphaV=0.3)
    w.bsdf("flaked", "blendbsdf", [diffuse(reflectance=(0.5, 0.05, 0.03)),
                                   lambda: w.object("bsdf", "roughconductor", material="Cu", alpha=0.2)],
           weight=bitmap("tiles.png", gamma=1.0))
    w.bsdf("nothing", "null")
    w.bsdf("half seen", "mask", [diffuse(reflectance=(0.7, 0.6, 0.1))], opacity=0.5)
    w.bsdf("white", "diffuse", reflectance=(0.7, 0.7, 0.7))
    w.bsdf("two faces", "twosided", [diffuse(reflectance=(0.6, 0.1, 0.5)), diffuse(reflectance=(0.1, 0.5, 0.6))])

    w.blank("The floor, and the row from left to right.")
    w.shape("rectangle", "floor", [scale((4, 4, 1)), '<rotate x="1" angle="-90"/>'])
    w.box((-1.95, 0, -0.25), (-1.45, 0.5, 0.25), "tiles", turn=25)
    w.shape("rectangle", "leaf", [scale((0.35, 0.45, 1)), turn_y(15), translate((-1.15, 0.5, 0.2))])
    w.sphere((-0.55, 0.35, -0.1), 0.35, "waves")
    w.box((0.0, 0, -0.2), (0.45, 0.55, 0.25), "studs", turn=-20)
    w.shape("cylinder", "brushed", points={"p0": (0.85, 0.001, 0), "p1": (0.85, 0.7, 0)}, radius=0.22)
    w.shape("disk", "white", [scale((0.22, 0.22, 1)), '<rotate x="1" angle="-90"/>', translate((0.85, 0.7, 0))])
    w.sphere((1.5, 0.3, 0), 0.3, "flaked")
    w.sphere((-0.3, 0.2, 0.9), 0.2, "half seen")
    w.sphere((0.5, 0.25, 1.0), 0.25, "nothing")
    w.shape("disk", "two faces", [scale((0.25, 0.25, 1)), turn_y(30), translate((1.35, 0.3, 0.85))])
    w.shape("disk", "two faces", [scale((0.25, 0.25, 1)), turn_y(210), translate((1.9, 0.3, 0.6))])

    w.blank("A group of two shapes, placed five times.")
    w.object("shape", "shapegroup", [
        lambda: w.sphere((0, 0.12, 0), 0.12, "white"),
        lambda: w.box((-0.05, 0.2, -0.05), (0.05, 0.5, 0.05), "tiles")], ident="pawn")
    for k in range(5):
        w.object("shape", "instance", [w.ref("pawn")],
                 [scale((1, 1 + 0.2 * k, 1)), turn_y(15 * k), translate((-1.6 + 0.8 * k, 0, -1.2))])

    w.blank("Light of every kind.")
    w.object("emitter", "envmap", filename="textures/sky.exr", scale=0.35)
    w.open("emitter", type="point")
    w.line('<point name="position" x="-2.2" y="1.4" z="1.2"/>')
    w.put(intensity=(1.6, 1.2, 0.7))
    w.close("emitter")
    w.object("emitter", "spot", transform=[
        '<lookAt origin="2.4, 2.4, 1.8" target="1.0, 0.2, 0" up="0, 1, 0"/>'], intensity=(9.0, 9.0, 12.0),
        cutoffAngle=14.0, beamWidth=9.0)
    w.open("emitter", type="directional")
    w.line('<vector name="direction" x="0.4" y="-1" z="-0.5"/>')
    w.put(irradiance=(0.5, 0.5, 0.45))
    w.close("emitter")
    w.open("shape", type="rectangle")
    w.transform([scale((0.9, 0.3, 1)), translate((0, 1.1, -1.9))])
    w.open("emitter", type="area")
    w.put(radiance=bitmap("tiles.png"))
    w.close("emitter")
    w.close("shape")
    w.save(HERE / "features.xml")


def make_meshes():
    folder = HERE / "meshes"
    folder.mkdir(exist_ok=True)
    vase = [(0.0, 0.0), (0.06, 0.0), (0.075, 0.02)]
    vase += [(0.075 + 0.055 * math.sin(math.pi * t / 8), 0.02 + 0.2 * t / 8) for t in range(1, 8)]
    vase += [(0.05, 0.26), (0.045, 0.3), (0.07, 0.36), (0.06, 0.36), (0.035, 0.3), (0.0, 0.28)]
    write_lathe(folder / "vase.obj", vase, 24, "A vase")
    drop = [(0.0, 0.0)]
    for t in range(1, 16):
        angle = math.pi * t / 16
        drop.append((0.16 * math.sin(angle) * (math.sin(angle / 2 + math.pi / 2) ** 0.7 + 0.12),
                     0.22 - 0.22 * math.cos(angle)))
    drop.append((0.0, 0.44))
    write_lathe(folder / "drop.obj", drop, 32, "A drop")


if __name__ == "__main__":
    make_meshes()
    make_images()
    glossy_room()
    diffuse_room()
    mixed_room()
    matte_room()
    caustic()
    features()
