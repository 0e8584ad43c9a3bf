"""Few and coarse presses tell candidates apart, and leave nothing behind where all presses follow."""

import numpy as np
import pytest

from diagnose.forward import Setting
from tests.cases import for_each
from tests.diagnose.segment.rigs import candidate, engine, silent, without_memory

CASES = [
    # mechanism, component, values between the rough presses and beyond them
    ("property-error", "medium1", (0.3, 0.1)),
    ("adhesive-compliance", "bond-film-medium2", (1.2, 2.5)),
    ("elastic-sides", "sides", (2.0,)),
    ("hyperelastic-stiffening", "effector", (1.0, 1.0)),
    ("stress-softening", "effector", (0.5, 0.6)),
]


def change(of, setting):
    """Change of force and voltage by a setting, each over the largest of the plain press."""
    plain, changed = of.predict(0, []), of.predict(0, [setting])
    return np.concatenate([(changed[name] - plain[name]) / np.abs(plain[name]).max() for name in plain])


def alike(one, other):
    """Cosine of the angle between two changes."""
    return float(one @ other / np.linalg.norm(one) / np.linalg.norm(other))


@pytest.mark.press
@for_each(("mechanism", "component", "values"), CASES)
def test_a_rough_change_looks_like_that_of_all_presses_and_gives_way_to_it(mechanism, component, values):
    with without_memory():
        of, whole = engine(), engine()
    setting = Setting(candidate(of, mechanism, component), values)
    of.prepare_roughly([setting.candidate], silent)
    rough = change(of, setting)
    for each in (of, whole):
        each.prepare([setting.candidate], silent)
    exact = change(whole, setting)
    assert alike(rough, exact) > 0.95
    assert 0.5 < np.linalg.norm(rough) / np.linalg.norm(exact) < 2.0
    np.testing.assert_array_equal(change(of, setting), exact)
