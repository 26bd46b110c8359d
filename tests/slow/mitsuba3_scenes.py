#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders Mitsuba 3's own test scenes and compares the images with the means and variances that Mitsuba stored.

usage: mitsuba3_scenes.py TREEFARM [MITSUBA_DATA] [--only TEXT] [--samples N] [--block N] [--set KEY=VALUE] [--keep DIR]

MITSUBA_DATA is a checkout of github.com/mitsuba-renderer/mitsuba-data (Mitsuba 3's resources/data), by default the
environment variable of that name. Takes every scene of tests/scenes that has a reference of the rgb variants, and prints
a line of a Markdown table for each. Exit code: 0 all that load agree or are explained, 1 some do not, 77 there is no
MITSUBA_DATA.

What the references are (mitsuba3: src/render/tests/test_renders.py, src/integrators/moment.cpp): means and variances per
sample of X, Y and Z, converted to R, G and B as if variances were colours, of 32000 samples per pixel. Hence all tests are
of X, Y and Z. The sums are of 32-bit floats: 32000 equal numbers are off by up to 4.7e-4.

Tests, each at |z| of the difference over its standard deviation:
- pixels: as Mitsuba's. At most 0.25 % of the values may be beyond the level 0.01 after Sidak's correction for the number
  of pixels. The variance is the larger one of ours and the reference's.
- blocks: the means of 8 x 8 pixels; their chi-square, and the worst of them, find a bias below the noise of single
  pixels. By the sum of both variances. Blocks that are black in both images do not count.
- total: the ratio of the means of Y.
A scene agrees if the pixels do and neither blocks (the smaller probability, after Bonferroni) nor total have a
probability below 1e-4. Where a difference is known and explained (EXPLAINED), the verdict says so, and it counts apart.
"""
import argparse
import glob
import math
import os
import shutil
import subprocess
import sys
import tempfile

from exr_reader import read

REFERENCE_SPP = 32000
REFERENCE_ROUNDING = 3e-4  # relative, common to all pixels: of sums of floats
LEAST_VARIANCE = 1e-4  # per sample, as Mitsuba's test has it
SIGNIFICANCE, ACCEPTED_SHARE, LEAST_PROBABILITY = 0.01, 0.9975, 1e-4
XYZ = ((0.412453, 0.357580, 0.180423), (0.212671, 0.715160, 0.072169), (0.019334, 0.119193, 0.950227))

OF_MASKS = "Mitsuba's path counts a mask's clear part as an edge, and its light samples end there"
OF_FILTER = "Mitsuba's default Gaussian is a table of 31 steps, looked up downwards: edges are 3 % wider"
EXPLAINED = {  # of mitsuba-data 01100fa
    "bsdf_spheres/test_constant_path": OF_MASKS,
    "bsdf_spheres/test_envmap_path": OF_MASKS,
    "projector/test_projector_constant_direct": OF_FILTER,
    "projector/test_projector_textured_direct": OF_FILTER,
    "participating_media/test_surf_area_light_volpath":
        "the reference of March 2020 is older than Mitsuba's correction of roughplastic (62a0295, May 2020)",
}


def beyond(z):
    """Probability of a normal variable beyond +-z."""
    return math.erfc(abs(z) / math.sqrt(2))


def beyond_chi_square(value, freedom):
    """Probability of a greater chi-square, after Wilson and Hilferty (1931)."""
    spread = 2 / (9 * freedom)
    return math.erfc(((value / freedom) ** (1 / 3) - 1 + spread) / math.sqrt(2 * spread)) / 2


def sidak_limit(pixels):
    """The |z| that a pixel may have."""
    level = 1 - (1 - SIGNIFICANCE) ** (1 / pixels)
    low, high = 0.0, 10.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if beyond(middle) > level else (low, middle)
    return low


def weighed(weights, channels, prefix=""):
    return [sum(w * v for w, v in zip(weights, rgb)) for rgb in zip(*(channels[prefix + c] for c in "RGB"))]


def bound(weights, channels):
    """Greatest variance of a weighed sum of R, G and B, whose covariances nobody kept: that of proportional ones."""
    return [sum(w * math.sqrt(max(v, 0)) for w, v in zip(weights, rgb)) ** 2
            for rgb in zip(*(channels["variance." + c] for c in "RGB"))]


class Component:
    """X, Y or Z of both images."""

    def __init__(self, weights, image, mean, variance, spp):
        self.image, self.reference = weighed(weights, image), weighed(weights, mean)
        self.ours = [max(v, LEAST_VARIANCE / spp) for v in bound(weights, image)]
        self.per_sample = [max(v, LEAST_VARIANCE) for v in weighed(weights, variance)]
        self.spp = spp

    def z_of_pixels(self):
        for a, b, own, theirs in zip(self.image, self.reference, self.ours, self.per_sample):
            yield (a - b) / math.sqrt(max(own, theirs / self.spp) + theirs / REFERENCE_SPP)

    def z_of_mean(self, pixels):
        """z of the sum over these pixels, the ratio of the sums and its standard error."""
        a, b = sum(self.image[i] for i in pixels), sum(self.reference[i] for i in pixels)
        noise = math.sqrt(sum(self.ours[i] + self.per_sample[i] / REFERENCE_SPP for i in pixels)
                          + (REFERENCE_ROUNDING * b) ** 2)
        return (a - b) / noise, a / b if b else math.nan, noise / b if b else math.nan


def compare(image_file, reference_file, spp, side):
    """Row of the table, and whether the scene agrees."""
    (width, height, image), (w, h, mean) = read(image_file), read(reference_file)
    if (width, height) != (w, h):
        return [f"{width} x {height} pixels, the reference has {w} x {h}"] + [""] * 7, False
    _, _, variance = read(reference_file.replace("_rgb.exr", "_rgb_var.exr"))
    components = [Component(weights, image, mean, variance, spp) for weights in XYZ]
    limit = sidak_limit(width * height)
    z = [abs(v) for component in components for v in component.z_of_pixels()]
    accepted = sum(v <= limit for v in z) / len(z)
    blocks = [[y * width + x for y in range(top, min(top + side, height)) for x in range(left, min(left + side, width))]
              for top in range(0, height, side) for left in range(0, width, side)]
    blocks = [block for block in blocks if any(c.image[i] or c.reference[i] for c in components for i in block)]
    of_blocks = [[component.z_of_mean(block)[0] for block in blocks] for component in components]
    chi_square, which = max((sum(v * v for v in z_values), name) for name, z_values in zip("XYZ", of_blocks))
    worst = max((v for z_values in of_blocks for v in z_values), key=abs)
    blocks_p = min(1.0, 6 * min(beyond_chi_square(chi_square, len(blocks)), beyond(worst) * len(blocks)))
    total_z, ratio, error = components[1].z_of_mean(range(width * height))
    agrees = accepted >= ACCEPTED_SHARE and blocks_p >= LEAST_PROBABILITY and beyond(total_z) >= LEAST_PROBABILITY
    return [f"{100 * accepted:.2f} %", f"{max(z):.1f}", f"{beyond(max(z)):.1g}",
            f"{chi_square:.0f} / {len(blocks)} ({which})", f"{worst:+.1f}", f"{blocks_p:.2g}",
            f"{ratio:.5f} ± {error:.5f}", "agrees" if agrees else "**disagrees**"], agrees


def reference_of(scene):
    """The reference of NAME_INTEGRATOR.xml is refs/NAME_ref_rgb.exr; "" if there is none."""
    name = os.path.basename(scene)[:-len(".xml")].rsplit("_", 1)[0]
    file = os.path.join(os.path.dirname(scene), "refs", name + "_ref_rgb.exr")
    return file if os.path.exists(file) else ""


def why_not(treefarm, scene):
    """First error of `treefarm check` without the path before it, or "" if the scene loads."""
    check = subprocess.run([treefarm, "check", scene], capture_output=True, text=True)
    if check.returncode in (0, 5):
        return ""
    errors = [line for line in (check.stdout + check.stderr).splitlines() if "error: " in line]
    return errors[0].split("error: ", 1)[1] if errors else f"exit code {check.returncode}"


def row(arguments, scene, reference, folder):
    """Cells of the scene's line, and whether it agrees (None: it does not load)."""
    reason = why_not(arguments.treefarm, scene)
    if reason:
        return [""] * 8 + ["does not load: " + reason.replace("|", "/")], None
    width, height, _ = read(reference)
    spp = max(2, round(arguments.samples / (width * height)))
    run = os.path.join(folder, os.path.basename(scene)[:-len(".xml")])
    done = subprocess.run([arguments.treefarm, "render", scene, "--spp", str(spp), "--run-dir", run, "--quiet",
                           "--overwrite"] + [word for key in arguments.set for word in ("--set", key)],
                          capture_output=True, text=True)
    if done.returncode:
        return [""] * 8 + ["**render failed**: " + done.stderr.strip().replace("\n", " ")], False
    cells, agrees = compare(os.path.join(run, "image.exr"), reference, spp, arguments.block)
    return [str(spp)] + cells, agrees


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("treefarm")
    parser.add_argument("mitsuba_data", nargs="?", default=os.environ.get("MITSUBA_DATA", ""))
    parser.add_argument("--only", default="", help="scenes with this in their path")
    parser.add_argument("--samples", type=float, default=2e7, help="camera paths of a scene (2e7)")
    parser.add_argument("--block", type=int, default=8, help="side of a block in pixels (8)")
    parser.add_argument("--set", metavar="KEY=VALUE", action="append",
                        default=["guiding.type=none", "guiding.combination=fixed"],
                        help="key of the job; without: paths are not guided, and passes weighed by their samples")
    parser.add_argument("--keep", help="folder for the renders (none: they are removed)")
    arguments = parser.parse_args()
    scenes = os.path.join(arguments.mitsuba_data, "tests", "scenes")
    if not arguments.mitsuba_data or not os.path.isdir(scenes):
        print(f"skipped: no folder {scenes}; give a checkout of mitsuba-data")
        return 77
    folder = arguments.keep or tempfile.mkdtemp(prefix="mitsuba3_scenes")
    print("| scene | spp | pixels accepted | max z | its p | chi-square of blocks | worst z | p | Y, ours / theirs | verdict |")
    print("|---|---|---|---|---|---|---|---|---|---|", flush=True)
    verdicts = []
    for scene in sorted(glob.glob(os.path.join(scenes, "*", "*.xml"))):
        reference = reference_of(scene)
        if not reference or arguments.only not in scene:
            continue
        name = os.path.relpath(scene, scenes)[:-len(".xml")]
        cells, agrees = row(arguments, scene, reference, folder)
        if agrees is False and name in EXPLAINED:
            cells[-1] += ": " + EXPLAINED[name]
            agrees = "explained"
        print("| " + " | ".join([name] + cells) + " |", flush=True)
        verdicts.append(agrees)
    if not arguments.keep:
        shutil.rmtree(folder)
    print(f"\n{verdicts.count(True)} agree, {verdicts.count('explained')} do not for a reason that is known, "
          f"{verdicts.count(False)} do not, {verdicts.count(None)} do not load")
    return 1 if False in verdicts or not verdicts else 0


if __name__ == "__main__":
    sys.exit(main())
