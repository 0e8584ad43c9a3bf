"""Uniaxial tension to a strain of 300 %, every law of a medium, against the slope of its energy.

The energies are written here once more, in principal stretches, from the sources that are cited; the nominal stress
is their derivative and the lateral stretch the one without lateral stress.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.optimize import brentq

from softdot.verify.body import solid_body
from softdot.verify.lattice import grid
from softdot.verify.problem import Problem
from solve.materials.laws import MediumLaw
from solve.materials.parameters import Hyperfoam, Knowles, Linear, MooneyRivlin, NeoHookean, Ogden, Yeoh

Energy = Callable[[complex, complex], complex]  # of the stretch along, and the two alike across
STRETCH = 4.0
"""Stretch along the pull, a strain of 300 %."""
POISSON = 0.495
DERIVATIVE_STEP = 1e-30  # of a complex argument: no difference is taken, so no digit is lost


def nominal_stress(law: MediumLaw) -> float:
    """Force per undeformed area of a distorted block of unit size that is pulled along x."""
    shape = grid([np.linspace(0.0, 1.0, 3)] * 3, jitter=0.2)
    body = solid_body(shape.points, law, shape.tets)
    prescribed = body.free_displacements()
    for axis in range(3):
        prescribed[shape.points[:, axis] == 0.0, axis] = 0.0
    end = shape.points[:, 0] == 1.0
    prescribed[end, 0] = STRETCH - 1.0
    body.solve(prescribed, steps=12)
    return float(body.reaction(np.flatnonzero(end))[0])


def exact_stress(energy: Energy) -> float:
    """Nominal stress dW / d lambda where the two lateral stretches carry no stress."""

    def lateral(across: float) -> float:
        return energy(STRETCH, across + DERIVATIVE_STEP * 1j).imag / DERIVATIVE_STEP

    across = brentq(lateral, 0.3, 1.0, xtol=1e-15)
    return energy(STRETCH + DERIVATIVE_STEP * 1j, across).imag / DERIVATIVE_STEP


def nearly_incompressible(isochoric: Energy, shear: float) -> Energy:
    """The energy W(l / J^(1/3)) + K/2 (J - 1)^2, with K = 2 G (1 + nu) / (3 (1 - 2 nu))."""
    bulk = 2.0 * shear * (1.0 + POISSON) / (3.0 * (1.0 - 2.0 * POISSON))

    def energy(along: complex, across: complex) -> complex:
        volume = along * across**2
        return isochoric(along / volume ** (1 / 3), across / volume ** (1 / 3)) + bulk / 2.0 * (volume - 1.0) ** 2

    return energy


def _first_invariant(along: complex, across: complex) -> complex:
    """The first invariant less its value at rest, I1 - 3."""
    return along**2 + 2.0 * across**2 - 3.0


def _mooney_rivlin(along: complex, across: complex) -> complex:
    return 0.3 * _first_invariant(along, across) + 0.1 * (along**-2 + 2.0 * across**-2 - 3.0)


def _yeoh(along: complex, across: complex) -> complex:
    return sum(c * _first_invariant(along, across) ** power for power, c in ((1, 0.3), (2, 0.02), (3, 0.001)))


def _knowles(along: complex, across: complex) -> complex:
    return 0.3 / 0.5 * ((1.0 + 0.5 / 2.5 * _first_invariant(along, across)) ** 2.5 - 1.0)


def _fung(along: complex, across: complex) -> complex:
    return complex(0.3 / 0.1 * (np.exp(0.1 * _first_invariant(along, across)) - 1.0))


def _ogden(along: complex, across: complex) -> complex:
    terms = ((0.63, 1.3), (0.0012, 5.0), (-0.01, -2.0))
    return sum(mu / a * (along**a + 2.0 * across**a - 3.0) for mu, a in terms)


def _hyperfoam(along: complex, across: complex) -> complex:
    mu, alpha, beta = 0.2, 2.0, 0.25 / (1.0 - 2.0 * 0.25)
    volume = along * across**2
    powers = along**alpha + 2.0 * across**alpha - 3.0
    return 2.0 * mu / alpha**2 * (powers + (volume ** (-alpha * beta) - 1.0) / beta)


def _linear(along: complex, across: complex) -> complex:
    """The energy G dev E : dev E + K/2 (J - 1)^2: the strain of the shear is not made isochoric."""
    one, two = 0.5 * (along**2 - 1.0), 0.5 * (across**2 - 1.0)
    shear = 1.0 / (2.0 * (1.0 + POISSON))
    bulk = 1.0 / (3.0 * (1.0 - 2.0 * POISSON))
    return 2.0 / 3.0 * shear * (one - two) ** 2 + bulk / 2.0 * (along * across**2 - 1.0) ** 2


NEO_HOOKEAN_SHEAR = 1.0 / (2.0 * (1.0 + POISSON))
LAWS = {
    "neo-hookean": (
        NeoHookean(youngs_modulus_MPa=1.0, poisson_ratio=POISSON),
        nearly_incompressible(lambda a, b: NEO_HOOKEAN_SHEAR / 2.0 * _first_invariant(a, b), NEO_HOOKEAN_SHEAR),
        "Treloar, The Physics of Rubber Elasticity, 1975, ch. 4",
    ),
    "mooney-rivlin": (
        MooneyRivlin(c10_MPa=0.3, c01_MPa=0.1, poisson_ratio=POISSON),
        nearly_incompressible(_mooney_rivlin, 0.8),
        "Rivlin, Phil. Trans. R. Soc. A 241, 1948, p. 379",
    ),
    "yeoh": (
        Yeoh(c10_MPa=0.3, c20_MPa=0.02, c30_MPa=0.001, poisson_ratio=POISSON),
        nearly_incompressible(_yeoh, 0.6),
        "Yeoh, Rubber Chem. Technol. 66, 1993, p. 754",
    ),
    "knowles": (
        Knowles(c10_MPa=0.3, b=0.5, n=2.5, poisson_ratio=POISSON),
        nearly_incompressible(_knowles, 0.6),
        "Knowles, Int. J. Fracture 13, 1977, p. 611",
    ),
    "fung": (
        Knowles(c10_MPa=0.3, b=0.1, poisson_ratio=POISSON),
        nearly_incompressible(_fung, 0.6),
        "Demiray, J. Biomech. 5, 1972, p. 309",
    ),
    "ogden": (
        Ogden(mu_MPa=(0.63, 0.0012, -0.01), alpha=(1.3, 5.0, -2.0), poisson_ratio=POISSON),
        nearly_incompressible(_ogden, 0.5 * (0.63 * 1.3 + 0.0012 * 5.0 + 0.01 * 2.0)),
        "Ogden, Proc. R. Soc. A 326, 1972, p. 565",
    ),
    "hyperfoam": (
        Hyperfoam(mu_MPa=(0.2,), alpha=(2.0,), poisson_ratio=(0.25,)),
        _hyperfoam,
        "Storåkers, J. Mech. Phys. Solids 34, 1986, p. 125",
    ),
    "linear": (
        Linear(youngs_modulus_MPa=1.0, poisson_ratio=POISSON),
        _linear,
        "Hooke's law between Green-Lagrange strain and second Piola-Kirchhoff stress",
    ),
}
"""Law -> material, energy in principal stretches, and source."""

PROBLEMS = tuple(
    Problem(
        name=f"tension-{name}",
        title=f"Uniaxial tension to 300 %, {name} law",
        source=source,
        unit="MPa",
        bound_percent=1e-5,
        basis="a homogeneous state lies in the finite-element space: round-off and the tolerance of the equilibrium",
        reference=partial(exact_stress, energy),
        solve=lambda material=material: nominal_stress(material.law),
    )
    for name, (material, energy, source) in LAWS.items()
)
