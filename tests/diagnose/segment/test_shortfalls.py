"""A press without equilibrium is told, and what stands in for it."""

from types import SimpleNamespace

import numpy as np

from diagnose.engines.segment import prepared
from diagnose.engines.segment.interpolation import candidate_effect
from diagnose.engines.segment.prepared import Prepared, press_name
from diagnose.forward import Candidate, Coordinate
from solve.solution.errors import NoEquilibriumError
from tests.diagnose.segment.rigs import model

GLUE = Candidate(
    "property-error", "medium2", (Coordinate("error", -1.0, 1.0, (0.1,), (0.25, 0.5, 1.0)),),
    lambda values: {"modulus_factor": 1.0 + values[0]},
)  # fmt: skip


def bridged(*known):
    """What is known after presses at some values have an equilibrium."""
    changes = {press_name(GLUE, (value,)): np.full((1, 3), value) for value in known}
    known_of_it = SimpleNamespace(_changes=changes, shortfalls={}, _executor=None)
    Prepared._replace_failed_presses(known_of_it, GLUE)
    return known_of_it


def test_nothing_is_told_where_every_press_has_an_equilibrium():
    assert bridged(0.25, 0.5, 1.0).shortfalls == {}


def test_the_nearest_press_stands_in_and_the_verdict_says_so():
    found = bridged(0.25, 0.5)
    assert found._changes[press_name(GLUE, candidate_effect(GLUE).points[-1])][0, 0] == 0.5
    assert list(found.shortfalls.values()) == [
        "No equilibrium with property-error (medium2) at modulus_factor = 2: "
        "its press at modulus_factor = 1.5 is used instead."
    ]


def test_without_any_press_it_is_no_candidate():
    told = list(bridged().shortfalls.values())
    assert len(told) == 3
    assert all(one.endswith("it is left out of the candidates.") for one in told)


def test_a_layer_whose_memory_has_no_equilibrium_is_left_out_and_told(monkeypatch):
    """Tried with fewer and fewer layers, as far as those that relax by rig.toml."""
    asked = []

    def run_all(jobs, _report, first, _executor):
        asked.append(first[0].relaxing)
        if len(first[0].relaxing) > 2:
            raise NoEquilibriumError("turned inside out", np.zeros(0), None)
        return [np.ones((1, 3)) for _ in jobs]

    monkeypatch.setattr(prepared, "run_all", run_all)
    rig = model()
    base = SimpleNamespace(model=rig)
    presses = SimpleNamespace(baseline_jobs=(base, base), tet_mesh=None)
    before = SimpleNamespace(model=rig, depth_mm=0.1, presses=presses, shortfalls={}, _executor=None)
    reduction, outputs = Prepared._reduce(before, [base], lambda *_: None)
    assert [len(layers) for layers in asked] == [4, 3, 2]
    assert reduction.relaxing == asked[-1]
    assert len(outputs) == 1
    dropped = [layer for layer in asked[0] if layer not in asked[-1]]
    assert set(before.shortfalls) == {("viscoelasticity", layer) for layer in dropped}
    assert all(told.endswith(" is left out of the candidates.") for told in before.shortfalls.values())
