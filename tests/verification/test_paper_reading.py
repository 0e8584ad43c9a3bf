"""The plane-strain reading of the paper against an independent finite-element code, with both meshers.

The reference resolves the film as a solid on another mesh with another element; its figures are rounded to 0.01 N
and 1 mV. Voltages are open-circuit volts divided by the paper's calibration factor of 337. The two codes differ by
their discretisation errors, hence 3 % in force and 4 % in voltage. Meshes of pytetwild scatter, and no seed repeats
one: a single force by up to 0.9 %. What is compared of them is the mean of eight.
"""

import functools

import numpy as np
import pytest

from softdot.outcome import solve_outcome
from softdot.studies.paper.segment import segment_config

MESHERS = [pytest.param("layered"), pytest.param("pytetwild", marks=pytest.mark.evidence)]
FINE_MM = 0.15, 0.151, 0.152  # half the default, a fourth of the error; every size is another mesh of pytetwild
DEFAULT_MM = [round(0.3 + 1e-4 * number, 4) for number in range(8)]
SOFT, MIDDLE, HARD = 0.05, 1.0, 5.0  # modulus of medium 2, MPa


@functools.cache
def force_and_millivolts(mesher, boundary, h1_mm, e2_MPa, element_size_mm):
    mesh = {"mesher": mesher, "element_size_mm": element_size_mm, "contact_element_size_mm": element_size_mm / 3.0}
    config = segment_config(boundary, h1_mm, e2_MPa, load_steps=3, mesh=mesh)
    found = solve_outcome(config, lambda *_: None)
    assert found["solver"]["converged"], found["solver"]
    return found["reaction_force_N"][-1], 1e3 * found["open_circuit_voltage_V"][-1] / 337


def reading(mesher, boundary, h1_mm, e2_MPa):
    sizes_mm = DEFAULT_MM if mesher == "pytetwild" else DEFAULT_MM[:1]
    return np.mean([force_and_millivolts(mesher, boundary, h1_mm, e2_MPa, size) for size in sizes_mm], axis=0)


@pytest.mark.press
@pytest.mark.parametrize("mesher", MESHERS)
@pytest.mark.parametrize(
    ("boundary", "h1_mm", "e2_MPa", "force_N"),
    [
        ("free", 0.8, SOFT, 0.61),
        ("clamped", 0.8, SOFT, 14.06),
        ("free", 0.8, MIDDLE, 4.85),
        ("clamped", 0.8, MIDDLE, 16.08),
        ("free", 0.5, MIDDLE, 5.05),
        ("clamped", 0.5, MIDDLE, 14.44),
    ],
)
def test_forces(mesher, boundary, h1_mm, e2_MPa, force_N):
    assert reading(mesher, boundary, h1_mm, e2_MPa)[0] == pytest.approx(force_N, rel=0.03)


@pytest.mark.parametrize("mesher", MESHERS)
@pytest.mark.parametrize(
    ("cases", "millivolts"),
    [
        ((("clamped", 0.8, SOFT), ("free", 0.8, SOFT)), 433),
        pytest.param((("clamped", 0.8, HARD), ("free", 0.8, HARD)), 308, marks=pytest.mark.press),
        pytest.param((("clamped", 2.0, HARD), ("free", 2.0, HARD)), 215, marks=pytest.mark.press),
        ((("free", 0.5, MIDDLE),), 58),
        ((("clamped", 0.5, MIDDLE),), 419),
    ],
)
def test_voltages(mesher, cases, millivolts):
    total = sum(reading(mesher, *case)[1] for case in cases)
    assert total == pytest.approx(millivolts, rel=0.04)


@pytest.mark.evidence
@pytest.mark.parametrize(
    "case",
    [("free", 0.8, SOFT), ("clamped", 0.8, SOFT), ("free", 0.5, MIDDLE), ("clamped", 0.5, MIDDLE)],
)
def test_both_meshers_agree(case):
    """On meshes of half the default size, and the mean of three: those of pytetwild scatter, on the default size by 1 %
    of the voltage about a mean that is 2.6 % high.
    """
    layered = force_and_millivolts("layered", *case, FINE_MM[0])
    pytetwild = np.mean([force_and_millivolts("pytetwild", *case, size) for size in FINE_MM], axis=0)
    assert pytetwild[0] == pytest.approx(layered[0], rel=0.01)
    assert pytetwild[1] == pytest.approx(layered[1], rel=0.02)
