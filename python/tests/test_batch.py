# SPDX-License-Identifier: MIT
"""Batches on the workers of a Dask scheduler on this machine, one of which is killed."""
import json
import os
import pathlib
import subprocess
import sys
import time

import pytest

PROGRAM = os.environ.get("ORBITUTTE")
needs_program = pytest.mark.skipif(not PROGRAM, reason="ORBITUTTE does not name the program")


def manifest(folder, count):
    subprocess.run([PROGRAM, "sample", "--faces", "2000", "-o", folder / "figure.off"], check=True, stderr=subprocess.DEVNULL)
    rows = "".join(f"figure.off,job{k:03},extremities,{k}\n" for k in range(count))
    (folder / "jobs.csv").write_text("mesh,name,cones,cut-seed\n" + rows)


def batch(folder, *arguments):
    return subprocess.run([sys.executable, "-m", "orbitutte.batch", "jobs.csv", "-o", "out", *arguments], cwd=folder, text=True, capture_output=True)


def records(folder):
    path = folder / "out/jobs.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def start(folder, name, *arguments):
    log = open(folder / f"{name}.log", "w")
    return subprocess.Popen([sys.executable, "-m", f"distributed.cli.{name}", "--no-dashboard", *arguments], cwd=folder, stdout=log, stderr=log)


@pytest.fixture
def cluster(tmp_path):
    """The address of a scheduler, and its two workers."""
    pytest.importorskip("distributed", reason="python3-distributed is missing; see ./setup --tests")
    address_file = tmp_path / "scheduler.json"
    processes = [start(tmp_path, "dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(address_file))]
    try:
        for _ in range(600):
            if address_file.exists() and address_file.read_text().strip():
                break
            time.sleep(0.1)
        address = json.loads(address_file.read_text())["address"]
        processes += [start(tmp_path, "dask_worker", address, "--host", "127.0.0.1", "--nthreads", "1", "--no-nanny") for _ in range(2)]
        yield address, processes[1:]
    finally:
        for process in processes:
            process.kill()
            process.wait()


@needs_program
def test_without_a_scheduler_it_is_the_command(tmp_path):
    manifest(tmp_path, 3)
    done = batch(tmp_path, "--jobs", "2")
    assert done.returncode == 0, done.stderr
    assert sorted(record["name"] for record in records(tmp_path)) == ["job000", "job001", "job002"]


@needs_program
def test_faults_of_the_manifest_keep_their_exit_code(tmp_path):
    (tmp_path / "jobs.csv").write_text("mesh\ngone.off\n")
    done = batch(tmp_path, "--scheduler", "tcp://127.0.0.1:1")
    assert done.returncode == 1
    assert "gone.off" in done.stderr and "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


@needs_program
def test_a_worker_that_is_killed_loses_no_record_and_doubles_none(tmp_path, cluster):
    address, workers = cluster
    count = 30
    manifest(tmp_path, count)
    command = [sys.executable, "-m", "orbitutte.batch", "jobs.csv", "-o", "out", "--scheduler", address]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as running:
        deadline = time.monotonic() + 120
        while len(records(tmp_path)) < 5 and running.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)
        before = len(records(tmp_path))
        workers[0].kill()
        stderr = running.communicate(timeout=300)[1]
    assert running.returncode == 0, stderr
    assert 5 <= before < count, "the worker was killed in mid-run"
    assert workers[0].poll() is not None and workers[1].poll() is None
    assert sorted(record["name"] for record in records(tmp_path)) == [f"job{k:03}" for k in range(count)]
    assert all(record["outcome"] == "certified" for record in records(tmp_path))
    assert (tmp_path / "out/summary.csv").read_text().count("\n") == count + 1
    again = batch(tmp_path, "--scheduler", address)
    assert again.returncode == 0 and f"{count} of {count} jobs are done already" in again.stderr
    assert len(records(tmp_path)) == count


@needs_program
def test_a_batch_on_workers_goes_on_after_it_was_killed(tmp_path, cluster):
    address, _ = cluster
    count = 30
    manifest(tmp_path, count)
    command = [sys.executable, "-m", "orbitutte.batch", "jobs.csv", "-o", "out", "--scheduler", address]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.DEVNULL) as running:
        while len(records(tmp_path)) < 5 and running.poll() is None:
            time.sleep(0.01)
        running.kill()
    before = records(tmp_path)
    assert len(before) < count
    with open(tmp_path / "out/jobs.jsonl", "a") as log:
        log.write('{"job": 1, "na')
    done = batch(tmp_path, "--scheduler", address)
    assert done.returncode == 0, done.stderr
    assert records(tmp_path)[:len(before)] == before
    assert sorted(record["name"] for record in records(tmp_path)) == [f"job{k:03}" for k in range(count)]
