"""The piezoelectric film: linear in Green-Lagrange strain and electric field, polarised along its normal.

Electric enthalpy per undeformed volume, with the piezoelectric strain d e3 taken off the strain:
    h(E, e3) = 1/2 (E - d e3) : C : (E - d e3) - 1/2 eps e3^2
    S = C : (E - d e3),      D3 = d . S + eps e3
(IEEE Std 176-1987, eqs. 2.x in the strain-charge form; eps at constant stress.) The short-circuit charge of the
design is the integral of d . S; open circuit means that the integral of D3 vanishes.
"""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from solve.materials.parameters import VACUUM_PERMITTIVITY, PiezoelectricFilm
from solve.tensors import strain_rotation


@dataclass(frozen=True)
class FilmLaw:
    """Constants in the axes of the segment.

    stiffness : (6, 6) Pa; coupling : (6,) C/N, so that D3 = coupling . S; permittivity : F/m;
    to_film_axes : (6, 6) turns a strain (engineering shears) into the film's own axes.
    """

    stiffness: Floats
    coupling: Floats
    permittivity: float
    to_film_axes: Floats


def film_law(material: PiezoelectricFilm, draw_angle_deg: float) -> FilmLaw:
    """The law of a film whose draw direction (axis 1) makes an angle with x, about z."""
    angle = np.deg2rad(draw_angle_deg)
    c, s = np.cos(angle), np.sin(angle)
    turn = strain_rotation(np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]))
    # energy is the same in both axes: S_global = T^t S_film, so D3 = d . S_film = (T^-1 d) . S_global
    return FilmLaw(
        stiffness=turn.T @ (1e6 * material.stiffness_MPa) @ turn,
        coupling=np.asarray(np.linalg.solve(turn, material.coupling_C_per_N), dtype=np.float64),
        permittivity=material.relative_permittivity * VACUUM_PERMITTIVITY,
        to_film_axes=turn,
    )
