#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills every process of renders at random moments, but treefarm launch, which goes on with them.

usage: random_launches.py TREEFARM SCENE [--count N] [--seed S] [--kills K] [--part] [--deadline S]

Each of N renders is killed 1 to K times: all its processes at once, or with --part one of them, or mpirun. Passes if each ends with
exit code 0 and the bits of the render that never stopped, and leaves no process, no shared memory and no temporary folder. Prints a line
per render.
"""
import argparse
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

from launched_render import DEADLINE, command, environment, faults_of, hashes, kill, started

GUIDES = ("auto", "view", "ppg", "none", "grid")


def one(arguments, work, random, truths):
    guide, ranks, kills = random.choice(GUIDES), random.choice((1, 2, 2, 3)), random.randint(1, arguments.kills)
    name = f"{guide} ranks {ranks} kills {kills}"
    if guide not in truths:
        truth = work / f"truth-{guide}"
        subprocess.run(command(arguments.treefarm, arguments.scene, truth, guide), check=True, env=environment())
        truths[guide] = hashes(truth)
    folder = work / "run"
    shutil.rmtree(folder, ignore_errors=True)
    begin = time.monotonic()
    process = subprocess.Popen(command(arguments.treefarm, arguments.scene, folder, guide, ranks), env=environment(),
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    done = 0
    for _ in range(kills):
        time.sleep(random.uniform(0.1, 4.0))
        victims = started(folder)
        if process.poll() is not None:
            break
        kill([random.choice(victims)] if arguments.part and victims else victims)
        done += bool(victims)
    try:
        output, _ = process.communicate(timeout=arguments.deadline)
    except subprocess.TimeoutExpired:
        kill([*started(folder), process.pid])
        return name, f"hangs: {process.communicate()[0]}", 0, done
    seconds = time.monotonic() - begin
    return name, faults_of(process, output, folder, truths[guide]), seconds, done


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("treefarm")
    parser.add_argument("scene")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kills", type=int, default=3)
    parser.add_argument("--part", action="store_true", help="one process at a time")
    parser.add_argument("--deadline", type=float, default=DEADLINE, help="seconds for each; more where the machine is busy")
    arguments = parser.parse_args()
    if shutil.which("mpirun") is None:
        print("skipped: there is no mpirun")
        sys.exit(77)
    failed, kills, truths = 0, 0, {}
    with tempfile.TemporaryDirectory() as work:
        for k in range(arguments.count):
            name, failure, seconds, done = one(arguments, pathlib.Path(work), random.Random(arguments.seed * 1000 + k), truths)
            failed += bool(failure)
            kills += done
            print(f"{k:3} {name}: {failure or f'same bits after {seconds:.1f} s'}", flush=True)
    print(f"{arguments.count} renders, {kills} times killed, {failed} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
