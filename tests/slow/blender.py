#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Blender's compositor reads an image with layers: by their names, with their values.

usage: blender.py TREEFARM SCENE

Renders with layers, lets Blender (in the background, with a script) load the image, list what its compositor offers and
write each layer anew, and compares the values. Skips where there is no blender.
"""
import os
import shutil
import subprocess
import sys
import tempfile

import exr_reader

# Layer as its name is asked for, and the channels that Blender has to find.
LAYERS = {"albedo": "RGB", "normal": "XYZ", "depth": "Z", "position": "XYZ", "direct": "RGB", "material": "I"}

IN_BLENDER = r"""
import sys
import bpy

path, out, width, height = sys.argv[sys.argv.index("--") + 1:]
image = bpy.data.images.load(path)
scene = bpy.context.scene
scene.use_nodes = True
tree = scene.node_tree
tree.nodes.clear()
scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)  # image.size is (0, 0) where there are layers
scene.render.resolution_percentage = 100
node = tree.nodes.new("CompositorNodeImage")
node.image = image
files = tree.nodes.new("CompositorNodeOutputFile")
files.base_path = out
files.format.file_format = "OPEN_EXR"
files.format.color_mode = "RGBA"
files.format.color_depth = "32"
files.format.exr_codec = "ZIP"
files.file_slots.clear()
composite = tree.nodes.new("CompositorNodeComposite")
for socket in node.outputs:
    if socket.is_unavailable:
        continue
    print("LAYER", socket.name, flush=True)
    files.file_slots.new(socket.name)
    tree.links.new(socket, files.inputs[len(files.inputs) - 1])
tree.links.new(node.outputs[0], composite.inputs[0])
bpy.ops.render.render()
"""


def render(treefarm, scene, folder):
    run = os.path.join(folder, "run")
    subprocess.run([treefarm, "render", scene, "-D", "size=48", "--spp", "28", "--quiet", "--run-dir", run, "--set",
                    "output.aovs=" + ",".join(LAYERS)], check=True)
    return os.path.join(run, "image.exr")


def in_blender(image, width, height, folder):
    """What the compositor calls the image's layers, and a file of each."""
    script = os.path.join(folder, "compositor.py")
    with open(script, "w") as file:
        file.write(IN_BLENDER)
    out = os.path.join(folder, "layers")
    done = subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", script,
                           "--", image, out, str(width), str(height)], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"blender failed:\n{done.stdout}\n{done.stderr}")
    names = [line.split(" ", 1)[1] for line in done.stdout.splitlines() if line.startswith("LAYER ")]
    return {name: os.path.join(out, name + "0001.exr") for name in names}


def worst(mine, theirs):
    """The largest difference between two channels, over the largest value."""
    scale = max(map(abs, mine)) or 1.0
    return max(abs(a - b) for a, b in zip(mine, theirs, strict=True)) / scale


def main():
    if not shutil.which("blender"):
        print("skipped: no blender")
        return 77
    treefarm, scene = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="treefarm-blender-") as folder:
        image = render(treefarm, scene, folder)
        width, height, mine = exr_reader.read(image)
        files = in_blender(image, width, height, folder)
        print("Blender offers: " + ", ".join(sorted(files)))
        bad = 0
        for layer, channels in LAYERS.items():
            if layer not in files:
                print(f"{layer}: Blender does not offer it")
                bad += 1
                continue
            _, _, theirs = exr_reader.read(files[layer])
            # A socket is a colour, a vector or a number: written as R, G, B in that order.
            error = max(worst(mine[f"{layer}.{channel}"], theirs["RGB"[k]]) for k, channel in enumerate(channels))
            print(f"{layer}: off by {error:.1e} of its largest value")
            bad += error > 1e-6
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
