#!/usr/bin/env python3
"""Shows that the tests of tests/stability can fail: removes each guard of guards.json in turn, builds, and runs its test.

usage: tests/stability/without_guards.py [BUILD] [TEST...]     e.g. build/release Weights.OfHugeAndInfiniteDensities

The sources are edited in place and restored; what is not committed in a guarded file stops the run before it begins.
Takes about a minute per guard.
"""
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def build_and_run(build, guard):
    """Whether the test noticed: it failed, crashed, or no longer compiles."""
    target = "stability_" + guard["program"]
    built = subprocess.run(["cmake", "--build", build, "--target", target, "-j2"], capture_output=True, text=True)
    if built.returncode != 0:
        return "does not compile"
    test = guard["test"]
    filters = f"--gtest_filter={test}:*/{test}/*"
    ran = subprocess.run([build / "tests" / target, filters], capture_output=True, text=True, timeout=600)
    return "fails" if ran.returncode != 0 else "PASSES"


def main():
    arguments = sys.argv[1:]
    build = pathlib.Path(arguments.pop(0) if arguments and "/" in arguments[0] else ROOT / "build/release").resolve()
    guards = json.loads((ROOT / "tests/stability/guards.json").read_text())
    chosen = [g for g in guards if not arguments or g["test"] in arguments]
    files = sorted({edit["file"] for guard in chosen for edit in guard["edits"]})
    if subprocess.run(["git", "-C", ROOT, "diff", "--quiet", "HEAD", "--", *files]).returncode != 0:
        sys.exit("commit the guarded files first")
    unnoticed = 0
    for guard in chosen:
        originals = {edit["file"]: (ROOT / edit["file"]).read_text() for edit in guard["edits"]}
        try:
            for edit in guard["edits"]:
                path = ROOT / edit["file"]
                text = path.read_text()
                if text.count(edit["text"]) == 0:
                    sys.exit(f"{edit['file']} does not hold: {edit['text']}")
                path.write_text(text.replace(edit["text"], edit["instead"]))
            outcome = build_and_run(build, guard)
        finally:
            for file, text in originals.items():
                (ROOT / file).write_text(text)
        unnoticed += outcome == "PASSES"
        print(f"{guard['test']}: {outcome} without {guard['edits'][0]['text']}", flush=True)
    sys.exit(1 if unnoticed else 0)


main()
