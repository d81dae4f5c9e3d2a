"""A study on machines that reach each other over a network alone: a scheduler of dask and its workers,
each in a network namespace with addresses of its own and a folder of its own."""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import lindstedt as ls
import pytest

pytest.importorskip("distributed")

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
#: The machines with their addresses: a network for documentation (RFC 5737), which no machine is in.
MACHINES = {"scheduler": "198.51.100.1", "first": "198.51.100.2", "second": "198.51.100.3"}
SCHEDULER, *WORKERS = MACHINES
#: Where the scheduler listens; the namespace has no other programs.
ADDRESS = f"tcp://{MACHINES[SCHEDULER]}:8786"
#: Seconds that anything may take before it counts as never done.
PATIENCE = 120

#: A user's program: a study by the executor of the scheduler. A task writes the network that it is in
#: into the folder, and waits until one on the other worker has done so too, so that neither is left
#: idle. The worker named `kill` is then killed within its task.
DRIVER = f'''
import os, signal, sys, time
from pathlib import Path

import lindstedt as ls
from distributed import Client

folder, kill = Path(sys.argv[1]), sys.argv[2]

def met(work, *arguments):
    """The work, once both workers have begun one."""
    me = Path.cwd().name
    (folder / me).write_text(os.readlink("/proc/self/ns/net"))
    end = time.monotonic() + {PATIENCE}
    while len(list(folder.iterdir())) < 2:
        if time.monotonic() > end:
            raise TimeoutError("the other worker never began")
        time.sleep(0.01)
    if me == kill:
        os.kill(os.getpid(), signal.SIGKILL)
    return work(*arguments)

class Pool:
    """The executor of dask, whose tasks meet."""

    def __init__(self, pool):
        self.pool = pool

    def submit(self, work, *arguments):
        return self.pool.submit(met, work, *arguments)

with Client("{ADDRESS}", timeout={PATIENCE}) as client:
    client.wait_for_workers(2, timeout={PATIENCE})
    # The file is beside this program, and neither worker has it.
    study = ls.Study("damper.toml", zeta=[0.01, 0.02, 0.03], barrier=[0.1, 0.2])
    print(study.run(executor=Pool(client.get_executor()), tasks=6).json(), end="")
    print(*client.scheduler_info()["workers"], file=sys.stderr)
'''


def ip(*words):
    """Runs `ip`; the error has what it says."""
    done = subprocess.run(["ip", *words], capture_output=True, text=True)
    if done.returncode != 0:
        raise OSError(f"ip {' '.join(words)}: {done.stderr.strip()}")


@pytest.fixture
def namespaces():
    """The namespaces of the machines, joined by a bridge in that of the scheduler. Nothing is added to
    the network of this machine, and with the namespaces all that is in them is gone."""
    if shutil.which("ip") is None:
        pytest.skip("there is no `ip` to make network namespaces")
    names = {machine: f"lindstedt-{os.getpid()}-{machine}" for machine in MACHINES}

    def ended(*_):
        raise KeyboardInterrupt

    # Who ends the tests does not leave the namespaces behind.
    before = signal.signal(signal.SIGTERM, ended)
    try:
        try:
            for name in names.values():
                ip("netns", "add", name)
            hub = names[SCHEDULER]
            ip("-n", hub, "link", "add", "bridge", "type", "bridge")
            ip("-n", hub, "address", "add", f"{MACHINES[SCHEDULER]}/24", "dev", "bridge")
            ip("-n", hub, "link", "set", "bridge", "up")
            for worker in WORKERS:
                far = ("peer", "name", "wire", "netns", names[worker])
                ip("-n", hub, "link", "add", worker, "type", "veth", *far)
                ip("-n", hub, "link", "set", worker, "master", "bridge", "up")
                ip("-n", names[worker], "address", "add", f"{MACHINES[worker]}/24", "dev", "wire")
                ip("-n", names[worker], "link", "set", "wire", "up")
            for name in names.values():
                ip("-n", name, "link", "set", "lo", "up")
        except OSError as why:
            pytest.skip(f"network namespaces cannot be made: {why}")
        yield names
    finally:
        for name in names.values():
            subprocess.run(["ip", "netns", "delete", name], capture_output=True)
        signal.signal(signal.SIGTERM, before)


def on(name, *words):
    """The words of Python in a namespace."""
    return ["ip", "netns", "exec", name, sys.executable, *map(str, words)]


@contextlib.contextmanager
def cluster(namespaces, folder):
    """A scheduler and the workers, each in its namespace and its folder. A worker that is killed is not
    begun again, as a machine that is lost."""
    # What is left behind, were this process killed, ends by itself.
    asked = ["--no-dashboard", "--idle-timeout", f"{PATIENCE} seconds"]
    programs = {SCHEDULER: ["scheduler", "--host", MACHINES[SCHEDULER], *asked]}
    asked = ["--no-nanny", "--no-dashboard", "--nthreads", "1", "--death-timeout", f"{PATIENCE}"]
    for worker in WORKERS:
        programs[worker] = ["worker", ADDRESS, "--host", MACHINES[worker], *asked]
    running = {}
    try:
        for machine, (program, *words) in programs.items():
            place = folder / machine
            place.mkdir()
            with open(place / "log", "w") as log:
                running[machine] = subprocess.Popen(
                    on(namespaces[machine], "-m", f"distributed.cli.dask_{program}", *words),
                    cwd=place, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                )
        yield running
    finally:
        for process in running.values():
            process.kill()
        for process in running.values():
            process.wait()


@pytest.mark.parametrize("kill", ["nobody", "second"])
def test_two_machines(namespaces, tmp_path, kill):
    begun, home = tmp_path / "begun", tmp_path / "home"
    begun.mkdir()
    home.mkdir()
    (home / "study.py").write_text(DRIVER)
    problem = shutil.copy(EXAMPLES / "simulate" / "damper.toml", home)
    with cluster(namespaces, tmp_path) as running:
        done = subprocess.run(
            on(namespaces[SCHEDULER], "study.py", begun, kill),
            cwd=home, capture_output=True, text=True, timeout=4 * PATIENCE,
        )
        logs = "".join((tmp_path / machine / "log").read_text() for machine in running)
        assert done.returncode == 0, done.stderr + logs
        ended = {machine for machine, process in running.items() if process.poll() is not None}
    study = ls.Study(problem, zeta=[0.01, 0.02, 0.03], barrier=[0.1, 0.2])
    assert done.stdout == study.run().json()
    # Both did part of the work, each in its own network, which is not that of this process.
    networks = {worker: (begun / worker).read_text() for worker in WORKERS}
    assert len({*networks.values(), os.readlink("/proc/self/ns/net")}) == 3
    assert ended == {kill} - {"nobody"}
    for worker in WORKERS:
        assert (f"tcp://{MACHINES[worker]}:" in done.stderr) == (worker != kill)
