# SPDX-License-Identifier: Apache-2.0
"""Compiles units of an up-to-date Ninja build with changed copies of files, without touching a source."""
import json
import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
IDLE = ("inspect", "describe_sample", "debug_sample")


class Build:
    def __init__(self, folder):
        self.folder = folder
        self.units = {}
        for unit in json.loads((folder / "compile_commands.json").read_text()):
            if "/Unity/unity_" in unit["file"]:
                raise SystemExit(f"{folder} compiles several files as one; build the preset by-file instead: "
                                 "cmake --preset by-file && cmake --build --preset by-file")
            self.units[str(pathlib.Path(unit["file"]).resolve().relative_to(ROOT))] = unit["command"]

    def compile(self, unit, overlay, output):
        """A unit of the project, its changed copy if there is one; headers come from the overlay first."""
        source = overlay / unit if (overlay / unit).exists() else ROOT / unit
        command = re.sub(r" -o \S+ -c \S+$", "", self.units[unit]).replace("-Werror", "-w")
        first, rest = re.match(r"(.*?c\+\+(?:-\d+)?|.*?g\+\+(?:-\d+)?) (.*)", command).groups()
        return subprocess.run(f"{first} -I{overlay} {rest} -o {output} -c {source}", shell=True, cwd=self.folder,
                              capture_output=True, text=True)

    def link_test(self, name, objects, output):
        """The program of tests/stability with these objects in place of that of NAME.cpp and before those of libraries."""
        command = self.link_command("tests/stability_test")
        command = re.sub(rf"\S+/{name}\.cpp\.o", " ".join(map(str, objects)), command)
        command = re.sub(r"-o tests/stability_test\b", f"-o {output}", command)
        return subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, text=True)

    def link_program(self, target, objects, output):
        """A program with these objects before those of its libraries, which then are not taken."""
        command = self.link_command(target).replace(f" -o {target} ", f" {' '.join(map(str, objects))} -o {output} ")
        return subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, text=True)

    def program_without(self, edits, overlay, units=None):
        """The program with changed copies of files, which are written to a folder of its own; RuntimeError if it
        cannot be built. Compiled are the given units, or all that the files are part of and that a render needs."""
        if stale := write_edits(edits, overlay):
            raise RuntimeError(f"an edit is stale: {stale} has no such text")
        if units is None:
            # Units of the inspecting commands include the same headers, but trace nothing in a render.
            units = {unit for unit in self.units_of({edit["file"] for edit in edits})
                     if unit.startswith(("worker/", "common/", "coordinator/input/")) and not pathlib.Path(unit).name.startswith(IDLE)}
        objects = []
        for unit in sorted(units):
            objects.append(overlay / (unit.replace("/", "_") + ".o"))
            done = self.compile(unit, overlay, objects[-1])
            if done.returncode != 0:
                raise RuntimeError(f"{unit} does not compile:\n{done.stderr[:2000]}")
        program = overlay / "treefarm"
        done = self.link_program("treefarm", objects, program)
        if done.returncode != 0:
            raise RuntimeError(f"it cannot be linked:\n{done.stderr[-2000:]}")
        return program

    def link_command(self, target):
        commands = subprocess.run(["ninja", "-t", "commands", "-s", target], cwd=self.folder, capture_output=True,
                                  text=True).stdout
        return re.sub(r"^: && | && :$", "", commands.strip().splitlines()[-1])

    def units_of(self, files):
        """The units that these files are part of."""
        return set().union(*({file} if file.endswith(".cpp") else self.users(file) for file in files))

    def users(self, header):
        """The units that include a header."""
        deps = subprocess.run(["ninja", "-t", "deps"], cwd=self.folder, capture_output=True, text=True).stdout
        unit, users = None, set()
        for line in deps.splitlines():
            if line.startswith("    ") and unit is None:
                unit = self.relative(line.strip())  # the first of an object's files is its source
            if line.startswith("    ") and self.relative(line.strip()) == header:
                users.add(unit)
            if not line.startswith("    "):
                unit = None
        return users

    def relative(self, file):
        path = pathlib.Path(os.path.normpath(self.folder / file))
        return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(path)


def write_edits(edits, overlay):
    """Writes the changed copies of files; returns the file of an edit whose text is not there, if any."""
    for edit in edits:
        copy = overlay / edit["file"]
        text = (copy if copy.exists() else ROOT / edit["file"]).read_text()
        if edit["text"] not in text:
            return edit["file"]
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(text.replace(edit["text"], edit["instead"]))
    return None
