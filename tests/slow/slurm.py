#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders in jobs of a real Slurm (tests/support/local_slurm.py) by deploy/slurm/render.sbatch: killed by their time limit, preempted,
cancelled, on a node that is lost; and an array of frames.

usage: slurm.py TREEFARM SCENE [--only NAME] [--longer F]

Passes if each ends with the bits of one process that was never stopped. Skips where there can be no Slurm.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from cases import parser_of, run_cases, skip_for
from launched_render import environment, hashes
from local_slurm import LocalSlurm, why_not

SCRIPT = ROOT / "deploy" / "slurm" / "render.sbatch"
FRAMES = range(1, 7)


class Bench:
    """A Slurm, a render and the truth of it."""

    def __init__(self, arguments, work):
        self.treefarm = pathlib.Path(arguments.treefarm).resolve()
        self.scene = pathlib.Path(arguments.scene).resolve()
        self.work = work
        self.truths = {}
        self.slurm = LocalSlurm(work / "slurm", task_plugin="task/affinity")
        # The script finds the program as it would on a cluster, and Open MPI stays on this machine.
        self.slurm.environment.update({
            **environment(), "PATH": f"{self.treefarm.parent}:{os.environ['PATH']}", "OMPI_MCA_btl_tcp_if_include": "lo",
            "OMPI_MCA_oob_tcp_if_include": "lo", "PMIX_MCA_ptl_tcp_if_include": "lo"})
        self.second = self._samples_of_a_second() * arguments.longer

    def words(self, spp, size=64):
        return [str(self.scene), "-D", f"size={size}", "--spp", str(spp), "--set", "guiding.type=auto", "--set",
                "farm.checkpoint_seconds=1", "--set", "farm.heartbeat_seconds=0.2"]

    def _samples_of_a_second(self):
        begin = time.monotonic()
        self.alone(self.words(255), "speed")
        return 255 / (time.monotonic() - begin)

    def alone(self, words, name):
        subprocess.run([str(self.treefarm), "render", *words, "--run-dir", str(self.work / name), "--quiet"], check=True,
                       env=environment())
        return hashes(self.work / name) if "--frames" not in words else None

    def words_for(self, seconds):
        """A render that takes this machine about so long, and its truth."""
        words = self.words(int(self.second * seconds))
        if seconds not in self.truths:
            self.truths[seconds] = self.alone(words, f"truth-{seconds}")
        return words, self.truths[seconds]

    def submit(self, folder, words, *options):
        return self.slurm.submit(*options, f"--output={self.work}/log-%j", str(SCRIPT), str(folder), *words)

    def log(self, job):
        return (self.work / f"log-{job}").read_text()

    def ends_as(self, job, folder, truth, restarts, seconds=600):
        """What is wrong with a job's end; else what it has been through."""
        states = self.slurm.wait(job, seconds)
        facts = self.slurm.facts(job)[0]
        if states != ["COMPLETED"]:
            return f"FAILED: {facts['JobState']} {facts['Reason']}: {self.log(job)}"
        if hashes(folder) != truth:
            return f"FAILED: {hashes(folder)} instead of {truth}"
        if int(facts["Restarts"]) < restarts:
            return f"FAILED: {facts['Restarts']} restarts, {restarts} were meant: {self.log(job)}"
        return f"same bits after {facts['Restarts']} restarts"

    def wait_for_pass(self, job, folder):
        """Until a job runs and its render has a checkpoint."""
        limit = time.monotonic() + 60
        while not ((folder / "checkpoint").exists() and list((folder / "checkpoint").glob("*.tfc"))):
            if time.monotonic() > limit:
                raise RuntimeError(f"job {job} writes no checkpoint: {self.slurm.facts(job)} {self.log(job)}")
            time.sleep(0.05)


def calm(bench):
    words, truth = bench.words_for(8)
    folder = bench.work / "calm"
    return bench.ends_as(bench.submit(folder, words, "--nodes=3"), folder, truth, 0)


def plain_srun(bench):
    words, truth = bench.words_for(8)
    folder = bench.work / "srun"
    command = " ".join(["srun", "--mpi=pmix", "--cpu-bind=none", str(bench.treefarm), "render", *words, "--run-dir", str(folder)])
    job = bench.slurm.submit("--nodes=3", "--ntasks=4", "--exclusive", f"--output={bench.work}/log-%j", "--wrap", command)
    return bench.ends_as(job, folder, truth, 0)


def without_environment(bench):
    """sbatch --export=NONE: srun would give its tasks no variables either."""
    words, truth = bench.words_for(8)
    folder = bench.work / "export"
    keep = ",".join(name for name in ("PATH", "SLURM_CONF", "OMPI_MCA_btl_tcp_if_include", "PMIX_MCA_ptl_tcp_if_include"))
    command = f"{bench.treefarm} launch -- render {' '.join(words)} --run-dir {folder}"
    bench.slurm.environment["SBATCH_EXPORT"] = keep
    try:
        job = bench.slurm.submit("--nodes=3", "--exclusive", "--no-requeue", f"--output={bench.work}/log-%j", "--wrap",
                                 f"export SLURM_EXPORT_ENV=NONE; {command}")
    finally:
        del bench.slurm.environment["SBATCH_EXPORT"]
    result = bench.ends_as(job, folder, truth, 0, 120)
    return result if "again in" not in bench.log(job) else f"FAILED: {bench.log(job)}"


def out_of_time(bench):
    """Told before each limit, it writes what it has and requeues itself. Slurm looks at limits every half minute."""
    words, truth = bench.words_for(110)
    folder = bench.work / "limit"
    return bench.ends_as(bench.submit(folder, words, "--nodes=3", "--time=1", "--signal=B:USR1@40"), folder, truth, 3, 900)


def killed_at_limit(bench):
    """Never told, ended at the limit as Slurm ends jobs, three times or more; requeued by hand."""
    words, truth = bench.words_for(300)
    folder = bench.work / "killed"
    job = bench.submit(folder, words, "--nodes=3", "--time=1", "--signal=B:28@1")  # SIGWINCH, which nobody heeds
    for _ in range(30):
        if bench.slurm.wait(job, 200) != ["TIMEOUT"]:
            break
        bench.slurm.run("scontrol", "requeue", job)
        bench.slurm.wait(job, 60, ("RUNNING",))
    return bench.ends_as(job, folder, truth, 3)


def preempted(bench):
    words, truth = bench.words_for(60)
    folder = bench.work / "preempted"
    job = bench.submit(folder, words, "--nodes=3")
    bench.wait_for_pass(job, folder)
    urgent = bench.slurm.submit("--partition=urgent", "--nodes=3", "--exclusive", "--output=/dev/null", "--wrap", "sleep 2")
    result = bench.ends_as(job, folder, truth, 1)
    return result if bench.slurm.wait(urgent, 60) == ["COMPLETED"] else f"FAILED: urgent job {bench.slurm.facts(urgent)}; {result}"


def cancelled(bench):
    """It is not requeued, and a second job goes on with the folder."""
    words, truth = bench.words_for(60)
    folder = bench.work / "cancelled"
    job = bench.submit(folder, words, "--nodes=3")
    bench.wait_for_pass(job, folder)
    bench.slurm.run("scancel", job)
    if bench.slurm.wait(job, 60) != ["CANCELLED"] or bench.slurm.facts(job)[0]["Restarts"] != "0":
        return f"FAILED: {bench.slurm.facts(job)}"
    if hashes(folder)[2] != "interrupted":
        return f"FAILED: what scancel ends is {hashes(folder)}"
    second = bench.submit(folder, words, "--nodes=2")
    result = bench.ends_as(second, folder, truth, 0)
    return result if "going on with" in bench.log(second) else f"FAILED: begun anew: {bench.log(second)}"


def node_lost(bench):
    words, truth = bench.words_for(60)
    folder = bench.work / "node"
    job = bench.submit(folder, words, "--nodes=2", "--nodelist=s1,s2")
    bench.wait_for_pass(job, folder)
    bench.slurm.crash("s2")
    bench.slurm.run("scontrol", "update", f"jobid={job}", "reqnodelist=", check=False)
    try:
        limit = time.monotonic() + 90
        while bench.slurm.states(job) == ["RUNNING"] and time.monotonic() < limit:
            time.sleep(0.2)
        bench.slurm.run("scontrol", "update", f"jobid={job}", "reqnodelist=s1,s3")
        return bench.ends_as(job, folder, truth, 1)
    finally:
        bench.slurm.start_node("s2")
        bench.slurm.run("scontrol", "update", "nodename=s2", "state=resume", check=False)


def array(bench):
    """Frames of a shot, one of which is requeued while it renders; the shot's own command then finds all of them done."""
    shot = bench.work / "shot"
    scene = ROOT / "configs" / "scenes" / "door-ajar.xml"
    words = [str(scene), "-D", "open=%d", "--spp", "128", "--set", "image.width=64", "--set", "image.height=48"]
    frames = f"{FRAMES[0]}-{FRAMES[-1]}"
    bench.alone([*words, "--frames", frames], "quiet-shot")
    job = bench.submit(shot, words, "--nodes=1", f"--array={frames}")
    first = shot / f"frame.{FRAMES[0]:04d}"
    bench.wait_for_pass(job, first)
    bench.slurm.run("scontrol", "requeue", f"{job}_{FRAMES[0]}", check=False)
    states = bench.slurm.wait(job, 600)
    if states is None or set(states) != {"COMPLETED"}:
        return f"FAILED: {states}"
    for frame in FRAMES:
        name = f"frame.{frame:04d}"
        if hashes(shot / name) != hashes(bench.work / "quiet-shot" / name):
            return f"FAILED: {name}: {hashes(shot / name)}"
    after = subprocess.run([str(bench.treefarm), "render", *words, "--frames", frames, "--run-dir", str(shot)], capture_output=True,
                           text=True, env=environment())
    if after.returncode != 0 or after.stderr.count("kept: it was done before") != len(FRAMES):
        return f"FAILED: the shot does not know its frames: {after.stderr}"
    return f"same bits in {len(FRAMES)} frames"


CASES = {"calm": calm, "srun --mpi=pmix": plain_srun, "no variables": without_environment, "preempted": preempted,
         "cancelled": cancelled, "node lost": node_lost, "array": array, "out of time": out_of_time,
         "killed at its limit": killed_at_limit}


def main():
    parser = parser_of(__doc__, CASES)
    parser.add_argument("--longer", type=float, default=1, help="times as much to render, where the machine may get less busy meanwhile")
    arguments = parser.parse_args()
    skip_for(why_not())
    with tempfile.TemporaryDirectory(dir="/var/tmp") as folder:
        bench = Bench(arguments, pathlib.Path(folder))
        with bench.slurm as slurm:
            skip_for("" if slurm.has_pmix() else "this Slurm has no PMIx")

            def case(name):
                result = CASES[name](bench)
                slurm.run("scancel", "--user=root", check=False)
                return result

            failed = run_cases(arguments.only or CASES, case)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
