#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands that README.md and docs/use show, on small images and few samples.

usage: tests/package/pages_test.py PROGRAM
Scenes and run directories that a page does not name in full are ours. What needs other machines, other people's files
or minutes is counted as left out.
"""
import itertools
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs/use").glob("*.md"))]
COMMAND = re.compile(r"^    (?P<mpirun>mpirun -n \d+ )?(?:build/release/)?treefarm (?P<name>[a-z]+) (?P<rest>.*)$")
LEFT_OUT = re.compile(r"[$\\<|]|\.\.\.|FOLDER|--hostfile|--sweep|--export|--schedule|camera")
BOX = "configs/scenes/cornell-box.xml"
SMALL = ["--set", "image.width=128", "--set", "image.height=128"]
SAMPLES = itertools.count(16, 8)
FEW = ["--quiet", *SMALL, "--set", "budget.max_spp=4"]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_btl_tcp_if_include": "lo", "OMPI_MCA_oob_tcp_if_include": "lo"}


def shown(page):
    """(line, mpirun or None, name, arguments) of each command; what stands behind two spaces or # is a remark."""
    for number, line in enumerate(page.read_text(encoding="utf-8").split("\n"), 1):
        if match := COMMAND.match(line):
            rest = re.split(r" {2,}| #", match["rest"])[0]
            yield number, match["mpirun"], match["name"], rest


def value_replaced(arguments, option, value):
    """The arguments with another value of an option, where it is given."""
    return [value if before == option else word for before, word in zip(["", *arguments], arguments)]


def runnable(name, rest, work):
    """The arguments with which a command is run here; None: it is not."""
    if LEFT_OUT.search(rest) or name in ("report", "serve"):
        return None
    if name == "launch":
        outer, _, inner = rest.partition("--")
        command, *words = shlex.split(inner)
        arguments = None if command == "study" else runnable(command, shlex.join(words), work)
        return arguments and [*shlex.split(outer), "--", command, *arguments]
    words = {"SCENE.xml": BOX, "scene.xml": BOX, "RUN_DIR": f"{work}/first", "run": f"{work}/first",
             "box.exr": f"{work}/box.exr", "reference.exr": f"{work}/reference.exr",
             "[PATTERN]": "guiding", "STUDY.toml": "configs/studies/demo.toml",
             "image.exr": f"{work}/first/image.exr", "picture.png": f"{work}/picture.png",
             "normal.png": f"{work}/normal.png", "flip.png": f"{work}/flip.png", "difference.png": f"{work}/difference.png"}
    arguments = [words.get(word, word) for word in shlex.split(rest)]
    if name == "render":
        folder = f"{work}/{'shot' if '--frames' in arguments else 'again'}"
        arguments = value_replaced(value_replaced(arguments, "--spp", "4"), "--run-dir", folder)
        if not {"--spp", "--error", "--seconds"} & set(arguments):
            arguments += ["--spp", "4"]
        if "--run-dir" not in arguments:
            arguments += ["--run-dir", folder]
        if "--frames" in arguments:
            arguments = value_replaced(arguments, "-o", f"{work}/frames/f.####.exr")
        arguments += ["--overwrite", *FEW]
    if name == "plan" and {"--error", "--seconds", "--spp"} & set(arguments):
        arguments += ["--probe", "0.2", *SMALL]
    if name == "inspect":
        arguments += ["--spp", "1", "--size", "16", "-o", f"{work}/inspect"]
    if name == "resume":  # a run that is done: it gets more samples each time
        arguments = [arguments[0], "--quiet", "--spp", str(next(SAMPLES))]
    if name == "join":
        arguments = [f"{work}/joined/join" if word == "join" else f"{work}/joined" if word == words["RUN_DIR"] else word
                     for word in arguments]
    if name == "study":
        arguments += ["--dry-run", "--no-probe", "--dir", f"{work}/study"]
    return arguments


def run(command, where):
    ended = subprocess.run(command, cwd=ROOT, env=ENVIRONMENT, capture_output=True, text=True, timeout=300)
    # 4: so few samples do not reach the error; 5: check found something.
    if ended.returncode not in (0, 4, 5):
        print(f"{where}: {shlex.join(command)}\nexit code {ended.returncode}\n{ended.stdout}{ended.stderr}")
        return False
    return True


def run_joining(program, command, work, where):
    """Joins a render that runs as long as that takes."""
    folder = pathlib.Path(work) / "joined"
    render = subprocess.Popen([program, "render", BOX, "--quiet", *SMALL, "--seconds", "3", "--set", "farm.join=true", "--run-dir",
                               str(folder), "--overwrite"], cwd=ROOT, stdout=subprocess.DEVNULL)
    end = time.monotonic() + 60
    while not (folder / "join").exists() and render.poll() is None and time.monotonic() < end:
        time.sleep(0.02)
    joined = run(command, where)
    return render.wait(timeout=300) == 0 and joined


def main(program):
    done = left_out = failed = 0
    with tempfile.TemporaryDirectory() as work:
        # spp: two passes of a tree, so that there is one to inspect
        for run_dir, output, seed in (("first", "box", 1), ("second", "reference", 2)):
            first = [program, "render", BOX, "--quiet", *SMALL, "--spp", "8", "--set", f"sampler.seed={seed}", "--set", "output.aovs=normal", "--run-dir",
                     f"{work}/{run_dir}", "-o", f"{work}/{output}.exr"]
            if not run(first, "before all pages"):
                sys.exit(1)
        for page in PAGES:
            for number, mpirun, name, rest in shown(page):
                arguments = runnable(name, rest, work)
                if arguments is None:
                    left_out += 1
                    continue
                start = [*shlex.split(mpirun), "--oversubscribe", "--bind-to", "none"] if mpirun else []
                done += 1
                command, where = [*start, program, name, *arguments], f"{page.relative_to(ROOT)}:{number}"
                failed += not (run_joining(program, command, work, where) if name == "join" else run(command, where))
    print(f"{done} commands run, {failed} failed, {left_out} left out")
    sys.exit(1 if failed or done < 15 else 0)


if __name__ == "__main__":
    main(sys.argv[1])
