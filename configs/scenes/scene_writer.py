# SPDX-License-Identifier: Apache-2.0
"""Writes Mitsuba XML in the dialect of 0.6 or of 3, and the small files beside it. Python's standard library only."""

import math
import re
import struct
import zlib


def number(value):
    text = f"{value:.6g}"
    return "0" if text == "-0" else text


def numbers(values):
    return ", ".join(number(v) for v in values)


class Writer:
    """Names are given as 0.6 spells them; version 3 gets them in snake case."""

    RENAMED = {"fovAxis": "fov_axis", "toWorld": "to_world", "intIOR": "int_ior", "extIOR": "ext_ior"}

    def __init__(self, version, comment, script="make_rooms.py"):
        self.version = version
        self.lines = ['<?xml version="1.0" encoding="utf-8"?>', "<!-- SPDX-License-Identifier: Apache-2.0 -->", f"<!-- {comment}",
                      f"     Written by {script}: change it there. -->", f'<scene version="{version}">']
        self.depth = 1

    def name(self, name):
        if self.version.startswith("0"):
            return name
        return self.RENAMED.get(name) or re.sub(r"(?<=[a-z])([A-Z])", lambda m: "_" + m.group(1).lower(), name)

    def line(self, text):
        self.lines.append("    " * self.depth + text)

    def blank(self, comment=""):
        self.lines.append("")
        if comment:
            self.line(f"<!-- {comment} -->")

    def open(self, tag, **attributes):
        self.line(f"<{tag}" + "".join(f' {k}="{v}"' for k, v in attributes.items()) + ">")
        self.depth += 1
        return self

    def close(self, tag):
        self.depth -= 1
        self.line(f"</{tag}>")

    def value(self, kind, name, value):
        self.line(f'<{kind} name="{self.name(name)}" value="{value}"/>')

    def default(self, name, value):
        self.line(f'<default name="{name}" value="{value}"/>')

    def put(self, **values):
        """float, integer, bool, string and rgb by the type of the value; a function writes a child."""
        for name, value in values.items():
            if callable(value):
                value(name)
            elif isinstance(value, bool):
                self.value("boolean", name, str(value).lower())
            elif isinstance(value, str):
                self.value("string", name, value)
            elif isinstance(value, (tuple, list)):
                self.value("rgb", name, numbers(value))
            elif isinstance(value, int):
                self.value("integer", name, value)
            else:
                self.value("float", name, number(value))

    def object(self, tag, kind, children=(), transform=(), ident=None, **values):
        attributes = {"type": kind}
        if ident:
            attributes["id"] = ident
        self.open(tag, **attributes)
        self.put(**values)
        if transform:
            self.transform(transform)
        for child in children:
            child()
        self.close(tag)

    def transform(self, steps, name="toWorld"):
        self.open("transform", name=self.name(name))
        for step in steps:
            self.line(step)
        self.close("transform")

    def ref(self, ident):
        return lambda: self.line(f'<ref id="{ident}"/>')

    def bsdf(self, ident, kind, children=(), **values):
        self.object("bsdf", kind, children, ident=ident, **values)

    def shape(self, kind, material, transform=(), children=(), ident=None, points=None, **values):
        extra = []
        for name, at in (points or {}).items():
            x, y, z = (number(v) for v in at)
            extra.append(lambda name=name, x=x, y=y, z=z: self.line(
                f'<point name="{self.name(name)}" x="{x}" y="{y}" z="{z}"/>'))
        if material:
            extra.append(self.ref(material))
        self.object("shape", kind, extra + list(children), transform, ident, **values)

    def box(self, low, high, material, turn=0.0, ident=None):
        """An axis-aligned box, then turned about the vertical through its centre."""
        half = [(h - l) / 2 for l, h in zip(low, high)]
        center = [(h + l) / 2 for l, h in zip(low, high)]
        self.shape("cube", material, [scale(half)] + ([turn_y(turn)] if turn else []) + [translate(center)], ident=ident)

    def sphere(self, center, radius, material, children=()):
        self.shape("sphere", material, points={"center": center}, radius=float(radius), children=children)

    def panel(self, center, half_x, half_z, down, material=None, radiance=None):
        """A horizontal rectangle that looks down or up; with a radiance it is a lamp."""
        steps = [scale((half_x, half_z, 1)), f'<rotate x="1" angle="{90 if down else -90}"/>', translate(center)]
        lamp = [lambda: self.object("emitter", "area", radiance=radiance)] if radiance else []
        self.shape("rectangle", material, steps, lamp)

    def camera(self, origin, target, fov, kind="perspective", width=320, height=240, spp=256, **values):
        for name, value in (("width", width), ("height", height), ("spp", spp)):
            self.default(name, value)
        self.blank()
        self.open("sensor", type=kind)
        self.put(fov=float(fov), fovAxis="x", **values)
        self.transform([f'<lookAt origin="{numbers(origin)}" target="{numbers(target)}" up="0, 1, 0"/>'
                        if self.version.startswith("0") else
                        f'<lookat origin="{numbers(origin)}" target="{numbers(target)}" up="0, 1, 0"/>'])
        self.open("film", type="hdrfilm")
        for name in ("width", "height"):
            self.line(f'<integer name="{name}" value="${name}"/>')
        self.line('<rfilter type="box"/>')
        self.close("film")
        self.open("sampler", type="independent")
        self.line(f'<integer name="{self.name("sampleCount")}" value="$spp"/>')
        self.close("sampler")
        self.close("sensor")
        self.blank()

    def room(self, size, floor, walls, ceiling, thick=0.1, open_walls=()):
        """Walls as boxes around [0, size]; those named in open_walls (x0, x1, z0, z1) are left out."""
        w, h, d = size
        t = thick
        self.blank("The room.")
        self.box((-t, -t, -t), (w + t, 0, d + t), floor)
        self.box((-t, h, -t), (w + t, h + t, d + t), ceiling)
        sides = {"x0": ((-t, 0, -t), (0, h, d + t)), "x1": ((w, 0, -t), (w + t, h, d + t)),
                 "z0": ((0, 0, -t), (w, h, 0)), "z1": ((0, 0, d), (w, h, d + t))}
        for side, (low, high) in sides.items():
            if side not in open_walls:
                self.box(low, high, walls)

    def save(self, path):
        path.write_text("\n".join(self.lines + ["</scene>"]) + "\n")


def scale(s):
    x, y, z = (number(v) for v in s)
    return f'<scale x="{x}" y="{y}" z="{z}"/>'


def translate(t):
    x, y, z = (number(v) for v in t)
    return f'<translate x="{x}" y="{y}" z="{z}"/>'


def turn_y(angle):
    return f'<rotate y="1" angle="{number(angle)}"/>'


def write_png(path, pixels):
    """8 bits; rows of grey values or of (r, g, b)."""
    height, width = len(pixels), len(pixels[0])
    grey = isinstance(pixels[0][0], int)
    rows = b"".join(b"\0" + (bytes(row) if grey else bytes(c for pixel in row for c in pixel)) for row in pixels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 0 if grey else 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) +
                     chunk(b"IEND", b""))


def write_exr(path, pixels):
    """Rows of (r, g, b) as half floats in uncompressed scan lines (OpenEXR file layout, openexr.com)."""
    height, width = len(pixels), len(pixels[0])

    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    half = 1
    channels = b"".join(name + b"\0" + struct.pack("<iiii", half, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + b"".join([
        attribute("channels", "chlist", channels), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1))]) + b"\0"
    line_bytes = 3 * 2 * width
    first = len(header) + 8 * height
    table = b"".join(struct.pack("<Q", first + y * (8 + line_bytes)) for y in range(height))
    body = b""
    for y, row in enumerate(pixels):
        body += struct.pack("<ii", y, line_bytes)
        for channel in (2, 1, 0):
            body += struct.pack(f"<{width}e", *(pixel[channel] for pixel in row))
    path.write_bytes(header + table + body)


def write_lathe(path, profile, segments, what, script="make_rooms.py"):
    """An OBJ mesh: (radius, height) turned about the y axis, smooth, fronts outside where the profile runs upwards."""
    write_turned(path, [profile], segments, what, script)


def write_turned(path, profiles, segments, what, script):
    """Several profiles in one mesh, each smooth in itself: an edge is where one ends and the next begins."""
    lines = [f"# {what}, written by {script}"]
    angles = [2 * math.pi * k / segments for k in range(segments)]
    for profile in profiles:
        for angle in angles:
            for radius, height in profile:
                lines.append(f"v {radius * math.cos(angle):.4f} {height:.4f} {radius * math.sin(angle):.4f}")
    for profile in profiles:
        for angle in angles:
            for i in range(len(profile)):
                (r0, h0), (r1, h1) = profile[max(i - 1, 0)], profile[min(i + 1, len(profile) - 1)]
                nr, ny = h1 - h0, r0 - r1
                length = math.hypot(nr, ny)
                lines.append(
                    f"vn {nr / length * math.cos(angle):.4f} {ny / length:.4f} {nr / length * math.sin(angle):.4f}")
    first = 1
    for profile in profiles:
        count = len(profile)
        for k in range(segments):
            for i in range(count - 1):
                a, b = first + k * count + i, first + (k + 1) % segments * count + i
                corners = [(a, a + 1, b + 1), (a, b + 1, b)]
                for corner in corners:
                    radii = [profile[(c - first) % count][0] for c in corner]
                    if sum(r == 0 for r in radii) < 2:  # none without area at the poles
                        lines.append("f " + " ".join(f"{c}//{c}" for c in corner))
        first += segments * count
    path.write_text("\n".join(lines) + "\n")


def write_torus(path, radius, thickness, around, across, what, script):
    """An OBJ mesh about the z axis, smooth: `around` by `across` quadrangles."""
    lines = [f"# {what}, written by {script}"]
    angles = [(2 * math.pi * i / around, 2 * math.pi * j / across) for i in range(around) for j in range(across)]
    for u, v in angles:
        r = radius + thickness * math.cos(v)
        lines.append(f"v {r * math.cos(u):.4f} {r * math.sin(u):.4f} {thickness * math.sin(v):.4f}")
    for u, v in angles:
        lines.append(f"vn {math.cos(v) * math.cos(u):.4f} {math.cos(v) * math.sin(u):.4f} {math.sin(v):.4f}")
    for i in range(around):
        for j in range(across):
            a, b = i * across, (i + 1) % around * across
            c, d = j + 1, (j + 1) % across + 1
            lines += ["f " + " ".join(f"{k}//{k}" for k in corner)
                      for corner in ((a + c, b + c, b + d), (a + c, b + d, a + d))]
    path.write_text("\n".join(lines) + "\n")


def write_grid(path, point, columns, rows, what, script):
    """An OBJ mesh, smooth: point(u, v) for u and v from 0 to 1. What meets itself (u = 0 and 1, poles) stays a seam without a gap."""
    at = [[tuple(f"{x:.4f}" for x in point(i / columns, j / rows)) for i in range(columns + 1)] for j in range(rows + 1)]

    def normal(i, j):
        u, v, step = i / columns, j / rows, 1e-4
        v = min(max(v, 1e-3), 1 - 1e-3)  # beside a pole
        a, b, c, d = point(u - step, v), point(u + step, v), point(u, v - step), point(u, v + step)
        s, t = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(c, d)]
        n = (t[1] * s[2] - t[2] * s[1], t[2] * s[0] - t[0] * s[2], t[0] * s[1] - t[1] * s[0])
        length = math.hypot(*n) or 1.0
        return [x / length for x in n]

    def area(corners):
        p, q, r = ([float(x) for x in at[(k - 1) // (columns + 1)][(k - 1) % (columns + 1)]] for k in corners)
        s, t = [b - a for a, b in zip(p, q)], [b - a for a, b in zip(p, r)]
        return math.hypot(s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]) / 2

    lines = [f"# {what}, written by {script}"]
    lines += [f"v {x} {y} {z}" for row in at for x, y, z in row]
    lines += ["vn {:.3f} {:.3f} {:.3f}".format(*normal(i, j)) for j in range(rows + 1) for i in range(columns + 1)]
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i + 1
            b = a + columns + 1
            lines += ["f " + " ".join(f"{k}//{k}" for k in corners) for corners in ((a, b, b + 1), (a, b + 1, a + 1))
                      if area(corners) > 1e-9]  # none at poles
    path.write_text("\n".join(lines) + "\n")
