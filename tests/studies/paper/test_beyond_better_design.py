"""A better design against the paper's final one, in a true segment, on meshes that are not those of the search."""

import pytest

from softdot.outcome import outcome
from softdot.studies.paper.beyond.comparison import beats
from softdot.studies.paper.beyond.designs import PAPERS, Design, design_config
from softdot.studies.paper.beyond.trials import DesignTrial, press_of
from tests.cases import for_each

FOUND = Design(0.38, 5.0, 0.99, 1.0, 0.45, 0.43, 52.0)
MESH = {"element_size_mm": 0.6, "contact_element_size_mm": 0.3}


def pressed(design, mesher):
    presses = [
        press_of(outcome(design_config(design, side, "solid", {**MESH, "mesher": mesher})))
        for side in ("free", "clamped")
    ]
    return DesignTrial(design, *presses)


@pytest.mark.evidence
@for_each("mesher", ["layered", "pytetwild"])
def test_more_voltage_in_the_worse_boundary_at_no_more_film_stress_and_force(mesher):
    found, papers = pressed(FOUND, mesher), pressed(PAPERS, mesher)
    assert beats(found, papers)
    assert found.worse_V() > 1.2 * papers.worse_V()
