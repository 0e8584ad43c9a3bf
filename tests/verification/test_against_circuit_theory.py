"""A film strip with a resistor across its electrode, coupled both ways, against the closed form of its circuit.

A strip in uniaxial stretch e(t) is a source of current A d31 Y e' with the capacitance C* = C_in + C_f (1 - k^2),
k^2 = d31^2 Y / eps: the voltage that it makes stiffens it (IEEE Std 176-1987). Across R, with tau = R C*,
    ramp e = r t:          V = R A d31 Y r (1 - exp(-t / tau))
    sine e = e0 sin w t:   V = R A d31 Y e0 w (cos w t + w tau sin w t - exp(-t / tau)) / (1 + (w tau)^2)
    stress                 s = Y (e + d31 V / t_film)
"""

from dataclasses import replace

import numpy as np
import pytest

from geometry.electrode_outlines import EVERYWHERE
from solve.materials.film import film_law
from solve.materials.parameters import VACUUM_PERMITTIVITY, PiezoelectricFilm
from solve.terms.base import Trial
from solve.terms.circuit import Circuit
from solve.terms.film import film_region
from tests.solve.box import box

YOUNG, EPSILON = 2e9, 12.0 * VACUUM_PERMITTIVITY
UNIT = 1e9  # of stress in Pa and of voltage in V, with lengths in m: entries of the tangent alike, charges in C
SIZE = (1.0, 0.5, 0.1)
AREA, THICKNESS = SIZE[0] * SIZE[1], SIZE[2]
STRAIN = 1e-6  # the closed form is that of small strain


class Strip:
    """A film, free to contract, with its electrode's voltage as the last unknown."""

    def __init__(self, d31: float, resistance: float, input_capacitance: float) -> None:
        material = PiezoelectricFilm(
            youngs_modulus_MPa=1e-6 * YOUNG,
            poisson_ratio=0.29,
            d31_pC_per_N=1e12 * d31,
            d32_pC_per_N=0.0,
            d33_pC_per_N=0.0,
            relative_permittivity=12.0,
        )
        law = film_law(material, 0.0)
        law = replace(
            law, stiffness=law.stiffness / UNIT, coupling=law.coupling * UNIT, permittivity=law.permittivity * UNIT
        )
        self.points, tets = box(2, SIZE)
        self.numbers = np.arange(self.points.size).reshape(-1, 3)
        voltage, everywhere = np.array([self.points.size]), [np.array(EVERYWHERE)]
        film = film_region(law, self.points, tets, self.numbers, voltage, everywhere, THICKNESS)
        charges = float(film.capacitance()[0]), UNIT * input_capacitance, resistance / UNIT
        self.terms = (film, Circuit(self.points.size, *charges))
        self.histories = [term.start() for term in self.terms]
        self.x, self.reaction = np.zeros(self.points.size + 1), np.zeros(self.points.size + 1)
        self.held = np.concatenate([self.numbers[self.points[:, axis] == 0.0, axis] for axis in range(3)])
        self.end = self.numbers[np.isclose(self.points[:, 0], SIZE[0]), 0]

    def step(self, strain: float, time: float, time_step: float) -> tuple[float, float]:
        """Voltage (V) and stress (Pa) once the strip is stretched to a strain."""
        x, fixed = self.x.copy(), np.concatenate([self.held, self.end])
        x[self.end] = strain * SIZE[0]
        free = np.setdiff1d(np.arange(len(x)), fixed)
        for _ in range(3):  # the second iteration only mends the geometric nonlinearity
            trial = self._trial(x, time, time_step)
            residual, tangent = self._assemble(trial)
            x[free] -= np.linalg.solve(tangent[np.ix_(free, free)], residual[free])
        trial = self._trial(x, time, time_step)
        self.reaction = self._assemble(trial)[0]
        self.histories = [term.advance(trial, old) for term, old in zip(self.terms, self.histories, strict=True)]
        self.x = x
        return UNIT * float(x[-1]), UNIT * float(self.reaction[self.end].sum()) / (SIZE[1] * SIZE[2])

    def _trial(self, x, time, time_step):
        u, before, rest = x[self.numbers], self.x[self.numbers], np.zeros(3)
        return Trial(x, u, rest, 0.0, before, rest, 0.0, time, time_step)

    def _assemble(self, trial):
        residual, tangent = np.zeros(len(trial.x)), np.zeros((len(trial.x),) * 2)
        for term, history in zip(self.terms, self.histories, strict=True):
            for group, part, ke, re in term.elements(trial, history):
                full = np.triu(ke) + np.triu(ke, 1).swapaxes(1, 2)
                for dofs, k, r in zip(term.groups[group][part], full, re, strict=True):
                    tangent[np.ix_(dofs, dofs)] += k
                    residual[dofs] += r
        return residual, tangent


def circuit(d31, share_of_input):
    """C_in, C* (F) and the strength A d31 Y (C per strain) of a strip."""
    film = EPSILON * AREA / THICKNESS
    k2 = d31**2 * YOUNG / EPSILON
    return share_of_input * film, film * (share_of_input + 1.0 - k2), AREA * d31 * YOUNG


def history(d31, share_of_input, strain_at, times, tau):
    """Voltage and stress (n,) at times (n,), with the resistor that makes C* relax in tau; and R A d31 Y."""
    input_capacitance, capacitance, strength = circuit(d31, share_of_input)
    strip = Strip(d31, tau / capacitance, input_capacitance)
    steps = np.diff(np.concatenate([[0.0], times]))
    result = np.array([strip.step(strain_at(t), t, dt) for t, dt in zip(times, steps, strict=True)])
    return result[:, 0], result[:, 1], strength * tau / capacitance


STRIPS = pytest.mark.parametrize(
    ("d31", "share_of_input"), [(23e-12, 0.0), (115e-12, 0.0), (115e-12, 4.0)], ids=["PVDF", "k2 0.25", "with cable"]
)


@pytest.mark.press
@STRIPS
def test_ramp_into_a_resistor(d31, share_of_input):
    """Within 1e-4 of the largest voltage, and of the stress, at every one of 60 steps over three tau."""
    tau, times = 2e-3, np.linspace(0.0, 6e-3, 61)[1:]
    rate = STRAIN / times[-1]
    voltage, stress, gain = history(d31, share_of_input, lambda t: rate * t, times, tau)
    expected = gain * rate * -np.expm1(-times / tau)
    np.testing.assert_allclose(voltage, expected, atol=1e-4 * expected.max())
    expected_stress = YOUNG * (rate * times + d31 * expected / THICKNESS)
    np.testing.assert_allclose(stress, expected_stress, atol=1e-4 * expected_stress.max())


@pytest.mark.press
@STRIPS
def test_sine_into_a_resistor(d31, share_of_input):
    """From rest through the transient into the phase-shifted sine: 1e-3 of the amplitude at 100 steps a period."""
    tau, w = 2e-3, 2.0 * np.pi * 100.0
    times = np.linspace(0.0, 0.02, 201)[1:]
    voltage, _, gain = history(d31, share_of_input, lambda t: STRAIN * np.sin(w * t), times, tau)
    shape = np.cos(w * times) + w * tau * np.sin(w * times) - np.exp(-times / tau)
    expected = gain * STRAIN * w * shape / (1.0 + (w * tau) ** 2)
    np.testing.assert_allclose(voltage, expected, atol=1e-3 * np.abs(expected).max())
