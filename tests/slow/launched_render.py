# SPDX-License-Identifier: Apache-2.0
"""Small renders under treefarm launch, for scripts that do them harm: how they are started, found, and held against the undisturbed one."""
import glob
import json
import os
import pathlib
import signal

DEADLINE = 240


def environment(transport=None):
    """Of a launch; `transport`: of Open MPI's messages, such as "tcp,self"."""
    asked = {"OMPI_MCA_btl": transport} if transport else {}
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", **asked}


def command(treefarm, scene, folder, guide, ranks=None, spp=255, interval=0.001, update=1.5):
    """A render alone, or under launch on so many ranks; seconds between its checkpoints, and between a worker's results."""
    render = ["render", scene, "-D", "size=48", "--run-dir", str(folder), "--overwrite", "--threads", "1",
              "--quiet", "--spp", str(spp), "--set", f"guiding.type={guide}", "--set",
              f"farm.checkpoint_seconds={interval}", "--set", f"farm.update_seconds={update}", "--set", "farm.heartbeat_seconds=0.2"]
    return [treefarm, *(["launch", "-n", str(ranks), "--"] if ranks else []), *render]


def hashes(folder):
    summary = json.loads((folder / "summary.json").read_text())
    return summary["image_hash"], summary["tree_hash"], summary["state"]


def variables_of(pid):
    try:
        return b"\0" + pathlib.Path(f"/proc/{pid}/environ").read_bytes()
    except OSError:
        return b""


def started(folder):
    """Processes of all attempts in this folder: mpirun and the ranks."""
    wanted = f":{folder}/launch/status.json".encode()
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        variables = variables_of(process.name)
        at = variables.find(b"\0TREEFARM_ATTEMPT=")
        if at >= 0 and variables[at:].split(b"\0")[1].endswith(wanted):
            found.append(int(process.name))
    return found


def ranks(folder):
    """Process of each rank in this folder, and mpirun's under -1."""
    found = {}
    for pid in started(folder):
        variables = variables_of(pid)
        at = variables.find(b"\0OMPI_COMM_WORLD_RANK=")
        found[int(variables[at:].split(b"\0")[1].split(b"=")[1]) if at >= 0 else -1] = pid
    return found


def leftovers(pid):
    """Temporary folders of a launch."""
    return [name for place in ("/dev/shm", os.environ.get("TMPDIR", "/tmp"))
            for name in glob.glob(f"{place}/treefarm-launch-{pid}-*")]


def send(number, pids):
    for pid in pids:
        try:
            os.kill(pid, number)
        except ProcessLookupError:
            pass


def kill(pids):
    send(signal.SIGKILL, pids)


def faults_of(process, output, folder, truth):
    """What is wrong with a launch that has ended; empty: nothing."""
    faults = []
    if process.returncode != 0:
        faults.append(f"exit code {process.returncode}: {output}")
    elif hashes(folder) != truth:
        faults.append(f"{hashes(folder)} instead of {truth}")
    if started(folder):
        faults.append(f"processes {started(folder)} stay")
    if leftovers(process.pid):
        faults.append(f"{leftovers(process.pid)} stay")
    return "; ".join(faults)
