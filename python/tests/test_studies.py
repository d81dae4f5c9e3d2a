"""Studies on many workers: the same document for any executor, split and order, with workers that
are killed among them."""

import multiprocessing
import os
import pickle
import shutil
import signal
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import lindstedt as ls
import pytest
from lindstedt.studies import GivenUp

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
PROGRAM = [sys.executable, "-m", "lindstedt"]


def small():
    """A study of six motions."""
    return ls.Study(zeta=[0.01, 0.02, 0.03], barrier=[0.1, 0.2])


def kill_once(marker, work, *arguments):
    """The work, but the first process that comes here is killed."""
    try:
        os.close(os.open(marker, os.O_CREAT | os.O_EXCL))
    except FileExistsError:
        return work(*arguments)
    os.kill(os.getpid(), signal.SIGKILL)


class KillingPool:
    """An executor that kills one of its workers."""

    def __init__(self, pool, marker):
        self.pool, self.marker = pool, str(marker)

    def submit(self, work, *arguments):
        return self.pool.submit(kill_once, self.marker, work, *arguments)


@pytest.fixture(scope="module")
def spawned():
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        yield pool


STUDIES = {
    "sweep": small,
    "equation": lambda: ls.Study(
        "x'' + x'/5 + x^3 = F*cos(t)", F=(0, 1, 5), x=1, until=20, every="2*pi"
    ),
    "tables": lambda: ls.Study({"damping": {"zeta": 0.02}}, alpha=[0, 0.01]),
    "materials": lambda: ls.Study(command="materials"),
    "optimize": lambda: ls.Study(command="optimize", runs=3, budget=1500, seed=7),
    "audit": lambda: ls.Study(EXAMPLES / "audit" / "paper.toml", "audit"),
}


@pytest.mark.parametrize("name", STUDIES)
def test_processes(name, spawned):
    study = STUDIES[name]()
    whole = study.run()
    points = len(study)
    for tasks in (1, 2, points + 1):
        assert study.run(executor=spawned, tasks=tasks).equals(whole), tasks
    assert pickle.loads(pickle.dumps(study)).words("1/2") == study.words("1/2")


def test_a_study_is_the_command():
    found = small().run()
    same = ls.simulate(sweep={"zeta": [0.01, 0.02, 0.03], "barrier": [0.1, 0.2]})
    assert found.equals(same) and not found.equals(small().run().json())
    assert found.to_pandas().equals(same.to_pandas())
    assert dict(found.to_xarray().sizes) == {"zeta": 3, "barrier": 2}


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not forked here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_processes_that_are_forked_after_the_threads_began():
    whole = small().run()
    context = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        assert small().run(executor=pool, tasks=3).equals(whole)


def test_progress_and_errors(spawned):
    told = []
    small().run(executor=spawned, tasks=3, progress=lambda *parts: told.append(parts))
    assert [done for done, _ in told] == [2, 4, 6] and {total for _, total in told} == {6}

    def stop(done, total):
        raise InterruptedError

    with pytest.raises(InterruptedError):
        small().run(executor=spawned, tasks=3, progress=stop)
    with pytest.raises(ls.Refused, match="kappa"):
        ls.Study(kappa=[1, 2]).run(executor=spawned)
    with pytest.raises(ls.UsageError, match="cannot be split"):
        ls.Study("pendulum", "derive")


def test_a_worker_that_is_killed(tmp_path):
    whole = small().run()
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        killing = KillingPool(pool, tmp_path / "killed")
        assert small().run(executor=killing, tasks=3).equals(whole)
    assert (tmp_path / "killed").exists()


def test_workers_that_do_not_have_the_file(tmp_path, monkeypatch):
    home, away = tmp_path / "home", tmp_path / "away"
    home.mkdir()
    away.mkdir()
    shutil.copy(EXAMPLES / "simulate" / "damper.toml", home)
    monkeypatch.chdir(home)
    study = ls.Study("damper.toml", zeta=[0.01, 0.02, 0.03])
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, context, initializer=os.chdir, initargs=(away,)) as pool:
        assert study.run(executor=pool, tasks=2).equals(study.run())


def test_an_executor_that_is_shut_down():
    pool = ThreadPoolExecutor(1)
    pool.shutdown()
    assert small().run(executor=pool, tasks=2).equals(small().run())


def test_dask(tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, distributed.Client(cluster) as client:
        pool = client.get_executor()
        whole = small().run()
        assert small().run(executor=pool, tasks=4).equals(whole)
        killing = KillingPool(pool, tmp_path / "killed")
        assert small().run(executor=killing, tasks=4).equals(whole)
    assert (tmp_path / "killed").exists()


def test_mpi(tmp_path):
    pytest.importorskip("mpi4py")
    beside = Path(sys.executable).parent / "mpirun"
    mpirun = str(beside) if beside.exists() else shutil.which("mpirun")
    if mpirun is None:
        pytest.skip("there is no mpirun")
    script = tmp_path / "study.py"
    script.write_text(
        "import lindstedt as ls\n"
        "from mpi4py.futures import MPIPoolExecutor\n"
        "if __name__ == '__main__':\n"
        "    study = ls.Study(zeta=[0.01, 0.02, 0.03], barrier=[0.1, 0.2])\n"
        "    with MPIPoolExecutor() as pool:\n"
        "        study.run(executor=pool, tasks=4).save('study.json')\n"
    )
    words = [mpirun, "-n", "2", sys.executable, "-m", "mpi4py.futures", str(script)]
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    environment = os.environ | root | {"OMPI_MCA_rmaps_base_oversubscribe": "1"}
    done = subprocess.run(
        words, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / "study.json").read_text() == small().run().json()


def sbatch(script):
    """Runs the jobs of an array as `sbatch` does, the last one first."""
    option = "#SBATCH --array="
    (array,) = [line for line in script.read_text().splitlines() if line.startswith(option)]
    jobs = []
    for part in array.removeprefix(option).split(","):
        first, _, last = part.partition("-")
        jobs += range(int(first), int(last or first) + 1)
    for job in reversed(jobs):
        environment = os.environ | {"SLURM_ARRAY_TASK_ID": str(job)}
        subprocess.run(["sh", str(script)], env=environment, cwd="/", check=True)
    return jobs


@pytest.mark.skipif(os.name != "posix", reason="a script of the shell")
@pytest.mark.parametrize("name", ["sweep", "equation", "tables"])
def test_an_array_of_jobs(name, tmp_path):
    study = STUDIES[name]()
    script = tmp_path / "job of a study.sh"
    study.slurm_array(script, tasks=3, options=["--mem=1G"])
    assert "#SBATCH --mem=1G\n" in script.read_text()
    assert sbatch(script) == [1, 2, 3]
    lines = tmp_path / "out" / "*.jsonl"
    whole = study.run()
    assert ls.collect(lines).equals(whole) and ls.missing_shards(lines) == []
    with pytest.raises(ls.UsageError, match="nothing is missing"):
        study.slurm_array(script, tasks=3, missing=lines)
    # One job was killed within a line, another one never began.
    first, second = tmp_path / "out" / "1.jsonl", tmp_path / "out" / "2.jsonl"
    first.write_text(first.read_text()[:-9])
    second.unlink()
    with pytest.raises(ls.Refused, match="points are missing") as why:
        ls.collect(lines)
    assert "1.jsonl, line" in str(why.value) and "--shard=2/3" in why.value.help
    study.slurm_array(script, tasks=3, missing=lines)
    assert sbatch(script) == [1, 2]
    assert ls.collect([first, second, tmp_path / "out" / "3.jsonl"]).equals(whole)
    with pytest.raises(ls.UsageError, match="no file matches"):
        ls.collect(tmp_path / "none" / "*.jsonl")


def test_a_shard_that_is_killed_half_way(tmp_path):
    # A pipe holds less than its lines, so that it cannot have ended when it is killed.
    words = ["simulate", "--sweep=zeta=0.2:0.6:1500", "--shard=1/2"]
    process = subprocess.Popen([*PROGRAM, *words], stdout=subprocess.PIPE)
    part = process.stdout.read(20_000)
    process.kill()
    process.stdout.close()
    process.wait()
    killed, other = tmp_path / "1.jsonl", tmp_path / "2.jsonl"
    killed.write_bytes(part)
    whole = ls.simulate(sweep="zeta=0.2:0.6:1500")
    study = ls.Study(sweep={"zeta": (0.2, 0.6, 1500)})
    shard = subprocess.run([*PROGRAM, *words[:2], "--shard=2/2"], stdout=subprocess.PIPE)
    other.write_bytes(shard.stdout)
    assert ls.missing_shards([killed, other]) == ["1/2"]
    with pytest.raises(ls.Refused, match="1.jsonl, line [0-9]+ is cut off"):
        ls.collect([killed, other])
    again = tmp_path / "again.jsonl"
    again.write_bytes(subprocess.run([*PROGRAM, *words], stdout=subprocess.PIPE).stdout)
    assert ls.collect([killed, other, again]).equals(whole)
    assert study.run().equals(whole)


class KeepingPool(ThreadPoolExecutor):
    """Threads that keep what they were given."""

    def __init__(self):
        super().__init__(1)
        self.given = []

    def submit(self, work, *arguments):
        self.given.append(super().submit(work, *arguments))
        return self.given[-1]


def test_shards_that_run_in_threads_stop_where_the_study_is_given_up():
    def give_up(done, total):
        raise RuntimeError("enough")

    study = ls.Study("x'' + c*x' + sin(x) = 0", x=1.5, until=2000, c=(0.001, 0.002, 1200))
    with KeepingPool() as pool:
        with pytest.raises(RuntimeError, match="enough"):
            study.run(executor=pool, tasks=3, progress=give_up)
    first, second, third = pool.given
    assert first.result().count("\n") == 401
    assert isinstance(second.exception(), GivenUp)
    assert third.cancelled()
