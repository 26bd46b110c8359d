#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills whole renders at random moments, one to three times each, and goes on with them by other numbers of processes.

usage: random_resumes.py TREEFARM SCENE [--count N] [--seed S]

Passes if each ends with the bits of the render that never stopped; one of --seconds or --error with those that its
schedule.toml replays. A render killed before its first checkpoint is begun anew. Prints a line per render.
"""
import argparse
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

BUDGETS = (["--spp", "255"], ["--spp", "255"], ["--spp", "255"], ["--seconds", "4"], ["--error", "20%"])
GUIDES = ("auto", "view", "ppg", "none", "grid", "qtable")


def environment():
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_oob_tcp_if_include": "lo", "OMPI_MCA_btl_tcp_if_include": "lo"}


def launcher(ranks):
    return [] if ranks == 1 else ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1",
                                  "-n", str(ranks)]


def start(command):
    return subprocess.Popen(command, env=environment(), start_new_session=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)


def kill_all(process):
    """The launcher's session, and the ranks, which have groups of their own."""
    ranks = []
    try:
        ranks = [int(p) for p in open(f"/proc/{process.pid}/task/{process.pid}/children").read().split()]
    except OSError:
        pass
    for pid in [*ranks, process.pid]:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
    process.communicate()


def finish(command, what):
    process = start(command)
    try:
        output, _ = process.communicate(timeout=300)
    except subprocess.TimeoutExpired:
        kill_all(process)
        return f"{what}: hangs"
    return "" if process.returncode in (0, 4) else f"{what}: exit code {process.returncode}: {output}"


def hashes(folder):
    summary = json.loads((folder / "summary.json").read_text())
    return summary["image_hash"], summary["tree_hash"], summary["state"]


def render_command(arguments, folder, guide, budget, threads=1):
    return [arguments.treefarm, "render", arguments.scene, "-D", "size=48", "--run-dir", str(folder), "--overwrite",
            "--threads", str(threads), "--quiet", "--set", f"guiding.type={guide}", "--set",
            "farm.checkpoint_seconds=0.001", "--set", "farm.heartbeat_seconds=0.2", *budget]


def one(arguments, work, random, truths):
    guide, budget = random.choice(GUIDES), random.choice(BUDGETS)
    folder, kills, ranks = work / "run", random.randint(1, 3), []
    shutil.rmtree(folder, ignore_errors=True)
    for _ in range(kills + 1):
        ranks.append(random.choice((1, 1, 2, 3, 4)))
        begun = any((folder / "checkpoint").glob("?.tfc"))
        command = launcher(ranks[-1]) + ([arguments.treefarm, "resume", str(folder), "--threads", str(random.randint(1, 3)),
                                          "--quiet"] if begun else render_command(arguments, folder, guide, budget))
        if len(ranks) > kills:
            if failure := finish(command, "the last"):
                return f"{guide} {budget} ranks {ranks}", failure
            break
        process = start(command)
        time.sleep(random.uniform(0.1, 3.0))
        kill_all(process)
        if (folder / "summary.json").exists() and hashes(folder)[2] == "done":
            break
    name = f"{guide} {' '.join(budget)} ranks {ranks}"
    if budget[0] == "--spp":
        truth = work / f"truth-{guide}"
        if guide not in truths:
            if failure := finish(render_command(arguments, truth, guide, budget), "the undisturbed one"):
                return name, failure
            truths[guide] = hashes(truth)
        expected = truths[guide]
    else:
        replay = work / "replay"
        if failure := finish([arguments.treefarm, "render", str(folder / "job.toml"), "--schedule",
                              str(folder / "schedule.toml"), "--run-dir", str(replay), "--overwrite", "--quiet"], "the replay"):
            return name, failure
        expected = hashes(replay)
    return name, "" if hashes(folder) == expected else f"{hashes(folder)} instead of {expected}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("treefarm")
    parser.add_argument("scene")
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    if shutil.which("mpirun") is None:
        print("skipped: there is no mpirun")
        sys.exit(77)
    failed, truths = 0, {}
    with tempfile.TemporaryDirectory() as work:
        for k in range(arguments.count):
            name, failure = one(arguments, pathlib.Path(work), random.Random(arguments.seed * 1000 + k), truths)
            failed += bool(failure)
            print(f"{k:3} {name}: {failure or 'same bits'}", flush=True)
    print(f"{arguments.count} renders, {failed} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
