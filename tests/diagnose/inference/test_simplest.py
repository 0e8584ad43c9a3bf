"""Which of two explanations is named where one holds a part of the other's mechanisms."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from diagnose.inference.grades import THRESHOLDS
from diagnose.inference.hypotheses import simplest
from tests.cases import for_each

PAIR_ERROR, ALIKE = 0.03, 0.0


class StubJudge:
    """Knows of each hypothesis its error and its share. apart_by : by which any two forecasts differ."""

    def __init__(self, apart_by: float) -> None:
        self.apart_by = apart_by

    def error(self, one: Any) -> float:
        """Over the signal."""
        return float(one.error)

    def known_share(self, one: Any) -> float:
        """Of the excess."""
        return float(one.share)

    def is_closer(self, one: Any, other: Any) -> bool:
        """By half of the squares."""
        return bool(one.error**2 < 0.5 * other.error**2)

    def apart(self, one: Any, other: Any) -> float:
        """Root mean square, over the signal."""
        return self.apart_by


def hypothesis(names: str, error: float, share: float) -> Any:
    """One whose mechanisms are the letters of names."""
    return SimpleNamespace(names=frozenset((one, "film") for one in names), error=error, share=share)


def named(error: float, share: float, probability: float, part: str = "A", apart_by: float = 1.0) -> str:
    """Mechanisms of what is named, where A and B together leave PAIR_ERROR and come first."""
    ordered = [hypothesis("AB", PAIR_ERROR, 0.99), hypothesis(part, error, share)]
    judge: Any = StubJudge(apart_by)
    number = simplest(judge, ordered, np.array([1.0 - probability, probability, 0.0, 0.0]))
    return "".join(sorted(name for name, _ in ordered[number].names))


def test_a_probable_part_that_accounts_for_all_but_flaws_is_named_alone():
    assert named(error=0.07, share=0.97, probability=0.26) == "A"


@for_each(
    "error, share, probability",
    [(1.01 * THRESHOLDS.left, 0.97, 0.26), (0.07, 0.99 * THRESHOLDS.nearly_all, 0.26), (0.07, 0.97, 0.001)],
)
def test_a_part_that_leaves_too_much_or_is_improbable_is_not(error, share, probability):
    assert named(error, share, probability) == "AB"


def test_what_holds_another_mechanism_is_no_part():
    assert named(error=0.07, share=0.97, probability=0.26, part="C") == "AB"


def test_a_part_with_the_same_forecast_is_named_whatever_its_probability():
    assert named(error=PAIR_ERROR, share=0.99, probability=1e-9, apart_by=ALIKE) == "A"
