"""Each problem of softdot verify with one thing broken on purpose: python -m benchmarks.broken_verify [NAME…].

A problem that passes with its break has seen nothing: exit 1, and its name.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any
from unittest.mock import patch

import numpy as np

import solve.terms.solid
from softdot.verify.catalogue import PROBLEMS, chosen_problems
from solve.materials.film import film_law
from solve.materials.hyperfoam import HyperfoamLaw
from solve.materials.laws import InvariantLaw, KnowlesLaw, LinearLaw, OgdenLaw
from solve.materials.prony import Prony
from solve.readout import amplifier, filters
from solve.terms.friction import FrictionalContact
from solve.terms.unilateral_interface import UnilateralInterface

TOO_MUCH = 1.1


@contextmanager
def stiffer(law: type) -> Iterator[None]:
    """Stress and tangent of a law a tenth too large."""
    whole = law.stress  # type: ignore[attr-defined]

    def stress(self: Any, cauchy_green: Any) -> Any:
        return tuple(TOO_MUCH * part for part in whole(self, cauchy_green))

    with patch.object(law, "stress", stress):
        yield


@contextmanager
def heavier_weights() -> Iterator[None]:
    """The quadrature of a tetrahedron adds up to a tenth too much."""
    whole = solve.terms.solid.tetrahedron

    def rule(*degree: int) -> Any:
        points, weight = whole(*degree)
        return points, TOO_MUCH * weight

    with patch.object(solve.terms.solid, "tetrahedron", rule):
        yield


@contextmanager
def wrong_shapes() -> Iterator[None]:
    """The gradients of the mid-side nodes a hundredth too large."""
    whole = solve.terms.solid.physical_gradients

    def gradients(*mesh: Any) -> Any:
        gradient, weight = whole(*mesh)
        return gradient * np.where(np.arange(10) < 4, 1.0, 1.01)[:, None], weight

    with patch.object(solve.terms.solid, "physical_gradients", gradients):
        yield


@contextmanager
def rubbing_more() -> Iterator[None]:
    """The coefficient of friction a tenth too large."""

    @dataclass(frozen=True)
    class Rougher(FrictionalContact):
        """With its coefficient as wrong."""

        def __post_init__(self) -> None:
            object.__setattr__(self, "coefficient", TOO_MUCH * self.coefficient)

    with patch("softdot.verify.dragged_block.FrictionalContact", Rougher):
        yield


@contextmanager
def never_touching() -> Iterator[None]:
    """The faces of a loose patch pass through each other."""

    def nowhere(_patch: Any, _trial: Any, gap: Any) -> Any:
        return np.zeros(len(gap), bool)

    with patch.object(UnilateralInterface, "_closed_nodes", nowhere):
        yield


@contextmanager
def coupling(factor: float) -> Iterator[None]:
    """The piezoelectric constants times a factor."""

    def law(material: Any, angle: float) -> Any:
        whole = film_law(material, angle)
        return replace(whole, coupling=factor * whole.coupling)

    with patch("softdot.verify.problems.film.film_law", law), patch("solve.problem.film_law", law):
        yield


@contextmanager
def larger_input() -> Iterator[None]:
    """The capacitance behind the film a tenth too large."""
    whole = amplifier.leaky_integral
    with patch.object(amplifier, "leaky_integral", lambda t, q, c, r: whole(t, q, TOO_MUCH * c, r)):
        yield


@contextmanager
def shifted_corner() -> Iterator[None]:
    """The corner of a filter a tenth too high."""
    whole = filters.Filter.transfer
    filters._discretise.cache_clear()

    def transfer(self: filters.Filter) -> Any:
        return whole(replace(self, corner_Hz=TOO_MUCH * self.corner_Hz))

    with patch.object(filters.Filter, "transfer", transfer):
        yield
    filters._discretise.cache_clear()


@contextmanager
def quicker_relaxation() -> Iterator[None]:
    """Time runs a tenth too fast for a Prony series."""
    whole = Prony.update

    def update(self: Prony, elastic: Any, memory: Any, time_step: float) -> Any:
        return whole(self, elastic, memory, TOO_MUCH * time_step)

    with patch.object(Prony, "update", update):
        yield


RUBBER = lambda: stiffer(InvariantLaw)  # noqa: E731
HOOKE = lambda: stiffer(LinearLaw)  # noqa: E731
BREAKS: dict[str, Callable[[], Any]] = {
    "patch": wrong_shapes,
    "tension-neo-hookean": RUBBER,
    "tension-mooney-rivlin": RUBBER,
    "tension-yeoh": RUBBER,
    "tension-knowles": lambda: stiffer(KnowlesLaw),
    "tension-fung": lambda: stiffer(KnowlesLaw),
    "tension-ogden": lambda: stiffer(OgdenLaw),
    "tension-hyperfoam": lambda: stiffer(HyperfoamLaw),
    "tension-linear": HOOKE,
    "inflation": RUBBER,
    "thick-plate": HOOKE,
    "plate-large-deflection": HOOKE,
    "clamped-membrane": HOOKE,
    "nafems-le1": heavier_weights,
    "nafems-le10": heavier_weights,
    "bonded-disc": RUBBER,
    "bonded-strip": RUBBER,
    "cook": RUBBER,
    "hertz": RUBBER,
    "stick": RUBBER,
    "slip": rubbing_more,
    "delaminated-open": RUBBER,
    "delaminated-closed": never_touching,
    "film-stretch": lambda: coupling(-1.0),
    "film-open-circuit": lambda: coupling(TOO_MUCH),
    "unimorph": lambda: coupling(-1.0),
    "bimorph": lambda: coupling(TOO_MUCH),
    "rc-voltage": larger_input,
    "rc-charge": larger_input,
    "rc-low-pass": shifted_corner,
    "rc-high-pass": shifted_corner,
    "maxwell-block": quicker_relaxation,
    "array-of-two": RUBBER,
    "slice-press": RUBBER,
    "slice-drag": rubbing_more,
    "solid-press": lambda: coupling(TOO_MUCH),
}
"""Problem -> what is broken in the code that it looks at."""


def broken(name: str) -> dict[str, Any]:
    """The outcome of a problem with its break; what it is compared with is not broken."""
    problem = PROBLEMS[name]
    value = problem.reference()
    with BREAKS[name]():
        return replace(problem, reference=lambda: value).outcome()


def main(names: list[str]) -> int:
    """A table of problems, breaks and deviations; 1 where one passes all the same."""
    unseen = []
    for problem in chosen_problems(names):
        outcome = broken(problem.name)
        deviation = outcome["deviation_percent"]
        told = "no solution" if deviation is None else f"{deviation:+.3g} %"
        print(
            f"| {problem.name} | {told} | {problem.bound_percent:g} % | {'UNSEEN' if outcome['passed'] else 'seen'} |"
        )
        unseen += [problem.name] if outcome["passed"] else []
    return 1 if unseen else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
