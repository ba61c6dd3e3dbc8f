# SPDX-License-Identifier: MIT
"""Many embeddings, here or on the workers of a Dask scheduler.

    python3 -m orbitutte.batch MANIFEST.csv -o DIR [options of `orbitutte batch`]
    python3 -m orbitutte.batch MANIFEST.csv -o DIR --scheduler tcp://HOST:8786 [options]

Without a scheduler this is `orbitutte batch`. With one, each worker runs single jobs of the same manifest by the same program, whose place
on the workers --program gives; this process alone writes DIR/jobs.jsonl, a line as each job ends. Workers see the files under the same
paths. A job whose worker dies is run by another one. Started again, only unfinished jobs run.
"""
from __future__ import annotations

import argparse
import contextlib
import fcntl
import json
import os
import pathlib
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from typing import Any

FILE_TROUBLE, WRONG_USAGE = 1, 2


class BatchError(Exception):
    """What ends a batch: a sentence, and the exit code."""

    def __init__(self, sentence: str, code: int) -> None:
        super().__init__(sentence)
        self.code = code


def run_job(program: str, arguments: Sequence[str], job: int, folder: str) -> str:
    """Runs one job in a process and returns its record, a line of JSON. Workers call it."""
    import subprocess

    command = [program, "batch", *arguments, "--job", str(job)]
    done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if not done.stdout.endswith("\n"):
        raise RuntimeError(f"job {job} has no record: {done.stderr.strip() or f'exit code {done.returncode}'}")
    return done.stdout


@contextlib.contextmanager
def locked_log(path: pathlib.Path) -> Iterator[int]:
    """The descriptor of a file to which no other batch appends, without the part of a line that a killed one left at its end."""
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise BatchError(f"{path}: another batch is at work on it; wait for its end, or name another folder", FILE_TROUBLE) from None
        os.ftruncate(descriptor, path.read_bytes().rfind(b"\n") + 1)
        yield descriptor
    finally:
        os.close(descriptor)


def append(descriptor: int, line: str) -> None:
    """Adds a line in one piece, and waits until it is on the disk."""
    data = line.encode()
    if os.write(descriptor, data) != len(data):
        raise BatchError("a record could not be written", FILE_TROUBLE)
    os.fsync(descriptor)


def unfinished_jobs(program: str, arguments: Sequence[str]) -> tuple[list[int], int]:
    """The numbers of the jobs that are to be run, and how many there are in all."""
    listed = subprocess.run([program, "batch", *arguments, "--list"], stdout=subprocess.PIPE, text=True)
    if listed.returncode:
        raise BatchError("", listed.returncode)  # the program has said it
    jobs = [json.loads(line) for line in listed.stdout.splitlines()]
    return [job["job"] for job in jobs if not job["done"]], len(jobs)


def run_on(scheduler: str, program: str, arguments: Sequence[str], jobs: Sequence[int], log: int) -> int:
    """Runs the jobs on the scheduler's workers and appends a record of each. How many have none, since they failed."""
    try:
        from distributed import Client, as_completed
    except ImportError:
        raise BatchError("--scheduler needs Dask's module 'distributed'; install it (Debian: python3-distributed)", FILE_TROUBLE) from None
    failed = 0
    try:
        client = Client(scheduler)
    except (OSError, ValueError) as error:
        raise BatchError(f"--scheduler is '{scheduler}', where no scheduler answers: {error}", FILE_TROUBLE) from None
    with client:
        futures: list[Any] = [client.submit(run_job, program, list(arguments), job, os.getcwd(), pure=False, retries=1) for job in jobs]
        for count, future in enumerate(as_completed(futures), 1):
            trouble = future.exception()  # waits again if the result went with its worker, so that another one makes it
            if trouble is None:
                append(log, future.result())
            else:
                failed += 1
                print(f"orbitutte.batch: {trouble}", file=sys.stderr)
            print(f"{count} of {len(futures)} jobs", end="\r" if sys.stderr.isatty() and count < len(futures) else "\n", file=sys.stderr)
            future.release()
    return failed


def program_path(given: str | None) -> str:
    program = given or os.environ.get("ORBITUTTE") or shutil.which("orbitutte")
    if not program:
        raise BatchError("the program 'orbitutte' is not on the PATH; give its path by --program", FILE_TROUBLE)
    return program


def parse(words: Sequence[str]) -> tuple[argparse.Namespace, list[str]]:
    parser = argparse.ArgumentParser(prog="python3 -m orbitutte.batch", description="Embed many meshes, here or on the workers of a Dask scheduler.",
                                     epilog="All other arguments are those of `orbitutte batch`.", allow_abbrev=False)
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="the folder of the results")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="the address of a Dask scheduler; without it, the jobs run here")
    parser.add_argument("--program", metavar="PATH", help="the program orbitutte, here and on the workers; that of the PATH if this is not given")
    return parser.parse_known_args(words)


def main(words: Sequence[str] | None = None) -> int:
    known, others = parse(sys.argv[1:] if words is None else words)
    arguments = [*others, "-o", known.output]
    try:
        program = program_path(known.program)
        if known.scheduler is None:
            return subprocess.call([program, "batch", *arguments])
        jobs, count = unfinished_jobs(program, arguments)
        folder = pathlib.Path(known.output)
        folder.mkdir(parents=True, exist_ok=True)
        with locked_log(folder / "jobs.jsonl") as log:
            jobs, count = unfinished_jobs(program, arguments)  # nobody else ends one from here on
            if len(jobs) < count:
                print(f"orbitutte.batch: {count - len(jobs)} of {count} jobs are done already", file=sys.stderr)
            failed = run_on(known.scheduler, program, arguments, jobs, log)
        code = subprocess.call([program, "batch", *arguments, "--summary"])
        return FILE_TROUBLE if failed else code
    except BatchError as error:
        if str(error):
            print(f"orbitutte.batch: {error}", file=sys.stderr)
        return error.code
    except OSError as error:
        print(f"orbitutte.batch: {error}", file=sys.stderr)
        return FILE_TROUBLE


if __name__ == "__main__":
    sys.exit(main())
