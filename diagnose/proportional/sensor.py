"""Charge of a sensor that nobody can mesh.

    Q(t) = s g(t),    g the strain of one medium under the measured force f = F / F_max,    g = f at the baseline
s is one unknown number for each channel. A medium that relaxes, softens or stiffens is the coupon of diagnose.coupon
in simple shear: the same laws of the 3D solver, on a strain of unknown size. A tenth is taken at the largest force,
small enough that relaxation is linear. Of a Yeoh law then f = g + a g^3 + b g^5.
    Charge of the touch: in proportion to the contact area of a sphere, f^(2/3) (Hertz, J. reine angew. Math. 92, 1882).
    Heat: p dT(t) over the film, in terms of the voltage of 28 um of PVDF, with dT from the first touch.
"""

from dataclasses import dataclass

import numpy as np

from diagnose.coupon.kinematics import SimpleShear
from diagnose.coupon.memory import NO_SERIES, Relaxation
from diagnose.coupon.one_layer import LAYER
from diagnose.coupon.point import MaterialPoint
from diagnose.vocabulary.scene import film_capacitance_pF
from mesh.types import Floats
from solve.materials.laws import medium_law
from solve.materials.parameters import PiezoelectricFilm, Yeoh
from solve.model import Model
from solve.parameters import Readout
from solve.readout.amplifier import amplify

MEDIUM = Yeoh(c10_MPa=0.5, poisson_ratio=0.495)
"""Of shear modulus 1, the unit of stress here."""
LARGEST_STRAIN = 0.1
HERTZ = 2.0 / 3.0


@dataclass(frozen=True)
class Loading:
    """What a run gives: time_s (t,), force (t,) over the largest of the recording and from its rest, touch_s."""

    time_s: Floats
    force: Floats
    touch_s: float


def strain(model: Model, loading: Loading) -> Floats:
    """Strain (t,) of the medium over that at the largest force at the baseline. NoEquilibriumError."""
    physics, material = model.physics, model.materials[LAYER]
    series, softening = physics.viscosity.get(LAYER, NO_SERIES), physics.softening.get(LAYER)
    if material == MEDIUM and softening is None and series == NO_SERIES:
        return loading.force
    law = medium_law(material).scaled(1e-6)
    point = MaterialPoint(SimpleShear(1.0, 1.0), law, MEDIUM.poisson_ratio, softening, series)
    return point.answer(loading.time_s, LARGEST_STRAIN * loading.force, "force_N") / LARGEST_STRAIN


def film_charge(model: Model, loading: Loading) -> Floats:
    """Charge (t,) that follows the load, in units of s, the film's own relaxation included. NoEquilibriumError."""
    charge = strain(model, loading)
    series = model.physics.viscosity.get("film")
    if series is None:
        return charge
    return Relaxation.of(series, loading.time_s).relaxed(charge[:, None])[:, 0]


def other_charge(model: Model, loading: Loading) -> Floats:
    """Charge (t,) in C of the touch and of heat."""
    physics, film = model.physics, model.materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    touch = 1e-12 * physics.contact_charge_pC * np.maximum(loading.force, 0.0) ** HERTZ
    area_m2 = 1e-6 * model.segment.length_mm * model.segment.width_mm
    since = np.maximum(loading.time_s - loading.touch_s, 0.0)
    warming = -np.expm1(-since / physics.pyroelectric.time_constant_s) * physics.pyroelectric.temperature_step_K
    return np.asarray(touch + 1e-6 * film.pyroelectric_uC_per_m2_K * area_m2 * warming)


def voltage(model: Model, loading: Loading, charge_C: Floats) -> Floats:
    """What the amplifier gives (t,), at rest before the first sample."""
    before = loading.time_s[0] - (loading.time_s[1] - loading.time_s[0])
    time, charge = np.append(before, loading.time_s), np.append(0.0, charge_C)
    capacitance = 1e-12 * film_capacitance_pF(model)
    return amplify(time, charge, capacitance, model.readout or Readout(), model.physics)[1:]
