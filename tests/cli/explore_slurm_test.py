#!/usr/bin/env python3
"""A sweep goes through a real Slurm of one node; a job of it is killed half-way, and the sweep is done all the same. Skipped where Slurm cannot start."""
import os
import pathlib
import re
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time

PROGRAM = sys.argv[1]
SKIPPED = 77
SWEEP = """
[[scene]]
file = "builtin:materials"
size = "48x27"
[vary]
gpu.cores = [1, 2, 3, 4]
l2.cache_lines = { from = 512, to = 2048, step = 256 }
"""
CONFIGURATION = """
ClusterName=quadrille
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser={user}
SlurmctldPort={port}
SlurmdPort={next_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
KillWait=1
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Slurm:
    """munged, slurmctld and slurmd in a folder of their own."""

    def __init__(self, folder):
        self.folder, self.running = folder, []
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}

    def start(self):
        for program in ("munged", "slurmctld", "slurmd", "sbatch"):
            if shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin") is None:
                skip(f"{program} is not installed; scripts/setup check installs it")
        if os.geteuid() != 0:
            skip("slurmd has to run as root")
        folder = self.folder
        folder.chmod(0o755)
        for name in ("state", "spool"):
            (folder / name).mkdir()
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        (folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname().split(".")[0], folder=folder, user="root", port=free_port(), next_port=free_port()))
        self.spawn("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder}/munge.socket", f"--pid-file={folder}/munged.pid",
                   f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed")
        time.sleep(0.5)
        self.spawn("slurmctld", "-D")
        self.spawn("slurmd", "-D")
        for _ in range(100):
            if self.ask("sinfo", "--noheader", "--format", "%t").strip() == "idle":
                return
            time.sleep(0.2)
        skip("slurmd does not start here: " + (folder / "slurmd.out").read_text()[-300:])

    def spawn(self, program, *arguments):
        path = shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin")
        output = open(self.folder / f"{program}.out", "w")
        self.running.append(subprocess.Popen([path, *arguments], env=self.environment, stdout=output, stderr=output))

    def ask(self, *command):
        try:
            return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=10).stdout
        except subprocess.TimeoutExpired:
            return ""

    def stop(self):
        for process in reversed(self.running):
            process.terminate()
            try:
                process.wait(5)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def rows(path):
    if not path.exists():
        return {}
    database = sqlite3.connect(path)
    try:
        return {row[:2]: row[2:] for row in database.execute("SELECT scene_hash, machine_hash, status, cycles FROM points")}
    except sqlite3.OperationalError:
        return {}
    finally:
        database.close()


def explore(slurm, folder, *more):
    return subprocess.Popen([PROGRAM, "explore", "sweep.toml", *more], cwd=folder, env=slurm.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def main():
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        slurm = Slurm(folder)
        try:
            slurm.start()
            work = folder / "work"
            work.mkdir()
            (work / "sweep.toml").write_text(SWEEP)
            run = explore(slurm, work, "--backend", "slurm", "--parts", "2")
            started = time.monotonic()
            while len(rows(work / "sweep.slurm" / "part-0.db")) < 2 and time.monotonic() - started < 60:
                time.sleep(0.05)
            # The program that waits is killed, and a task of the job. The job goes on without the one, Slurm without the other.
            run.send_signal(signal.SIGKILL)
            run.communicate()
            job = (work / "sweep.slurm" / "job").read_text().strip()
            slurm.ask("scancel", f"{job}_0")
            done_then = len(rows(work / "sweep.slurm" / "part-0.db"))
            run = explore(slurm, work, "--backend", "slurm", "--parts", "2")
            out, err = run.communicate(timeout=600)
            assert run.returncode == 0, err
            here = explore(slurm, work, "--out", "here.db")
            _, said = here.communicate(timeout=600)
            assert here.returncode == 0, said
            through, local = rows(work / "sweep.db"), rows(work / "here.db")
            assert len(local) == 28 and through == local, f"{len(through)} points through Slurm, {len(local)} here, {err}"
            jobs = set(re.findall(r"job (\d+) draws", err)) | {job}
            assert len(jobs) > 1, "what the killed task had not drawn was not submitted again"
            print(f"28 points; the first task was killed after {done_then} of its 14; jobs {sorted(jobs)}")
            assert done_then < 14, "the task was done before it was killed"
        finally:
            slurm.stop()


main()
