"""Energy balance of a press: work put in, energy stored and energy dissipated, from the laws themselves.

Stored: W_iso and p^2 / 2K of the media, S . C^-1 S / 2 of the film. In a viscous medium of the linear law
(S0 = 2 mu dev E) each branch Q is a Maxwell element: it stores Q : Q / (4 mu g) and dissipates Q : Q / (2 mu g tau).
A softening medium gives back int eta dW from 0 to W of what int dW put in up to W_max; the rest is lost.
"""

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.special import erf

from foundation.arrays import Floats
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import linear
from solve.materials.film_yield import FilmPlasticity
from solve.materials.mullins import Softening
from solve.materials.prony import Prony
from solve.setup import Setup
from solve.solution.linear import LinearSolver
from solve.solution.march import march, rest_state
from solve.solution.schedule import Target
from solve.system import State, System
from solve.terms.friction import FrictionalContact
from solve.terms.solid import SolidRegion, deformation_gradient
from tests.slip_work import slip_work

SQUARE = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])  # S : S of six components


@dataclass
class Balance:
    """Histories (t,) in solver units; dissipated is what has been lost since rest."""

    system: System
    work: list[float] = field(default_factory=lambda: [0.0])
    stored: list[float] = field(default_factory=list)
    dissipated: list[float] = field(default_factory=lambda: [0.0])

    @property
    def error(self) -> float:
        """Largest |work - stored - dissipated|, relative to the largest work."""
        lack = np.array(self.work) - np.array(self.stored) + self.stored[0] - np.array(self.dissipated)
        return float(np.abs(lack).max() / max(self.work))

    @property
    def loss(self) -> float:
        """Energy lost in the end, relative to the largest work."""
        return self.dissipated[-1] / max(self.work)

    def add(self, state: State, before: State) -> None:
        """Account for one converged step."""
        now, old = (trial_of(self.system, s, before) for s in (state, before))
        path = now.move - old.move
        self.work.append(self.work[-1] + 0.5 * float((force_of(self.system, now) + force_of(self.system, old)) @ path))
        self.stored.append(stored(self.system, state))
        self.dissipated.append(self.dissipated[-1] + lost(self.system, state, before))


def follow(setup: Setup, targets: list[Target]) -> Balance:
    """March along the targets and keep account. AssertionError where it does not converge."""
    system = setup.system
    solver = LinearSolver(system.factorisation_shift)
    balance, past = Balance(system), [rest_state(system, solver, targets[0])]
    balance.stored.append(stored(system, past[0]))
    for before, target in pairwise(targets):
        assert march(system, solver, past, target, before.kink, balance.add) is None
    solver.close()
    return balance


def trial_of(system: System, state: State, before: State):
    return system.trial(state.x, state.load, state.time, before)


def force_of(system: System, trial) -> Floats:
    """Of the dot on the segment (3,)."""
    return system.dot_force(trial)


def stored(system: System, state: State) -> float:
    """All elastic energy."""
    trial = trial_of(system, state, state)
    media = sum(_medium(solid, trial, system.history_of(solid, state)) for solid in system.solids)
    return media + _film(system, trial, state)


def _points(solid: SolidRegion, trial) -> tuple[Floats, Floats]:
    """W_iso (n,) and volume (n,) at the quadrature points."""
    f = deformation_gradient(solid.gradient, trial.displacement[solid.tets])
    return solid.law.energy((f.swapaxes(-1, -2) @ f).reshape(-1, 3, 3)), solid.weight.ravel()


def _medium(solid: SolidRegion, trial, history) -> float:
    energy, volume = _points(solid, trial)
    for law, memory in zip(solid.inelastic, history, strict=True):
        if isinstance(law, Softening):
            energy = recoverable(law, energy, memory[0])
        if isinstance(law, Prony):
            g = np.array(law.relative_moduli)
            energy = (1.0 - g.sum()) * energy + (memory[2] ** 2 @ SQUARE) @ (1.0 / (4.0 * solid.law.shear_modulus * g))
    p = trial.x[solid.dofs[:, 30:]] @ linear(tetrahedron()[0]).T
    return float(energy @ volume + np.sum(solid.weight * p**2) / (2.0 * solid.law.bulk_modulus))


def recoverable(law: Softening, energy: Floats, largest: Floats) -> Floats:
    """int_0^W eta dW at the largest energy W_max so far."""
    width = law.energy + law.beta * largest + 1e-300
    return energy - law.loss * width * (_area(largest / width) - _area((largest - energy) / width))


def _area(x: Floats) -> Floats:
    """int_0^x erf."""
    return x * erf(x) + np.expm1(-(x**2)) / np.sqrt(np.pi)


def _film(system: System, trial, state: State) -> float:
    film = system.film
    elastic = film.strain_and_stress(trial, system.history_of(film, state))[1].reshape(-1, 6)
    return 0.5 * float(
        np.einsum("ni,ni,n->", elastic, np.linalg.solve(film.law.stiffness, elastic.T).T, film.weight.ravel())
    )


def lost(system: System, state: State, before: State) -> float:
    """Energy dissipated in a step, by the trapezoidal rule."""
    trial = trial_of(system, state, before)
    total = sum(_lost_in_medium(system, solid, state, before) for solid in system.solids)
    for term in system.terms:
        if isinstance(term, FrictionalContact):
            total += slip_work(term, trial, before.x[term.friction_dofs])
    return total + _plastic_work(system, state, before)


def _lost_in_medium(system: System, solid: SolidRegion, state: State, before: State) -> float:
    histories = [system.history_of(solid, s) for s in (before, state)]
    volume, total = solid.weight.ravel(), 0.0
    for law, old, now in zip(solid.inelastic, *histories, strict=True):
        if isinstance(law, Softening):
            lost_so_far = [
                law.loss * (law.energy + law.beta * m[0]) * _area(m[0] / (law.energy + law.beta * m[0] + 1e-300))
                for m in (old, now)
            ]
            total += float((lost_so_far[1] - lost_so_far[0]) @ volume)
        if isinstance(law, Prony):
            rate = 1.0 / (2.0 * solid.law.shear_modulus * np.array(law.relative_moduli) * law.relaxation_times)
            power = [((m[2] ** 2 @ SQUARE) @ rate) @ volume for m in (old, now)]
            total += 0.5 * (state.time - before.time) * float(sum(power))
    return total


def _plastic_work(system: System, state: State, before: State) -> float:
    film, total = system.film, 0.0
    memories = [system.history_of(film, s) for s in (before, state)]
    for law, old, now in zip(film.inelastic, *memories, strict=True):
        if isinstance(law, FilmPlasticity):
            stress = [
                film.strain_and_stress(trial_of(system, s, s), h)[1].reshape(-1, 6)
                for s, h in zip((before, state), memories, strict=True)
            ]
            total += float(np.einsum("ni,ni,n->", 0.5 * (stress[0] + stress[1]), now[0] - old[0], film.weight.ravel()))
    return total
