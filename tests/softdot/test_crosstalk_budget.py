"""The budget of an array's crosstalk: what cancels in a share, a derivative against arrays built anew, islands."""

import pytest

from foundation.executor import HERE
from softdot.arrays.case import ArrayCase
from softdot.prepared_press import PreparedPress
from softdot.tolerances.budget import MESH_FACTOR
from softdot.tolerances.crosstalk import crosstalk_budget
from softdot.tolerances.factors import factor_key
from softdot.tolerances.questions import Question, coarser_press
from tests.verification.test_array_slices import FAR, row

pytestmark = pytest.mark.press


@pytest.fixture(scope="module")
def case():
    """Three slices on one film and medium 2."""
    return row(3, shared=["film", "medium2"])


@pytest.fixture(scope="module")
def budget(case, tmp_path_factory):
    """The budget, nothing remembered from earlier."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOFTDOT_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield crosstalk_budget(case.config, executor=HERE)


def effect(budget, words):
    (found,) = (one for one in budget.effects if words in one.tolerance.label)
    return found


def test_constants_of_the_film_cancel_in_a_share(budget):
    assert budget.pressed == "segment-r1c2"
    assert 0.5 < budget.percent < 90.0
    assert effect(budget, "piezoelectric").change[0] == pytest.approx(0.0, abs=1e-6)
    assert effect(budget, "permittivity").change[0] == pytest.approx(0.0, abs=1e-6)


def test_all_moduli_larger_alike_change_no_share(case):
    """At a prescribed depth stresses scale with the moduli, and strains stay."""
    press = coarser_press(case.press_over(case.layout.places[1]).config, MESH_FACTOR)
    keys = [factor_key(press, layer, "modulus_factor") for layer in ("effector", "medium1", "film", "medium2")]
    answer = Question(press, tuple(keys), is_full_load=True).answer().electrodes_V
    voltages = answer[""]
    whole = [sum(answer[key][n] for key in keys) for n in range(3)]
    alone = max(abs(answer[key][1]) for key in keys)
    assert whole[1] / voltages[1] == pytest.approx(whole[0] / voltages[0], abs=2e-3 * alone / voltages[1])


def test_the_effect_of_a_thickness_is_that_of_arrays_built_anew(case, budget):
    """Each with a mesh of its own; central difference over a fifth of the thickness."""

    def percent(thickness):
        medium2 = case.config.segment.medium2.model_copy(update={"thickness_mm": thickness})
        segment = case.config.segment.model_copy(update={"medium2": medium2})
        other = ArrayCase(case.config.model_copy(update={"segment": segment}))
        press = coarser_press(other.press_over(other.layout.places[1]).config, MESH_FACTOR)
        charge = PreparedPress(press).solve().steps[-1].film_charge_C
        return 100.0 * max(abs(charge[0]), abs(charge[2])) / abs(charge[1])

    thick = case.config.segment.medium2.thickness_mm
    found = effect(budget, "thickness of medium 2")
    by_hand = (percent(1.1 * thick) - percent(0.9 * thick)) / (0.2 * thick)
    assert found.change[0] / found.tolerance.plus_minus == pytest.approx(by_hand, rel=0.15)


def test_a_dot_off_its_place_brings_crosstalk_to_one_side(budget):
    """Two neighbours read alike under a dot in the middle; beside it the nearer one reads more."""
    assert effect(budget, "dot offset in x").change[0] > 0.0


def test_islands_have_no_crosstalk_whatever_is_off():
    budget = crosstalk_budget(row(3, **FAR).config, executor=HERE)
    assert budget.percent == pytest.approx(0.0, abs=1e-6)
    assert budget.total == pytest.approx(0.0, abs=1e-6)


def test_a_single_segment_has_no_neighbour():
    assert crosstalk_budget(row(1).config, executor=HERE) is None
