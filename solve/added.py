"""What is added to a trace once it is solved, since it acts neither on the segment nor on the dot: a force that the
sensor carries beside the segment, or charge of the film that is not of its strain.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats


@dataclass(frozen=True)
class Motion:
    """Of the rig's displacement sensor: its path_mm (t,), with derivatives that are calculated where asked for.

    velocity : mm/s (t,); acceleration : mm/s2 (t,).
    """

    path_mm: Floats
    velocity: Callable[[], Floats]
    acceleration: Callable[[], Floats]


@dataclass(frozen=True)
class TouchedFilm:
    """The film under a dot over time. time_s : (t,) since the first touch, negative before it.

    touched : (t,) contact area over the largest one; area_m2 : (e,) of the electrodes. strain_charge_C : (t, e) that
    the strain alone makes.
    """

    time_s: Floats
    touched: Floats
    area_m2: Floats
    pyroelectric_uC_per_m2_K: float
    strain_charge_C: Floats


class Added:
    """One effect that is added to a trace; those that are not overridden add nothing.

    follows_time : whether the path or its speed matters to it.
    """

    follows_time = False

    @property
    def is_off(self) -> bool:
        """Whether its values add nothing."""
        return False

    def force_N(self, motion: Motion) -> Floats:
        """Force (t,) in N that the sensor carries beside the segment's, against the motion."""
        return np.zeros(len(motion.path_mm))

    def charge_C(self, film: TouchedFilm) -> Floats:
        """Charge (t, e) in C on the electrodes."""
        return np.zeros((len(film.time_s), len(film.area_m2)))


def added_charge_C(
    added: Iterable[Added], time_s: Floats, contact_area: Floats, area_m2: Floats, pyroelectric_uC_per_m2_K: float,
    strain_charge_C: Floats,
) -> Floats:  # fmt: skip
    """Sum (t, e) of their charges in C. contact_area : (t,) in any unit; area_m2 : (e,) of the electrodes.

    strain_charge_C : (t, e) that the strain makes.
    """
    touched = contact_area / max(float(contact_area.max()), 1e-300)
    film = TouchedFilm(time_s, touched, area_m2, pyroelectric_uC_per_m2_K, strain_charge_C)
    return np.asarray(sum((one.charge_C(film) for one in added), np.zeros((len(time_s), len(area_m2)))))
