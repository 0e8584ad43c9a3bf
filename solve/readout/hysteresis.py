"""Charge of the film that follows its strain only after a play: hysteresis without rate.

Of the charge Q of the strain a share b_k comes behind a play of half width r_k,
    Q_shown = Q - sum b_k s_k,      s_k the stop of Q of half width r_k (solve.stop_operator)
so that the sensitivity is the stated one over large loops, 1 - sum b_k of it over small ones, and charge is left when
the load has gone. A film that answers to a push by another loop than to a pull has plays of the positive part of Q
too. Evenly spread plays make Rayleigh's law of ferroelectrics (Damjanovic, J. Appl. Phys. 82, 1997).
"""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from solve.added import Added, TouchedFilm
from solve.stop_operator import apply_stop


@dataclass(frozen=True)
class FilmHysteresis(Added):
    """Shares of the charge, and the play behind which each comes, half its width in pC; the same of a push alone."""

    shares: tuple[float, ...] = ()
    play_pC: tuple[float, ...] = ()
    push_shares: tuple[float, ...] = ()
    push_play_pC: tuple[float, ...] = ()
    follows_time = True

    @property
    def is_off(self) -> bool:
        """Nothing comes behind a play."""
        return not any((*self.shares, *self.push_shares))

    def held_back(self, signal: Floats, pC: float) -> Floats:
        """Part (t,) of a signal (t,) that is held back; pC : 1 pC in the unit of the signal."""
        of_push = zip(self.push_shares, self.push_play_pC, strict=True)
        each = [share * apply_stop(signal, play * pC) for share, play in zip(self.shares, self.play_pC, strict=True)]
        each += [share * apply_stop(np.maximum(signal, 0.0), play * pC) for share, play in of_push]
        return np.asarray(sum(each, np.zeros(len(signal))))

    def charge_C(self, film: TouchedFilm) -> Floats:
        """Charge (t, e) that is held back, negative."""
        each = [-self.held_back(charge, 1e-12) for charge in film.strain_charge_C.T]
        return np.column_stack(each)
