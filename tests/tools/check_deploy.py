#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Files of deploy/ for queues: that shells can read them, that their commands have only options which the program knows, and that they are
what their systems take, as far as that can be seen without them.

usage: check_deploy.py TREEFARM
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEPLOY = ROOT / "deploy"
FAULTS = []

# Directives of sbatch that the script uses (sbatch(1)).
SBATCH = {"job-name", "exclusive", "mem", "time", "requeue", "signal", "open-mode", "output"}

# OpenCue's cjsl-1.15.dtd: children in their order.
CUE = {
    "spec": "facility dept show shot user email uid job depends",
    "job": "paused priority maxretries maxcores maxgpus autoeat localbook os env layers",
    "layers": "layer",
    "layer": "cmd range chunk cores threadable memory gpus gpu gpu_memory timeout timeout_llu tags limits env services outputs",
    "services": "service",
}

# Flamenco's manager, as far as a job type sees it; prints the tasks.
MANAGER = """
const tasks = [];
globalThis.path = require("path").posix;
globalThis.author = {Task: (name, type) => ({name, type, commands: [], addCommand(c) { this.commands.push(c); }}),
                     Command: (name, parameters) => ({name, parameters})};
globalThis.frameChunker = (frames) => frames.split(",").flatMap((part) => {
    const [first, last] = part.trim().split("-").map(Number);
    return Array.from({length: (last || first) - first + 1}, (_, k) => String(first + k));
});
(0, eval)(require("fs").readFileSync(process.argv[1], "utf8") + "; globalThis.JOB_TYPE = JOB_TYPE;");
const settings = {scene: "/s/door.%04d.xml", folder: "/r/door", frames: "3, 5-6",
                  options: "-D frame=%d -o /r#1/x.####.exr"};
for (const one of JOB_TYPE.settings) {
    if (!/^[a-z_]+$/.test(one.key) || !["string", "int32", "float", "bool"].includes(one.type)) throw one.key;
    settings[one.key] ??= one.default;
}
compileJob({settings, addTask: (task) => tasks.push(task)});
console.log(JSON.stringify(tasks));
"""


def expect(condition, fault):
    if not condition:
        FAULTS.append(fault)


def output(*words, given=None):
    ended = subprocess.run(words, capture_output=True, text=True, input=given)
    expect(ended.returncode == 0, f"{words}: {ended.stderr}")
    return ended.stdout


class Options:
    def __init__(self, treefarm):
        self.treefarm, self.help = treefarm, {}

    def check(self, where, words):
        """words: of a whole command, treefarm first."""
        parts = [words[1:]]
        if "--" in words:
            at = words.index("--")
            parts = [words[1:at], words[at + 1:]]
        for part in parts:
            name = part[0]
            text = self.help.setdefault(name, output(self.treefarm, name, "--help"))
            for word in part[1:]:
                if re.fullmatch(r"-[a-zA-Z]|--[a-z][a-z-]*", word):
                    expect(re.search(rf"(^|[ ,\n]){word}([ ,\n]|$)", text), f"{where}: treefarm {name} has no {word}")


def check_shells():
    for path in [*DEPLOY.rglob("*")]:
        if path.is_file() and path.read_bytes()[:80].split(b"\n")[0].endswith(b"bash"):
            output("bash", "-n", str(path))


def check_slurm(options):
    path = DEPLOY / "slurm" / "render.sbatch"
    text = path.read_text()
    used = set(re.findall(r"^#SBATCH --([a-z-]+)", text, re.M))
    expect(used == SBATCH, f"{path}: directives {used ^ SBATCH}")
    # What the shell has put together, with a program that says it.
    said = output("bash", "-c", f"treefarm() {{ echo treefarm \"$@\"; }}; export -f treefarm; SLURM_JOB_ID=1 SLURM_ARRAY_TASK_ID=7 "
                  f"bash {path} door scene.xml -D open=%d -o shot#2/f.%04d.###.exr --error 5%")
    expect(said.split() == "treefarm launch -- render scene.xml -D open=7 -o shot#2/f.0007.007.exr --error 5% --run-dir door/frame.0007 --resume".split(),
           f"{path}: starts {said}")
    options.check(path, said.split())


def check_kubernetes(options):
    path = DEPLOY / "kubernetes" / "mpijob.yaml"
    try:
        import yaml
    except ImportError:
        return
    job = yaml.safe_load(path.read_text())
    expect((job["apiVersion"], job["kind"]) == ("kubeflow.org/v2beta1", "MPIJob"), f"{path}: is no MPIJob")
    specs = job["spec"]["mpiReplicaSpecs"]
    expect(set(specs) == {"Launcher", "Worker"}, f"{path}: {set(specs)}")
    launcher = specs["Launcher"]["template"]["spec"]["containers"][0]
    words = launcher["command"] + launcher["args"]
    options.check(path, words)
    expect(int(words[words.index("--threads") + 1]) == int(launcher["resources"]["limits"]["cpu"]), f"{path}: threads and cpu differ")
    container = (DEPLOY / "Containerfile").read_text()
    for word in ("/home/treefarm/sshd_config", "openssh-server", "--uid 1000"):
        expect(word in container, f"Containerfile: {path} needs {word}")
    expect(specs["Worker"]["template"]["spec"]["containers"][0]["command"][-1] == "/home/treefarm/sshd_config", f"{path}: sshd")


def check_opencue(options):
    path = DEPLOY / "opencue" / "submit"
    text = output(sys.executable, str(path), "--show", "film", "--shot", "door", "--frames", "1-24", "--folder", "/r/door", "--print",
                  "--", "/s/door.xml", "-D", "open=%d", "-o", "/r#1/a b.####.exr", "--error", "5%")
    spec = xml.fromstring(text)
    for node in spec.iter():
        if node.tag in CUE:
            order = CUE[node.tag].split()
            places = [order.index(child.tag) if child.tag in order else -1 for child in node]
            expect(-1 not in places and places == sorted(places), f"{path}: <{node.tag}> holds {[child.tag for child in node]}")
    command = spec.findtext("job/layers/layer/cmd")
    words = json.loads(output(sys.executable, "-c", "import json, shlex, sys; print(json.dumps(shlex.split(sys.argv[1])))", command))
    expect("open=#IFRAME#" in words and "/r#1/a b.#ZFRAME#.exr" in words, f"{path}: {command}")
    options.check(path, words)


def check_flamenco(options):
    path = DEPLOY / "flamenco" / "treefarm-shot.js"
    if shutil.which("node") is None:
        return
    tasks = json.loads(output("node", "-e", MANAGER, str(path)) or "[]")
    expect([task["name"] for task in tasks] == ["frame-0003", "frame-0005", "frame-0006"], f"{path}: {tasks}")
    for task in tasks:
        command = task["commands"][0]
        expect((task["type"], command["name"]) == ("misc", "exec"), f"{path}: {task}")
        words = [command["parameters"]["exe"], *command["parameters"]["args"]]
        expect(words[4] == f"/s/door.{task['name'][-4:]}.xml" and "--resume" in words, f"{path}: {words}")
        expect(f"/r#1/x.{task['name'][-4:]}.exr" in words, f"{path}: {words}")
        options.check(path, words)


def main():
    options = Options(sys.argv[1])
    check_shells()
    for check in (check_slurm, check_kubernetes, check_opencue, check_flamenco):
        check(options)
    for fault in FAULTS:
        print(fault)
    sys.exit(1 if FAULTS else 0)


if __name__ == "__main__":
    main()
