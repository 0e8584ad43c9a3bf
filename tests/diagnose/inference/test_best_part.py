"""What is told where several mechanisms together may not be named."""

from types import SimpleNamespace
from typing import Any

from diagnose.inference import findings_of_fits
from diagnose.inference.findings_of_fits import judgement_of_best_part
from diagnose.inference.grades import Identified, MainPart, Unexplained
from tests.cases import for_each

MAIN, NOT, WHOLE = MainPart(()), Unexplained(()), Identified(())


def told(monkeypatch, **verdicts):
    """Which explanation is judged in the end. verdicts : of the explanations by the letters of their mechanisms, best
    first.
    """
    names = list(verdicts)
    best = SimpleNamespace(
        name=names[0],
        parts_of_best=[n for n, one in enumerate(names) if set(one) < set(names[0])],
        with_first=lambda number: SimpleNamespace(name=names[number]),
    )

    def judgement(found: Any, _: Any) -> Any:
        return SimpleNamespace(name=found.name, verdict=verdicts[found.name])

    monkeypatch.setattr(findings_of_fits, "judgement", judgement)
    found: Any = judgement_of_best_part(best, None)  # type: ignore[arg-type]
    return found.name


@for_each("verdict", [MAIN, WHOLE])
def test_what_may_be_named_is(monkeypatch, verdict):
    assert told(monkeypatch, AB=verdict, A=MAIN) == "AB"


def test_the_first_part_that_is_the_main_part_is_told_instead(monkeypatch):
    assert told(monkeypatch, AB=NOT, C=MAIN, B=NOT, A=MAIN) == "A"


def test_no_part_is_all_of_what_the_whole_is_not(monkeypatch):
    """The whole predicts better for sure, so that a part of it is not identified."""
    assert told(monkeypatch, AB=NOT, A=WHOLE) == "AB"
