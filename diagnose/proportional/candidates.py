"""What may be missing in a sensor of unknown geometry.

A factor on all signals is nothing but another sensitivity, which is free: parasitic capacitance, d31, moduli and, with
free sensitivities, crosstalk cannot be found, and are no candidates. What acts on "medium1" acts on whatever medium
strains the film.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from diagnose.coupon.candidates import stress_softening
from diagnose.coupon.kinematics import SimpleShear
from diagnose.coupon.one_layer import LAYER
from diagnose.coupon.spectrum import relaxation_times, viscoelasticity
from diagnose.coupon.stiffening import Stiffening
from diagnose.forward import Candidate, Coordinate
from diagnose.proportional.sensor import LARGEST_STRAIN, MEDIUM
from diagnose.recording import Recording
from diagnose.vocabulary.electric import electric, hard_limit
from diagnose.vocabulary.rig import around
from diagnose.vocabulary.scene import Scene, growing

ELECTRIC = ("charge-leakage", "low-pass", "mains-hum")
AROUND = ("pyroelectric-drift", "contact-electrification")
SENSITIVITY, CAPACITANCE = "sensitivity", "film-capacitance"
MOST = 1.0  # modulus of one branch, in terms of what never relaxes
MOST_CAPACITANCE = 1e4  # of the assumed film
ANY_FACTOR = 1e6


def proportional_candidates(recording: Recording, scene: Scene) -> Iterator[Candidate]:
    """Every mechanism that shows whatever the geometry."""
    yield from (_with_time_constant(scene, one) for one in electric(scene) if one.mechanism in ELECTRIC)
    yield hard_limit(scene)  # a soft knee looks like any sensor that is not quite linear
    yield from (one for one in around(scene) if one.mechanism in AROUND)
    times = relaxation_times(recording)
    yield from (viscoelasticity(Candidate, component, times, MOST) for component in (LAYER, "film"))
    yield _stiffening()
    yield stress_softening(Candidate, LAYER)


def _with_time_constant(scene: Scene, one: Candidate) -> Candidate:
    """What a leak shows is its time constant; its resistance is that for the assumed capacitance.

    A charge that is gone within a sample leaves the derivative of the force, whose size the free sensitivity takes.
    """
    if one.mechanism != "charge-leakage":
        return one

    def derived(values: Sequence[float]) -> dict[str, float]:
        resistance_MOhm = float(one.parameters(values)["resistance_MOhm"])
        return {"time_constant_s": 1e-6 * scene.capacitance_pF * resistance_MOhm}

    coordinates = tuple(replace(coordinate, levels_off=(True, True)) for coordinate in one.coordinates)
    return replace(one, coordinates=coordinates, derived=derived, units={**one.units, "time_constant_s": "s"})


def _stiffening() -> Candidate:
    """force_ratio is that at the strain of the largest force without: the force that it takes with."""
    stretch = SimpleShear(1.0, 1.0).principal_stretch(np.array([LARGEST_STRAIN]))
    law = Stiffening(MEDIUM, stretch, SimpleShear.lateral, by_force=True)

    def derived(values: Sequence[float]) -> dict[str, float]:
        return {"force_ratio": 1.0 + sum(values)}

    unit = "of twice the shear modulus"
    units = {"c10_MPa": unit, "c20_MPa": unit, "c30_MPa": unit, "force_ratio": ""}
    return Candidate("hyperelastic-stiffening", LAYER, law.coordinates, law.parameters, derived, units)


def sensitivity(channel: int) -> Candidate:
    """Relative change of the sensitivity of a channel (from 1), of either sign; no mechanism."""
    coordinate = Coordinate(f"sensitivity of channel {channel}", -ANY_FACTOR, ANY_FACTOR, (0.5,))
    return Candidate(SENSITIVITY, f"channel-{channel}", (coordinate,), lambda values: {"factor": 1.0 + values[0]})


def film_capacitance() -> Candidate:
    """What the film has more than the assumed one, in terms of that; no mechanism."""
    coordinate = growing(CAPACITANCE, 1.0, MOST_CAPACITANCE, (1.0, 30.0, 1000.0))
    return Candidate(CAPACITANCE, "film", (coordinate,), lambda values: {"coordinate": values[0]})
