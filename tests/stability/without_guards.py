#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Shows that the tests of tests/stability can fail: removes each guard of guards.json in turn and runs its test.

usage: tests/stability/without_guards.py [BUILD] [TEST...]     e.g. build/by-file Weights.OfHugeAndInfiniteDensities

BUILD (default build/by-file, of the preset by-file) must be up to date. No source is touched: changed copies stand before the
sources on the include path, and only the test itself and the units that a guard names are compiled with them.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from overlay_build import ROOT, Build, write_edits


def outcome_of(build, guard, overlay):
    if stale := write_edits(guard["edits"], overlay):
        return f"IS STALE: {stale} has no such text"
    if all(edit["file"].endswith(".cmake") for edit in guard["edits"]):
        return "is not run here"
    test_unit = f"tests/stability/{guard['program']}.cpp"
    changed = [edit["file"] for edit in guard["edits"] if edit["file"].endswith(".cpp")]
    objects = []
    for unit in [test_unit, *dict.fromkeys(changed + guard.get("also", []))]:
        objects.append(overlay / (unit.replace("/", "_") + ".o"))
        compiled = build.compile(unit, overlay, objects[-1])
        if compiled.returncode != 0:
            return "DOES NOT COMPILE: " + compiled.stderr[:300]
    linked = build.link_test(guard["program"], objects, overlay / "test")
    if linked.returncode != 0:
        return "DOES NOT LINK: " + linked.stderr[-300:]
    test = guard["test"]
    try:
        ran = subprocess.run([overlay / "test", f"--gtest_filter={test}:*/{test}/*"], capture_output=True, timeout=300)
    except subprocess.TimeoutExpired:
        return "fails (it does not end)"
    return "PASSES" if ran.returncode == 0 else "fails" if ran.returncode > 0 else f"fails (signal {-ran.returncode})"


def main():
    arguments = sys.argv[1:]
    folder = pathlib.Path(arguments.pop(0) if arguments and "/" in arguments[0] else ROOT / "build/by-file").resolve()
    build = Build(folder)
    wrong = 0
    for guard in json.loads((ROOT / "tests/stability/guards.json").read_text()):
        if arguments and guard["test"] not in arguments:
            continue
        with tempfile.TemporaryDirectory() as overlay:
            outcome = outcome_of(build, guard, pathlib.Path(overlay))
        wrong += not outcome.startswith(("fails", "is not"))
        print(f"{guard['test']}: {outcome} without {guard['edits'][0]['text']}", flush=True)
    sys.exit(1 if wrong else 0)


main()
