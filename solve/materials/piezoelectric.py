"""The piezoelectric film: linear in Green-Lagrange strain and electric field, polarised along its normal.

Electric enthalpy per undeformed volume, with the piezoelectric strain d e3 taken off the strain:
    h(E, e3) = 1/2 (E - d e3) : C : (E - d e3) - 1/2 eps e3^2
    S = C : (E - d e3),      D3 = d . S + eps e3
(IEEE Std 176-1987, eqs. 2.x in the strain-charge form; eps at constant stress.) The short-circuit charge of the
design is the integral of d . S; open circuit means that the integral of D3 vanishes.
"""

from dataclasses import dataclass

import numpy as np

from mesh.types import Floats
from solve.materials.parameters import PiezoelectricFilm
from solve.materials.voigt import strain_rotation

VACUUM_PERMITTIVITY = 8.8541878128e-12  # F/m, CODATA 2018


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


def _stiffness(material: PiezoelectricFilm) -> Floats:
    """(6, 6) stiffness in the film's axes: isotropic, or with another modulus across the draw direction."""
    e1 = 1e6 * material.youngs_modulus_MPa
    e2 = 1e6 * (material.youngs_modulus_2_MPa or material.youngs_modulus_MPa)
    nu = material.poisson_ratio
    compliance = np.zeros((6, 6))
    compliance[:3, :3] = [
        [1 / e1, -nu / e1, -nu / e1],
        [-nu / e1, 1 / e2, -nu / e2],
        [-nu / e1, -nu / e2, 1 / e2],
    ]
    in_plane_shear = np.sqrt(e1 * e2) / (2.0 * (1.0 + nu))
    transverse_shear = e2 / (2.0 * (1.0 + nu))
    compliance[range(3, 6), range(3, 6)] = 1 / in_plane_shear, 1 / transverse_shear, 1 / in_plane_shear
    return np.asarray(np.linalg.inv(compliance), dtype=np.float64)


def film_law(material: PiezoelectricFilm, draw_angle_deg: float) -> FilmLaw:
    """The law of a film whose draw direction (axis 1) makes an angle with x, about z."""
    angle = np.deg2rad(draw_angle_deg)
    c, s = np.cos(angle), np.sin(angle)
    turn = strain_rotation(np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]))
    coupling = np.zeros(6)
    coupling[:3] = 1e-12 * np.array([material.d31_pC_per_N, material.d32_pC_per_N, material.d33_pC_per_N])
    # energy is the same in both axes: S_global = T^t S_film, so D3 = d . S_film = (T^-1 d) . S_global
    return FilmLaw(
        stiffness=turn.T @ _stiffness(material) @ turn,
        coupling=np.asarray(np.linalg.solve(turn, coupling), dtype=np.float64),
        permittivity=material.relative_permittivity * VACUUM_PERMITTIVITY,
        to_film_axes=turn,
    )
