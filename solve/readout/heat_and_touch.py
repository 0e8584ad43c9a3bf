"""Charge of the film that is not of its strain: of its temperature, and of the touch."""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from solve.added import Added, TouchedFilm


@dataclass(frozen=True)
class Pyroelectric(Added):
    """A temperature of the film that approaches temperature_step_K with time_constant_s from the first touch."""

    temperature_step_K: float = 0.0
    time_constant_s: float = 1.0
    follows_time = True

    @property
    def is_off(self) -> bool:
        """Whether the film does not warm."""
        return self.temperature_step_K == 0.0

    def warming_K(self, time_s: Floats) -> Floats:
        """Change of the temperature (t,) since the first touch at time zero: dT (1 - exp(-t / tau)), none before."""
        return np.asarray(-self.temperature_step_K * np.expm1(-np.maximum(time_s, 0.0) / self.time_constant_s))

    def charge_C(self, film: TouchedFilm) -> Floats:
        """Charge p A dT (t, e) in C."""
        return np.asarray(1e-6 * film.pyroelectric_uC_per_m2_K * self.warming_K(film.time_s)[:, None] * film.area_m2)


@dataclass(frozen=True)
class ContactCharge(Added):
    """Charge that the dot leaves on the electrodes, all of it at the largest contact area, before that by a power of
    the area. The electrodes share it as their areas are.
    """

    charge_pC: float = 0.0
    area_exponent: float = 1.0

    @property
    def is_off(self) -> bool:
        """Whether the dot leaves no charge."""
        return self.charge_pC == 0.0

    def charge_C(self, film: TouchedFilm) -> Floats:
        """Charge (t, e) in C."""
        share = film.area_m2 / film.area_m2.sum()
        return np.asarray(1e-12 * self.charge_pC * (film.touched**self.area_exponent)[:, None] * share)
