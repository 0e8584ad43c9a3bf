"""A press without equilibrium is told, and what stands in for it."""

from types import SimpleNamespace

import numpy as np

from diagnose.forward import Candidate, Coordinate
from diagnose.segment.interpolation import effect_of
from diagnose.segment.prepared import Prepared, press_name

GLUE = Candidate(
    "property-error", "medium2", (Coordinate("error", -1.0, 1.0, (0.1,), (0.25, 0.5, 1.0)),),
    lambda values: {"modulus_factor": 1.0 + values[0]},
)  # fmt: skip


def bridged(*known):
    """What is known after presses at some values have an equilibrium."""
    changes = {press_name(GLUE, (value,)): np.full((1, 3), value) for value in known}
    prepared = SimpleNamespace(_changes=changes, shortfalls={})
    Prepared._bridge(prepared, GLUE)
    return prepared


def test_nothing_is_told_where_every_press_has_an_equilibrium():
    assert bridged(0.25, 0.5, 1.0).shortfalls == {}


def test_the_nearest_press_stands_in_and_the_verdict_says_so():
    found = bridged(0.25, 0.5)
    assert found._changes[press_name(GLUE, effect_of(GLUE).points[-1])][0, 0] == 0.5
    assert list(found.shortfalls.values()) == [
        "No equilibrium with property-error of the medium2 at modulus_factor = 2: "
        "its press at modulus_factor = 1.5 stands in."
    ]


def test_without_any_press_it_is_no_candidate():
    told = list(bridged().shortfalls.values())
    assert len(told) == 3
    assert all(one.endswith("it is no candidate.") for one in told)
