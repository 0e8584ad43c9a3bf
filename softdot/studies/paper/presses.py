"""The presses of the study by name, each solved once and remembered."""

from collections.abc import Hashable, Mapping
from typing import Any, TypeVar

from foundation.executor import Executor
from softdot.config.schema import Config
from softdot.progress import Progress

Name = TypeVar("Name", bound=Hashable)


class NotSolvedError(Exception):
    """A press of the study gave no result; the message names it in one sentence."""


def solve_named(configs: Mapping[Name, Config], progress: Progress, executor: Executor) -> dict[Name, dict[str, Any]]:
    """Name -> outcome of every press, solved by an executor or remembered. NotSolvedError when one has none."""
    from softdot.sweeps.points import solve_points

    records = dict(zip(configs, solve_points(list(configs.values()), progress, executor=executor), strict=True))
    for name, record in records.items():
        if record["status"] != "solved":
            raise NotSolvedError(f"{_text(name)}: {record['status']}, {record['reason']}")
    return records


def _text(name: Hashable) -> str:
    return ", ".join(map(str, name)) if isinstance(name, tuple) else str(name)
