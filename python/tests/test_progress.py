# SPDX-License-Identifier: MIT
"""Progress, cancellation, signals, threads and memory."""
import gc
import os
import signal
import threading
import time

import numpy as np
import orbitutte
import pytest


def test_progress_tells_of_every_stage_and_iteration(figure):
    seen = []
    embedding = orbitutte.embed(*figure, "432", progress=lambda *state: seen.append(state))
    stages = list(dict.fromkeys(stage for stage, *_ in seen))
    assert stages == ["base", "validate", "weights", "cut", "factorize", "initialize", "optimize", "certify", "choose"]
    energies = [energy for stage, _, energy, _ in seen if stage == "optimize" and energy > 0]
    assert energies[-1] == pytest.approx(embedding.energy, rel=1e-9) and len(energies) >= embedding.report["iterations"]


@pytest.mark.parametrize("use", ["function", "solver"])
def test_false_cancels_and_what_is_raised_passes_through(use, figure):
    solver = orbitutte.Solver(*figure)
    embed = (lambda progress: orbitutte.embed(*figure, "432", progress=progress)) if use == "function" else (
        lambda progress: solver.embed("432", progress=progress))
    with pytest.raises(orbitutte.Cancelled):
        embed(lambda stage, *_: stage != "optimize")
    with pytest.raises(orbitutte.Cancelled):
        embed(lambda *_: np.bool_(False))
    mine = KeyError("mine")
    def fail(*_):
        raise mine
    with pytest.raises(KeyError) as caught:
        embed(fail)
    assert caught.value is mine
    for answer in (None, True, 0, "", np.zeros(2)):  # only False stops; and nothing is left over
        assert embed(lambda *_: answer).bijective


def long_mesh():
    """An embedding that takes many iterations: seconds, where nobody stops it."""
    return orbitutte.sample_mesh("figure", 60000)


@pytest.mark.parametrize("progress", [None, lambda *_: None])
def test_an_interrupt_ends_a_long_computation(progress):
    V, F = long_mesh()

    def seconds():
        start = time.perf_counter()
        orbitutte.embed(V, F, "432", progress=progress)
        return time.perf_counter() - start

    whole = seconds()
    timer = threading.Timer(0.2 * whole, os.kill, (os.getpid(), signal.SIGINT))
    start = time.perf_counter()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        seconds()
    interrupted = time.perf_counter() - start
    timer.join()
    assert interrupted < 0.85 * max(whole, seconds())


def test_other_threads_run_meanwhile():
    V, F = long_mesh()
    done, longest = threading.Event(), []
    def watch():
        last = time.perf_counter()
        while not done.is_set():
            time.sleep(0.001)
            now = time.perf_counter()
            longest.append(now - last)
            last = now
    watcher = threading.Thread(target=watch)
    watcher.start()
    start = time.perf_counter()
    orbitutte.embed(V, F, "432")
    duration = time.perf_counter() - start
    done.set()
    watcher.join()
    # With the GIL held, the watcher would see one gap as long as the whole computation.
    assert len(longest) > 5 and max(longest) < 0.7 * duration


def test_threads_compute_at_the_same_time_with_the_same_result(figure):
    expected = orbitutte.embed(*figure, "432").positions
    results = [None] * 4
    def work(k):
        results[k] = orbitutte.embed(*figure, "432", threads=1).positions
    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(result, expected) for result in results)


def test_a_solver_computes_one_thing_at_a_time(figure):
    solver = orbitutte.Solver(*figure)
    def again(*_):
        solver.embed("332", "extremities")
    with pytest.raises(orbitutte.ArgumentError, match="computing already"):
        solver.embed("432", "extremities", progress=again)
    assert solver.embed("432", "extremities").bijective


def resident_bytes():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="no /proc here")
def test_a_thousand_embeddings_leave_nothing_behind():
    V, F = orbitutte.sample_mesh("figure", 124)
    def use(count):
        for k in range(count):
            cones = "best" if k % 10 == 0 else "extremities"  # the search takes twenty times as long
            embedding = orbitutte.embed(V, F, "22", cones, progress=lambda *_: None)
            embedding.locate([0, 0, 1])
            embedding.seams, embedding.group, embedding.weights, orbitutte.tile(embedding)
            if k % 4 == 0:
                with pytest.raises(ValueError):
                    orbitutte.embed(V, F, "22", [0, 0])
        gc.collect()
        return resident_bytes()
    before = use(200)
    assert use(1000) - before < 3e6  # an embedding with all that belongs to it takes 60 kB or so
