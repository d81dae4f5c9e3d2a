"""Studies of many points, on one machine or on many.

A study is a command with many points that do not depend on each other: the motions of a sweep, the
materials of a table, the runs of a search, the claims of a publication. It is split into shards,
the program's `--shard I/N`, whose lines of JSON are put together as `lindstedt collect` does. Order
and bits are those of the undivided command, for any split and any number of workers.

>>> import lindstedt as ls
>>> from concurrent.futures import ThreadPoolExecutor
>>> study = ls.Study(zeta=[0.01, 0.02, 0.03], barrier=[0.1, 0.2])
>>> len(study)
6
>>> with ThreadPoolExecutor(2) as pool:
...     table = study.run(executor=pool, tasks=3)
>>> table.equals(study.run())
True
"""

from __future__ import annotations

import glob
import inspect
import json
import os
import shlex
import subprocess
import sys
from collections.abc import Generator, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from contextlib import closing
from typing import Any, Union
from uuid import uuid4

from . import commands
from ._call import Call, Problem, Progress, Values, answer, asked, is_many
from ._lindstedt import run as run_words
from .errors import LostPoints, UsageError

#: A file, a pattern with `*`, or several of them.
Files = Union[str, "os.PathLike[str]", Iterable[Union[str, "os.PathLike[str]"]]]

#: The commands that can be split.
COMMANDS = ("simulate", "materials", "optimize", "audit", "paper")
#: The shard that only a study of a million points has points in: its first line tells their number.
LAST_OF_ALL = "1000000/1000000"
#: The tasks of a study where nothing else is asked for.
USUAL_TASKS = 64
#: The errors of executors whose worker is gone, by their names: `distributed` is not imported here.
OF_LOST_WORKERS = ("KilledWorker", "CommClosedError")


#: The runs of studies that have been given up: workers that are threads of this process stop.
GIVEN_UP: set[str] = set()


class GivenUp(Exception):
    """The run of the study to which a shard belongs has been given up."""


def lines_of(words: Sequence[str], input: str | None = None, run: str | None = None) -> str:
    """The lines of a shard: what a worker does; `run` is the name of the run of the study."""

    def watch(_done: int, _all: int) -> None:
        if run in GIVEN_UP:
            raise GivenUp

    return run_words(words, input, watch if run else None)[0]


class Study:
    """A command with many points, to be run at once, by an executor, or as an array of jobs.

    Args:
        problem: An equation, an `Oscillator`, a name of the catalogue, the path of a problem file,
            or the tables of one.
        command: `simulate`, `materials`, `optimize`, `audit` or `paper`.
        sweep: What is varied, beside the keywords, `{"lambda": [0.1, 0.2]}`.
        at: Values of symbols whose names are options or no words.
        **keywords: Options of the command; lists, arrays and `(from, to, count)` of a sweep; values
            of symbols, exact where they are text or fractions.
    """

    def __init__(
        self,
        problem: Problem | None = None,
        command: str = "simulate",
        *,
        sweep: Mapping[str, Any] | None = None,
        at: Values | None = None,
        **keywords: Any,
    ) -> None:
        if command not in COMMANDS:
            raise UsageError(f"{command} cannot be split: choose one of {', '.join(COMMANDS)}")
        known = inspect.signature(getattr(commands, command)).parameters
        options: dict[str, Any] = {"at": at} if at is not None else {}
        axes, values = dict(sweep or {}), {}
        for name, value in keywords.items():
            if name in known and name not in ("problem", "values", "progress"):
                options[name] = value
            elif is_many(value) or isinstance(value, tuple):
                axes[name] = value
            else:
                values[name] = value
        if axes:
            options["sweep"] = axes
        self.problem = problem
        self.call: Call = asked(command, problem, options, values)

    def __len__(self) -> int:
        """The number of points.

        Raises:
            Refused: The problem is refused.
        """
        head = lines_of(self.words(LAST_OF_ALL), self.call.input).partition("\n")[0]
        return int(json.loads(head)["total"])

    def words(self, shard: str) -> list[str]:
        """The words of the program for a shard, `"3/64"`."""
        return words_of_shard(self.call, shard)

    def _sent(self) -> Call:
        """The call that workers get: with the text of its file, for on their machines, or in their
        working folders, there may be none of that name."""
        *words, problem = self.call.words
        if "--" not in words or not os.path.isfile(problem):
            return self.call
        with open(problem, encoding="utf-8") as file:
            return Call((*words, "-"), file.read())

    def run(
        self,
        executor: Executor | None = None,
        tasks: int | None = None,
        retries: int = 2,
        progress: Progress | None = None,
    ) -> Any:
        """Runs the study and returns its result, that of the command in one piece.

        Args:
            executor: Any `concurrent.futures.Executor`: of processes, of dask, of mpi4py; without it
                the command runs in this process, on all cores.
            tasks: The number of shards that the executor gets; 64 without it, or as many as there
                are points.
            retries: How often a shard is given to the executor again whose worker was lost. After
                that, or where the executor is broken, it runs in a process of its own, once.
            progress: Is called with the points done and all of them; an exception ends the work.

        Raises:
            Refused: The problem is refused.
            LostPoints: The process of a shard ended without its lines, again and again.
        """
        if executor is None:
            return answer(self.call, progress)
        total = len(self)
        call = self._sent()
        tasks = tasks or max(1, min(total, USUAL_TASKS))
        done: list[str] = []
        shards = [f"{place}/{tasks}" for place in range(1, tasks + 1)]
        points = 0
        for _ in range(retries + 1):
            lost: list[str] = []
            # It is closed at once where the progress ends the work, so that running shards stop.
            with closing(by(executor, call, shards, lost)) as results:
                for shard, lines in results:
                    done.append(lines)
                    points += lines.count("\n") - 1
                    if progress is not None:
                        progress(points, total)
            shards = lost
            if not shards:
                break
        for shard in shards:
            done.append(alone(call, shard))
        return joined(done)

    def slurm_array(
        self,
        path: str | os.PathLike[str],
        tasks: int = USUAL_TASKS,
        *,
        out: str | os.PathLike[str] = "out",
        missing: Files | None = None,
        program: Sequence[str] | None = None,
        options: Sequence[str] = (),
    ) -> None:
        """Writes the script of an array of jobs for `sbatch`; job I writes the lines of shard I.

        Args:
            path: The script. Tables of a problem go into a file beside it.
            tasks: The number of jobs.
            out: The folder of the lines, `out/1.jsonl` and so on, below the folder of the script.
            missing: The lines that are there already: the array has only the jobs of those that are
                missing, to be submitted once more.
            program: The words of the program; this Python and `-m lindstedt` without it.
            options: Lines for `sbatch`, `"--mem=1G"`.

        Raises:
            UsageError: Nothing is missing, or the lines were split otherwise.
        """
        wanted = f"1-{tasks}"
        if missing is not None:
            shards = [shard.split("/") for shard in missing_shards(missing)]
            if not shards:
                raise UsageError("nothing is missing: there is nothing to submit")
            if any(int(of) != tasks for _, of in shards):
                raise UsageError(f"the lines are those of {shards[0][1]} shards, not of {tasks}")
            wanted = ",".join(shard for shard, _ in shards)
        words = self.words(f"$SLURM_ARRAY_TASK_ID/{tasks}")
        script = os.path.abspath(path)
        if self.call.input is not None:
            file = os.path.splitext(script)[0] + ".toml"
            with open(file, "w", encoding="utf-8") as problem:
                problem.write(self.call.input)
            words[-1] = file
        elif "--" in words and os.path.isfile(words[-1]):
            words[-1] = os.path.abspath(words[-1])
        quoted = [
            '--shard="$SLURM_ARRAY_TASK_ID"' + f"/{tasks}" if "$SLURM" in word else shlex.quote(word)
            for word in words
        ]
        named = program or [sys.executable, "-m", "lindstedt"]
        folder = shlex.quote(os.path.join(os.path.dirname(script), os.fspath(out)))
        lines = [
            "#!/bin/sh",
            "#SBATCH --job-name=lindstedt",
            f"#SBATCH --array={wanted}",
            *(f"#SBATCH {option}" for option in options),
            "set -e",
            f"mkdir -p {folder}",
            f"exec {shlex.join(named)} {' '.join(quoted)} \\",
            f'    > {folder}/"$SLURM_ARRAY_TASK_ID".jsonl',
        ]
        with open(script, "w", encoding="utf-8") as file_of_script:
            file_of_script.write("\n".join(lines) + "\n")


def words_of_shard(call: Call, shard: str) -> list[str]:
    """The words of the program for a shard of a call."""
    command, *rest = call.words
    return [command, f"--shard={shard}", *rest]


def by(
    executor: Executor, call: Call, shards: list[str], lost: list[str]
) -> Generator[tuple[str, str], None, None]:
    """Each shard with its lines as it is done; those whose workers are gone are added to `lost`."""
    running: dict[Future[str], str] = {}
    run = uuid4().hex
    try:
        for shard in shards:
            words = words_of_shard(call, shard)
            running[executor.submit(lines_of, words, call.input, run)] = shard
    except (BrokenExecutor, RuntimeError):
        lost += [shard for shard in shards if shard not in running.values()]
    pending = set(running)
    try:
        while pending:
            finished, pending = wait(pending, return_when=FIRST_COMPLETED)
            for future in finished:
                try:
                    lines = future.result()
                except Exception as error:
                    if not is_lost_worker(error):
                        raise
                    lost.append(running[future])
                else:
                    yield running[future], lines
    finally:
        if pending:
            GIVEN_UP.add(run)
        for future in pending:
            future.cancel()


def alone(call: Call, shard: str) -> str:
    """The lines of a shard by the program, in a process of its own."""
    words = [sys.executable, "-m", "lindstedt", *words_of_shard(call, shard)]
    done = subprocess.run(words, input=call.input or "", capture_output=True, text=True)
    if done.returncode != 0:
        raise LostPoints(
            f"the process of shard {shard} ended with code {done.returncode}: "
            f"{done.stderr.strip() or 'it was killed'}",
            shard,
        )
    return done.stdout


def is_lost_worker(error: BaseException) -> bool:
    """Whether an error is that of an executor whose worker is gone, not one of the work."""
    names = {cls.__name__ for cls in type(error).__mro__}
    gone = (BrokenExecutor, CancelledError, ConnectionError)
    return isinstance(error, gone) or not names.isdisjoint(OF_LOST_WORKERS)


def joined(parts: Iterable[str]) -> Any:
    """The result of a study from the lines of its shards."""
    # A line that a killed process left unfinished ends here too.
    text = "".join(part if part.endswith("\n") else part + "\n" for part in parts)
    return answer(Call(("collect", "--", "-"), text))


def found(files: Files) -> list[str]:
    """The names of files, in order, those of patterns among them."""
    if isinstance(files, (str, os.PathLike)):
        name = os.fspath(files)
        names = sorted(glob.glob(name)) if glob.has_magic(name) else [name]
    else:
        names = [name for file in files for name in found(file)]
    if not names:
        raise UsageError(f"no file matches {files}")
    return names


def collect(files: Files) -> Any:
    """Puts the lines of the shards of a study together: the result of the command in one piece.

    Args:
        files: The files of the lines in any order: names or patterns, `"out/*.jsonl"`.

    Raises:
        Refused: Points are missing, with the shards that are to run again, or lines contradict each
            other or belong to several studies.
        UsageError: There is no such file.
    """
    return answer(Call(("collect", "--", *found(files))))


def missing_shards(files: Files) -> list[str]:
    """The shards of a study that are to run again, `["3/64"]`; none where all points are there.

    Raises:
        Refused: No line says what was asked, or lines belong to several studies.
    """
    return lines_of(["collect", "--missing", "--", *found(files)]).split()
