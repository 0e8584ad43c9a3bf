"""Charge of a sensor of unknown geometry under a measured force, and the voltage that its amplifier makes of it.

    Q(t) = s g(t),    g the strain of one medium under the measured force f = F / F_max,    g = f at the baseline
s is one unknown number for each channel. A medium that relaxes, softens or stiffens is the coupon of
diagnose.engines.coupon in simple shear: the same laws of the 3D solver, on a strain of unknown size. A tenth is taken
at the largest force, small enough that relaxation is linear. Of a Yeoh law then f = g + a g^3 + b g^5.
    Charge of the touch: in proportion to the contact area of a sphere, f^(2/3) (Hertz, J. reine angew. Math. 92, 1882).
    Heat: p dT(t) over the film, in terms of the voltage of 28 um of PVDF, with dT from the first touch.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from diagnose.engines.coupon.kinematics import SimpleShear
from diagnose.engines.coupon.point import MaterialPoint
from diagnose.engines.coupon.relaxation import NO_SERIES, Relaxation
from diagnose.engines.coupon.tested_layer import LAYER
from diagnose.engines.proportional.medium import LARGEST_MEDIUM_STRAIN, MEDIUM
from diagnose.vocabulary.scene import film_capacitance_pF
from foundation.arrays import Floats
from solve.added import TouchedFilm
from solve.materials.laws import MediumLaw
from solve.materials.mullins import Softening
from solve.materials.parameters import PiezoelectricFilm
from solve.materials.prony import Prony
from solve.model import Model, Readout
from solve.physics import laws_of
from solve.readout.amplifier import amplify
from solve.readout.hysteresis import FilmHysteresis

HERTZ_AREA_EXPONENT = 2.0 / 3.0


@dataclass(frozen=True, eq=False)
class Loading:
    """Force of one run over time. time_s (t,). force (t,) : from its rest, over the largest of the recording. touch_s.

    largest_before : force of earlier runs in the same measure. Compared by identity, so that strains can be cached.
    """

    time_s: Floats
    force: Floats
    touch_s: float
    largest_before: float = 0.0


def medium_strain(model: Model, loading: Loading) -> Floats:
    """Strain (t,) of the medium over that at the largest force at the baseline. NoEquilibriumError."""
    inelastic, material = model.physics.inelastic, model.materials[LAYER]
    series = laws_of(inelastic, Prony).get(LAYER, NO_SERIES)
    softening = laws_of(inelastic, Softening).get(LAYER)
    if material == MEDIUM and softening is None and series == NO_SERIES:
        return loading.force
    return _solve_strain(material.law, softening, series, loading)


@lru_cache(maxsize=512)
def _solve_strain(law: MediumLaw, softening: Softening | None, series: Prony, loading: Loading) -> Floats:
    """Strain (t,) of a medium that is not the baseline's, cached since what follows the film leaves it alone."""
    point = MaterialPoint(SimpleShear(1.0, 1.0), law, MEDIUM.poisson_ratio, softening, series)
    peak = point.peak_energy({"force_N": LARGEST_MEDIUM_STRAIN * loading.largest_before})
    found = point.answer_near(loading.time_s, LARGEST_MEDIUM_STRAIN * loading.force, "force_N", peak_before=peak)
    return found.values / LARGEST_MEDIUM_STRAIN


def film_charge(model: Model, loading: Loading) -> Floats:
    """Charge (t,) that follows the load, in units of s, the film's own relaxation included. NoEquilibriumError."""
    charge = medium_strain(model, loading)
    series = laws_of(model.physics.inelastic, Prony).get("film")
    if series is None:
        return charge
    return Relaxation.from_series(series, loading.time_s).relaxed_stress(charge[:, None])[:, 0]


def held_back(model: Model, shape: Floats, largest_C: float) -> Floats:
    """What hysteresis holds back (t,) of a charge of this shape (t,), whose largest is that in C."""
    plays = [one for one in model.physics.added if isinstance(one, FilmHysteresis)]
    return np.asarray(sum((one.held_back(shape, 1e-12 / largest_C) for one in plays), np.zeros(len(shape))))


def other_charge(model: Model, loading: Loading) -> Floats:
    """Charge (t,) in C of the touch and of heat."""
    film = model.materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    area = np.maximum(loading.force, 0.0) ** HERTZ_AREA_EXPONENT
    area_m2 = np.array([1e-6 * model.segment.length_mm * model.segment.width_mm])
    none = np.zeros((len(area), 1))
    under = TouchedFilm(loading.time_s - loading.touch_s, area, area_m2, film.pyroelectric_uC_per_m2_K, none)
    return np.asarray(sum((one.charge_C(under)[:, 0] for one in model.physics.added), np.zeros(len(area))))


def amplifier_voltage(model: Model, loading: Loading, charge_C: Floats) -> Floats:
    """Voltage (t,) that the amplifier makes of a charge (t,) in C, at rest before the first sample."""
    before = loading.time_s[0] - (loading.time_s[1] - loading.time_s[0])
    time, charge = np.append(before, loading.time_s), np.append(0.0, charge_C)
    capacitance = 1e-12 * film_capacitance_pF(model)
    return amplify(time, charge, capacitance, model.readout or Readout(), model.physics)[1:]
