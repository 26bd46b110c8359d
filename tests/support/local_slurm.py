# SPDX-License-Identifier: Apache-2.0
"""A Slurm of this machine's own: munged, slurmctld and some slurmd, each of which is a node with its own /tmp and /dev/shm.

Nothing of it outlives the object, and nothing of an installed cluster is touched: keys, sockets, ports and spools are its own. Needs root
(mount namespaces) and the packages slurm-wlm and munge; why_not() says what is missing.
"""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

NODES = 3
SOON = 5  # seconds after which a requeued job begins

# Partitions: jobs of `urgent` preempt those of `main`, which are told by SIGTERM and requeued.
CONFIGURATION = """
ClusterName=farm
SlurmctldHost={host}({address})
SlurmctldPort={port}
SlurmdPort={slurmd_port}
AuthType=auth/munge
AuthInfo=socket={folder}/run/munge.sock
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/run/slurmctld.pid
SlurmdPidFile={folder}/run/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin={task_plugin}
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=2,bf_interval=2
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
MpiDefault=none
ReturnToService=2
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
CommunicationParameters={listening}
SwitchType=switch/none
InactiveLimit=0
KillWait=10
MinJobAge=7200
SlurmdTimeout=10
SlurmdParameters=config_overrides
{nodes}
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP PriorityTier=1 GraceTime=30
PartitionName=urgent Nodes=ALL MaxTime=INFINITE State=UP PriorityTier=2
"""
TOLD_EARLY = "SlurmctldParameters=preempt_send_user_signal\n"


def why_not():
    """Why there can be no Slurm here; empty: there can."""
    for program in ("slurmctld", "slurmd", "munged", "sbatch", "unshare"):
        if shutil.which(program) is None:
            return f"there is no program {program} (Debian: slurm-wlm, munge)"
    if os.geteuid() != 0:
        return "only root may give nodes a /tmp of their own"
    made = subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "none", "/tmp"], capture_output=True, text=True)
    if made.returncode != 0:
        return f"mounting is not permitted: {made.stderr.strip()}"
    return ""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class LocalSlurm:
    def __init__(self, folder, processors=2, task_plugin="task/none", hosts=None, told_early=False):
        """`folder`: outside /tmp, which each node has for itself; its path is short (sockets). `hosts`: VirtualHosts that are the nodes,
        each with a cable of its own, and slurmctld and Slurm's commands sit at their switch. `told_early`: who is preempted gets the
        signal of --signal at once, not only when its time of grace is over."""
        self.folder = pathlib.Path(folder)
        self.hosts = hosts
        self.names = hosts.names if hosts else [f"s{k + 1}" for k in range(NODES)]
        self.daemons = {}
        for name in ("state", "run", "log", *(f"spool-{node}" for node in self.names)):
            (self.folder / name).mkdir(parents=True)
        self.folder.chmod(0o755)
        self._configure(processors, task_plugin, told_early)
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}
        try:
            self._start()
        except BaseException:
            self.close()
            raise

    def _configure(self, processors, task_plugin, told_early):
        port, slurmd_port, *ports = free_ports(2 + len(self.names))
        host = socket.gethostname()
        places = [(name, self.hosts.address(k)) if self.hosts else (host, "127.0.0.1") for k, name in enumerate(self.names)]
        nodes = "\n".join(f"NodeName={name} NodeHostname={its} NodeAddr={address} Port={own} CPUs={processors} RealMemory=4000"
                          for name, (its, address), own in zip(self.names, places, ports))
        configuration = CONFIGURATION + (TOLD_EARLY if told_early else "")
        (self.folder / "slurm.conf").write_text(configuration.format(
            host=host, address=self.hosts.at_switch() if self.hosts else "127.0.0.1",
            listening="NoInAddrAny" if self.hosts else "NoInAddrAny,NoCtldInAddrAny", port=port, slurmd_port=slurmd_port,
            folder=self.folder, task_plugin=task_plugin, nodes=nodes))
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)

    def _daemon(self, name, *words):
        log = open(self.folder / "log" / f"{name}.out", "wb")
        self.daemons[name] = subprocess.Popen(words, env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                              start_new_session=True)

    def _start(self):
        run = self.folder / "run"
        self._daemon("munged", "munged", "--foreground", "--force", f"--key-file={self.folder}/munge.key",
                     f"--socket={run}/munge.sock", f"--pid-file={run}/munged.pid", f"--log-file={self.folder}/log/munged.log",
                     f"--seed-file={run}/munge.seed")
        self._wait(lambda: (run / "munge.sock").exists(), "munged does not start")
        self._daemon("slurmctld", *self._here(), "slurmctld", "-D", "-c", "-f", str(self.folder / "slurm.conf"))
        for name in self.names:
            self.start_node(name)
        wanted = ["idle", str(len(self.names))]
        self._wait(lambda: self.run("sinfo", "-h", "-p", "main", "-o", "%T %D", check=False).stdout.split() == wanted,
                   "the nodes do not come up")

    def _here(self):
        """What leads a command to where slurmctld is."""
        return self.hosts.words_at_switch() if self.hosts else []

    def start_node(self, name):
        if self.hosts:
            daemon = ["slurmd", "-D", "-f", f"{self.folder}/slurm.conf", "-N", name]
            self._daemon(name, *self.hosts.words(self.names.index(name), daemon, self.folder))
            return
        # Open MPI's and PMIx's files of one node must not lie where another node has its own.
        self._daemon(name, "unshare", "-m", "sh", "-c", "mount -t tmpfs none /tmp && mount -t tmpfs none /dev/shm && "
                     f"exec slurmd -D -f {self.folder}/slurm.conf -N {name}")

    def _wait(self, condition, complaint, seconds=30):
        limit = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > limit:
                raise RuntimeError(f"{complaint}; see {self.folder}/log")
            time.sleep(0.1)

    def run(self, *words, check=True):
        done = subprocess.run([*self._here(), *words], env=self.environment, capture_output=True, text=True)
        if check and done.returncode != 0:
            raise RuntimeError(f"{' '.join(words)} says {done.stderr.strip()}")
        return done

    def has_pmix(self):
        listed = self.run("srun", "--mpi=list", check=False)
        return "pmix" in listed.stdout + listed.stderr

    def submit(self, *words):
        """sbatch with these options and a script; returns the job's number."""
        return self.run("sbatch", "--parsable", *words).stdout.strip()

    def facts(self, job):
        """What Slurm says of a job, one dictionary for each task of an array: JobState, Restarts, ..."""
        text = self.run("scontrol", "-o", "show", "job", str(job), check=False).stdout
        return [dict(word.split("=", 1) for word in line.split() if "=" in word) for line in text.splitlines()]

    def states(self, job):
        return [facts["JobState"] for facts in self.facts(job)]

    def hurry(self, job):
        """A requeued job may begin soon: Slurm would have it wait for two minutes. Not at once, or a node that still ends the job's life
        before refuses the next one, and the job is FAILED ("Job credential revoked")."""
        for facts in self.facts(job):
            if facts.get("Reason") != "BeginTime":
                continue
            begin = time.mktime(time.strptime(facts["EligibleTime"], "%Y-%m-%dT%H:%M:%S"))
            if begin - time.time() > 2 * SOON:
                self.run("scontrol", "update", f"jobid={facts['JobId']}", f"starttime=now+{SOON}", check=False)

    def wait(self, job, seconds, states=("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY")):
        """Waits until each of a job's tasks is in one of these states; returns them, None where that takes longer."""
        limit = time.monotonic() + seconds
        while time.monotonic() < limit:
            now = self.states(job)
            if now and all(state in states for state in now):
                return now
            self.hurry(job)
            time.sleep(0.2)
        return None

    def crash(self, name):
        """The node's daemon and all that runs there end at once, and its network where it is a virtual host."""
        if self.hosts:
            self.hosts.crash(self.names.index(name))
            self.daemons.pop(name).wait()
            return
        for pid in self.processes(name):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.daemons.pop(name).wait()

    def processes(self, name):
        """Processes of a node: they share its mount namespace."""
        first = self.hosts.inits[self.names.index(name)] if self.hosts else self.daemons[name].pid
        space = os.readlink(f"/proc/{first}/ns/mnt")
        found = []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if os.readlink(process / "ns/mnt") == space:
                    found.append(int(process.name))
            except OSError:
                pass
        return found

    def close(self):
        if "slurmctld" in self.daemons:
            self.run("scancel", "-u", "root", "--signal=KILL", check=False)
            self.run("scancel", "-u", "root", check=False)
        for name in self.names:
            if name in self.daemons:
                self.crash(name)
        for name in ("slurmctld", "munged"):
            if name in self.daemons:
                self.daemons[name].kill()
                self.daemons.pop(name).wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
