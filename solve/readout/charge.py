"""Charge on the electrodes that the press does not make: of heat and of the touch; and what leaks between channels."""

import numpy as np

from geometry.arrays import Floats
from solve.model import Physics, Pyroelectric


def warming_K(time_s: Floats, heat: Pyroelectric) -> Floats:
    """Change of the film's temperature (t,) since the first touch at time zero: dT (1 - exp(-t / tau)), none before."""
    return np.asarray(-heat.temperature_step_K * np.expm1(-np.maximum(time_s, 0.0) / heat.time_constant_s))


def other_charge_C(
    time_s: Floats, contact_area: Floats, electrode_area_m2: Floats, pyroelectric_uC_per_m2_K: float, physics: Physics
) -> Floats:
    """Charge (t, e) in C of heat, p A dT, and of the touch, in proportion to the contact area (t,) so far.

    The touch leaves contact_charge_pC at the largest contact area, shared by the electrodes (e,) as their areas are.
    """
    share = electrode_area_m2 / electrode_area_m2.sum()
    heat = 1e-6 * pyroelectric_uC_per_m2_K * warming_K(time_s, physics.pyroelectric)[:, None] * electrode_area_m2
    touched = contact_area / max(float(contact_area.max()), 1e-300)
    return np.asarray(heat + 1e-12 * physics.contact_charge_pC * touched[:, None] * share)


def mixed_channels(alone: Floats, physics: Physics) -> Floats:
    """Voltages (e, t) of all channels with crosstalk: to each its share of the sum of the others."""
    coupling = np.array([physics.crosstalk.get(channel + 1, 0.0) for channel in range(len(alone))])
    return np.asarray(alone + coupling[:, None] * (alone.sum(axis=0) - alone))
