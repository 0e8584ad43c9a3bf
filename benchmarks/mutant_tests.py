"""Which tests run a line, and whether one of several fails: pytest in processes of its own.

They part from this one, which has loaded the libraries, so that a mutant does not wait for them.
"""

import json
import os
import resource
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

PYTEST = ("-q", "-n", "0", "-p", "no:cacheprovider")
LIBRARIES = (
    *("hypothesis", "meshio", "numba", "pandas", "pydantic", "pdb", "xdist.plugin", "_hypothesis_pytestplugin"),
    *("scipy.interpolate", "scipy.signal", "scipy.linalg", "scipy.ndimage", "scipy.stats"),
)
MOST_S = 8.0
"""Of the tests that are chosen for a line, as long as they take."""
SHARED = 10.0
"""Times the processor time that is allowed, on the clock: other programs may run."""


class Watch:
    """Of pytest: keeps the wanted tests (None: all) in their order, notes what they take and the first that fails.

    coverage : whose contexts follow; a file of tests stands for what is run outside of a test.
    """

    def __init__(self, wanted: Sequence[str] | None = None, coverage: Any = None) -> None:
        self.wanted, self.coverage = wanted, coverage
        self.took: Counter[str] = Counter()
        self.failed = ""

    def _follow(self, context: str) -> None:
        if self.coverage is not None:
            self.coverage.switch_context(context)

    def pytest_make_collect_report(self, collector: Any) -> None:
        """Modules of tests run when they are collected."""
        self._follow(collector.nodeid.partition("::")[0])

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        """Leave out what is not wanted."""
        if self.wanted is not None:
            order = {name: number for number, name in enumerate(self.wanted)}
            items[:] = sorted((one for one in items if one.nodeid in order), key=lambda one: order[one.nodeid])

    def pytest_runtest_setup(self, item: Any) -> None:
        """Fixtures may belong to all tests of the file."""
        self._follow(item.nodeid.partition("::")[0])

    def pytest_runtest_call(self, item: Any) -> None:
        """A test."""
        self._follow(item.nodeid)

    def pytest_runtest_logreport(self, report: Any) -> None:
        """What it took, and whether it failed."""
        self.took[report.nodeid] += report.duration
        self.failed = self.failed or (report.nodeid if report.failed else "")

    def pytest_collectreport(self, report: Any) -> None:
        """A module that cannot be imported."""
        self.failed = self.failed or (report.nodeid if report.failed else "")


def apart(work: Callable[..., Any], arguments: Sequence[Any], tree: Path, longest_s: float) -> tuple[Any, float]:
    """What work gives in a process of its own in a tree, and its processor time; None where it breaks or is late."""
    kept = tree / "found.json"
    kept.unlink(missing_ok=True)
    if (child := os.fork()) == 0:
        try:
            os.setsid()
            resource.setrlimit(resource.RLIMIT_CPU, (int(longest_s), int(longest_s) + 1))
            os.chdir(tree)
            sys.path[0] = str(tree)
            silence = os.open(os.devnull, os.O_WRONLY)
            os.dup2(silence, 1)
            os.dup2(silence, 2)
            kept.write_text(json.dumps(work(*arguments)), "utf-8")
        finally:
            os._exit(0)
    end, done = time.monotonic() + SHARED * longest_s, 0
    while not done and time.monotonic() < end:
        time.sleep(0.02)
        done, _, used = os.wait4(child, os.WNOHANG)
    with suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)
    if not done:
        _, _, used = os.wait4(child, 0)
    return json.loads(kept.read_text("utf-8")) if done and kept.exists() else None, used.ru_utime + used.ru_stime


def mapped(test_file: str, sources: Sequence[str]) -> dict[str, Any]:
    """took : test -> s; runs : source -> line -> contexts, of the default tests of one file that do not fail."""
    from coverage import Coverage

    coverage = Coverage(data_file=None, include=[str(Path(one).resolve()) for one in sources], config_file=False)
    coverage.start()
    for source in sources:  # what modules run when they are imported belongs to no test
        import_module(source.removesuffix(".py").removesuffix("/__init__").replace("/", "."))
    watch = Watch(coverage=coverage)
    pytest.main([test_file, *PYTEST], plugins=[watch])
    coverage.stop()
    data = coverage.get_data()
    runs = {one: data.contexts_by_lineno(str(Path(one).resolve())) for one in sources}
    return {"took": watch.took, "failed": watch.failed, "runs": runs}


def chosen(file: str, first: int, last: int, maps: Sequence[dict[str, Any]]) -> list[str]:
    """The tests that run lines of a file, the fastest first; where none is known to, those that run any of its lines.

    A line may run as a module is imported, or in a process that a test starts.
    """
    took: dict[str, float] = {}
    for whole in (False, True):
        for one in maps:
            lines = one["runs"].get(file, {})
            hit = {c for line, of in lines.items() if whole or first <= int(line) <= last for c in of}
            took |= {test: s for test, s in one["took"].items() if {test, test.partition("::")[0]} & hit}
        if took:
            break
    names, spent = [], 0.0
    for name in sorted(took, key=lambda test: took[test]):
        if names and (spent := spent + took[name]) > MOST_S:
            break
        names.append(name)
    return names


def met(tests: Sequence[str]) -> str:
    """The first of the tests that fails; empty for none."""
    watch = Watch(wanted=tests)
    files = list(dict.fromkeys(one.partition("::")[0] for one in tests))
    status = pytest.main([*files, *PYTEST, "-x"], plugins=[watch])
    return watch.failed or (f"pytest ends with {status}" if status else "")
