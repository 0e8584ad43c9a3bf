"""Many small cases in one test."""

import inspect
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any

from _pytest.mark.structures import ParameterSet


def for_each(names: str | tuple[str, ...], cases: Iterable[Any], ids: Any = None) -> Callable[..., Any]:
    """Decorate a test to run over cases, each a subtest that is named where it fails.

    names, cases : as of pytest.mark.parametrize, of which each case costs a fixture set-up, a message between
    processes and a line of the report. ids : names of the cases, or a function that gives them.
    """
    taken = tuple(name.strip() for name in names.split(",")) if isinstance(names, str) else tuple(names)
    table = [ParameterSet.extract_from(case, force_tuple=len(taken) == 1) for case in cases]
    if any(case.marks for case in table):
        raise TypeError("cases with marks of their own are selected one by one: use pytest.mark.parametrize")
    told = [None] * len(table) if ids is None or callable(ids) else [*ids]

    def decorated(test: Callable[..., None]) -> Callable[..., None]:
        @wraps(test)
        def over_all_cases(subtests: Any, **fixtures: Any) -> None:
            here = {"subtests": subtests} if "subtests" in inspect.signature(test).parameters else {}
            for case, name in zip(table, told, strict=True):
                called = case.id or name or (ids(case.values[0]) if callable(ids) else None)
                with subtests.test(called or ", ".join(str(value) for value in case.values)):
                    test(**here, **fixtures, **dict(zip(taken, case.values, strict=True)))

        kept = [one for one in inspect.signature(test).parameters.values() if one.name not in (*taken, "subtests")]
        asked = inspect.Parameter("subtests", inspect.Parameter.KEYWORD_ONLY)
        over_all_cases.__signature__ = inspect.Signature([*kept, asked])  # type: ignore[attr-defined]
        return over_all_cases

    return decorated
