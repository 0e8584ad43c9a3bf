"""Many presses of the study at once; none may be missing."""

from collections.abc import Hashable, Mapping
from typing import Any, TypeVar

from softdot.config import Config
from softdot.progress import Progress

Name = TypeVar("Name", bound=Hashable)


class NotSolvedError(Exception):
    """A press of the study gave no result; the message names it in one sentence."""


def solve_named(configs: Mapping[Name, Config], progress: Progress) -> dict[Name, dict[str, Any]]:
    """Name -> outcome of every press, solved on all cores or remembered. NotSolvedError when one has none."""
    from softdot.sweep import solve_points

    records = dict(zip(configs, solve_points(list(configs.values()), progress), strict=True))
    for name, record in records.items():
        if record["status"] != "solved":
            raise NotSolvedError(f"{_text(name)}: {record['status']}, {record['reason']}")
    return records


def _text(name: Hashable) -> str:
    return ", ".join(map(str, name)) if isinstance(name, tuple) else str(name)
