"""Processes and real Dask clusters: bad addresses, killed workers, a killed sweep, threads."""

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import closing, contextmanager
from pathlib import Path

import psutil
import pytest

from foundation.errors import InputError
from foundation.executor import LocalProcesses, completed_calls
from softdot import dask_cluster as scheduler_module
from softdot.cli import main
from softdot.config.loading import config_from
from softdot.config.schema import Config
from softdot.executors import executor_for
from softdot.outcome import outcome
from softdot.progress import Logged
from softdot.sweeps import read_table, run_sweep, solve_points, space_from
from softdot.sweeps.points import solve_all
from softdot.warm_up import TINY_CONFIG
from tests.softdot.complaints import complaints
from tests.softdot.interrupts import heard
from tests.softdot.sweep_spaces import DEPTHS, depths, space_of
from tests.softdot.toml_text import toml_text

NO_DASHBOARD = {"dashboard": False, "dashboard_address": "127.0.0.1:0"}
DEPTHS_MM = [round(0.030 + 0.002 * number, 3) for number in range(12)]


@pytest.fixture(autouse=True)
def fresh_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path / "cache"))


@pytest.fixture
def space(tmp_path):
    path = tmp_path / "space.toml"
    path.write_text(toml_text(space_of(depths(0.04, 0.05))), "utf-8")
    return path


def at_depth(depth):
    return config_from({**TINY_CONFIG, "press": {"indentation_mm": depth, "load_steps": 1}})


def refused(space, address, tmp_path, capfd):
    """The sentence on an address; nothing is written."""
    assert main(["sweep", str(space), "-o", str(tmp_path / "out"), "--scheduler", address]) == 2
    assert not (tmp_path / "out").exists()
    said = capfd.readouterr().err
    assert said.count("\n") == 1
    return said.removeprefix("softdot: ").rstrip("\n")


@pytest.mark.parametrize(
    "address",
    ["", "8786", "localhost", "localhost:8786", "http://localhost:8786", "tcp://", "tcp://a:b", "tcp://a:99999"],
)
def test_what_is_no_address(space, address, tmp_path, capfd):
    assert refused(space, address, tmp_path, capfd) == (
        f"--scheduler '{address}': must be tcp://HOST:PORT or tls://HOST:PORT, such as tcp://127.0.0.1:8786"
    )


@contextmanager
def listening(answer):
    """A server that is no Dask scheduler: it says the answer to whoever comes."""
    with closing(socket.create_server(("127.0.0.1", 0))) as server:
        visitors = []

        def serve():
            while True:
                try:
                    visitor, _ = server.accept()
                except OSError:
                    return
                visitors.append(visitor)
                visitor.sendall(answer)

        threading.Thread(target=serve, daemon=True).start()
        yield f"tcp://127.0.0.1:{server.getsockname()[1]}"
        for visitor in visitors:
            visitor.close()


@pytest.mark.parametrize("answer", [None, b"", b"HTTP/1.1 400 Bad Request\r\n\r\n" * 20])
def test_an_address_where_no_scheduler_answers(space, answer, tmp_path, capfd, monkeypatch):
    monkeypatch.setattr(scheduler_module, "CONNECT_S", 1)
    with listening(answer or b"") as address:
        if answer is None:
            address = "tcp://127.0.0.1:1"
        said = refused(space, address, tmp_path, capfd)
    assert said.startswith(f"--scheduler '{address}': no Dask scheduler answers there within 1 s")


@pytest.fixture(scope="module")
def scheduler():
    """A cluster that runs already, in threads of this process."""
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=1,
        threads_per_worker=1,
        processes=False,
        protocol="tcp",
        host="127.0.0.1",
        scheduler_kwargs=NO_DASHBOARD,
    ) as cluster:
        yield cluster


def test_a_sweep_on_a_cluster_that_runs_already(scheduler, space, tmp_path):
    out = tmp_path / "out"
    assert main(["sweep", str(space), "-o", str(out), "--scheduler", scheduler.scheduler_address]) == 0
    found = read_table(out).to_pylist()
    assert [row["status"] for row in found] == ["solved", "solved"]
    assert found[0]["reaction_force_N"] == outcome(at_depth(0.04))["reaction_force_N"]
    assert json.loads((out / "sweep.json").read_text(encoding="utf-8"))["scheduler"] == scheduler.scheduler_address


def test_workers_with_another_softdot_are_refused(scheduler, space, tmp_path, capfd, monkeypatch):
    monkeypatch.setattr(scheduler_module, "source_hash", lambda _: str(time.perf_counter_ns()))
    said = refused(space, scheduler.scheduler_address, tmp_path, capfd)
    assert said.endswith("has another softdot; install the same one there")


def test_workers_without_softdot_are_refused(scheduler, space, tmp_path, capfd, monkeypatch):
    def absent(_):
        raise ModuleNotFoundError("No module named 'softdot'")

    monkeypatch.setattr(scheduler_module, "source_hash", absent)
    said = refused(space, scheduler.scheduler_address, tmp_path, capfd)
    assert said.endswith("cannot load softdot (No module named 'softdot'); install it there")


def test_a_scheduler_without_workers_is_refused(space, tmp_path, capfd, monkeypatch):
    from distributed import LocalCluster

    monkeypatch.setattr(scheduler_module, "WORKERS_S", 1)
    with LocalCluster(
        n_workers=0, processes=False, protocol="tcp", host="127.0.0.1", scheduler_kwargs=NO_DASHBOARD
    ) as empty:
        said = refused(space, empty.scheduler_address, tmp_path, capfd)
    assert said.endswith("this scheduler has no workers; start some with 'dask worker ADDRESS'")


class Closer(Logged):
    """Ends the scheduler when the first point is there."""

    def __init__(self, cluster):
        self.cluster = cluster

    def step(self, number, count, text):
        if number == 1:
            self.cluster.close()


@pytest.mark.process
def test_a_scheduler_that_goes_away_is_one_sentence_and_the_points_stay(tmp_path):
    from distributed import LocalCluster

    given = space_from(space_of(depths(*DEPTHS_MM)))
    with (
        LocalCluster(
            n_workers=1, processes=False, protocol="tcp", host="127.0.0.1", scheduler_kwargs=NO_DASHBOARD
        ) as cluster,
        pytest.raises(InputError, match="the Dask scheduler disappeared; what was finished is kept"),
    ):
        run_sweep(given, tmp_path / "out", cluster.scheduler_address, Closer(cluster))
    kept = len(list(tmp_path.glob("out/points/*.json")))
    assert 1 <= kept < len(DEPTHS_MM)
    assert run_sweep(given, tmp_path / "out")["reused"] == kept


def workers_alive():
    """Numbers of the processes that this one has started and that do calls."""
    return [child.pid for child in psutil.Process().children() if "foundation.worker_process" in child.cmdline()]


class Killer(Logged):
    """Kills one worker, as hard as can be, when so many points are there."""

    def __init__(self, number):
        self.number, self.pids = number, []

    def step(self, number, count, text):
        if number == self.number:
            worker = min(workers_alive())
            os.kill(worker, signal.SIGKILL)
            self.pids.append(worker)


@pytest.mark.process
def test_a_worker_that_is_killed_loses_no_point(tmp_path):
    killer = Killer(4)
    summary = run_sweep(space_from(space_of(depths(*DEPTHS_MM), workers=2)), tmp_path / "out", progress=killer)
    assert len(killer.pids) == 1
    assert (summary["ended"]["solved"], summary["solved_now"]) == (12, 12)
    table = read_table(tmp_path / "out").to_pylist()
    assert [row[DEPTHS] for row in table] == DEPTHS_MM
    force = [row["peak.reaction_force_N"] for row in table]
    assert force == sorted(force)
    assert force[7] == pytest.approx(outcome(at_depth(DEPTHS_MM[7]))["reaction_force_N"][-1], rel=1e-9)


class Deadly(Config):
    """Kills the worker that looks into it, as one does that needs more memory than there is."""

    def model_dump(self, **_):
        os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.process
def test_a_point_that_kills_its_worker_becomes_a_row_with_its_reason():
    configs = {f"{depth:g}": at_depth(depth) for depth in (0.03, 0.04, 0.05)}
    configs = {"deadly": Deadly(**dict(at_depth(0.02))), **configs}
    with LocalProcesses(2) as executor:
        records = dict(solve_all(executor, configs))
    assert {name: record["status"] for name, record in records.items()} == {
        "deadly": "lost",
        "0.03": "solved",
        "0.04": "solved",
        "0.05": "solved",
    }
    assert records["deadly"]["reason"] == "its worker died each time, perhaps for lack of memory"


@pytest.mark.process
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_a_sweep_that_is_stopped_goes_on_with_what_is_missing(number, tmp_path):
    space, out = tmp_path / "space.toml", tmp_path / "out"
    space.write_text(toml_text(space_of(depths(*DEPTHS_MM), workers=1)), "utf-8")
    command = [sys.executable, "-m", "softdot.cli", "sweep", str(space), "-o", str(out)]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, encoding="utf-8", start_new_session=True, preexec_fn=heard
    )
    while len(list(out.glob("points/*.json"))) < 3:
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.02)
    os.killpg(process.pid, number) if number == signal.SIGINT else process.send_signal(number)
    _, said = process.communicate(timeout=30)
    said = complaints(said)
    if number == signal.SIGINT:  # to the whole group, as a terminal does it
        assert process.returncode == 130
        assert said.count("\n") == 1
        assert "finished points are kept" in said
    _require_gone(process.pid)
    before = {path: path.read_bytes() for path in out.glob("points/*.json")}
    assert 3 <= len(before) < 12
    assert not (out / "sweep.parquet").exists()
    summary = json.loads(subprocess.run([*command, "--json"], check=True, capture_output=True).stdout)
    assert (summary["reused"], summary["solved_now"]) == (len(before), 12 - len(before))
    assert {path: path.read_bytes() for path in before} == before
    assert [row["status"] for row in read_table(out).to_pylist()] == ["solved"] * 12


def _require_gone(group):
    """No process of the group lives on, after some seconds at most."""
    for _ in range(200):
        if not any(_group_and_state(path)[0] == group for path in Path("/proc").glob("[0-9]*")):
            return
        time.sleep(0.05)
    pytest.fail("a worker lives on")


def _group_and_state(path):
    """Process group of a live process, 0 for one that has ended."""
    try:
        state, _, group = (path / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()[:3]
    except OSError:
        return 0, "X"
    return (0 if state in "ZX" else int(group)), state


@pytest.mark.process
def test_many_points_are_what_each_gives_alone_on_one_thread_each():
    """In order, a repeated one too, with the reason of one that cannot be."""
    given = [at_depth(depth) for depth in (0.05, 0.03, 9.0, 0.05)]
    before = dict(os.environ)
    found = solve_points(given, workers=2)
    assert [one["status"] for one in found] == ["solved", "solved", "refused", "solved"]
    assert found[2]["reason"].startswith("press.indentation_mm = 9: must be less than the height")
    for config, one in zip(given, found, strict=True):
        if one["status"] == "solved":
            assert one["reaction_force_N"][-1] == pytest.approx(outcome(config)["reaction_force_N"][-1], rel=1e-9)
    assert dict(os.environ) == before
    assert workers_alive() == []


def _threads():
    import numba
    from threadpoolctl import threadpool_info

    import solve.press  # noqa: F401  loads what a press loads

    return numba.get_num_threads(), max(pool["num_threads"] for pool in threadpool_info())


@pytest.mark.process
def test_each_process_calculates_on_one_thread_also_after_a_death(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    with LocalProcesses(1) as executor:
        assert executor.submit(_threads).result() == (1, 1)
        (victim,) = workers_alive()
        os.kill(victim, signal.SIGKILL)
        assert executor.submit(_threads).result() == (1, 1)
        assert workers_alive() != [victim]


def slowly(number):
    time.sleep(0.2)
    return os.getpid(), number**2


@pytest.mark.process
def test_a_worker_of_a_cluster_that_is_killed_loses_no_call():
    """What it was doing is done by the other one."""
    from distributed import LocalCluster

    with (
        LocalCluster(n_workers=2, threads_per_worker=1, scheduler_kwargs=NO_DASHBOARD) as running,
        executor_for(running.scheduler_address) as cluster,
    ):
        assert cluster.places == 2
        found = {}
        for name, future in completed_calls(cluster, slowly, {number: (number,) for number in range(12)}):
            found[name] = future.result()
            if len(found) == 4:
                os.kill(found[name][0], signal.SIGKILL)
    assert {name: square for name, (_, square) in found.items()} == {number: number**2 for number in range(12)}


def test_an_error_on_a_cluster_is_the_error_of_the_call(scheduler):
    """And a call that is given up is told from it."""
    with executor_for(scheduler.scheduler_address) as cluster:
        with pytest.raises(InputError, match="indentation_mm = 9"):
            cluster.submit(outcome, at_depth(9.0)).result()
        assert cluster.submit(abs, -3).result() == 3
