"""Symmetric tensors as six numbers: 11, 22, 33, 12, 23, 13; strains carry engineering shears."""

import numpy as np

from foundation.arrays import Floats
from solve.compiled import piece

I_OF = np.array([0, 1, 2, 0, 1, 0])
J_OF = np.array([0, 1, 2, 1, 2, 2])
NUMBER_OF = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
"""Which of the six numbers each component is, and back."""


@piece()
def inverse(c, out):  # type: ignore[no-untyped-def]
    """Inverse of a 3 x 3 matrix into out; returns the determinant."""
    out[0, 0] = c[1, 1] * c[2, 2] - c[1, 2] * c[2, 1]
    out[0, 1] = c[0, 2] * c[2, 1] - c[0, 1] * c[2, 2]
    out[0, 2] = c[0, 1] * c[1, 2] - c[0, 2] * c[1, 1]
    out[1, 0] = c[1, 2] * c[2, 0] - c[1, 0] * c[2, 2]
    out[1, 1] = c[0, 0] * c[2, 2] - c[0, 2] * c[2, 0]
    out[1, 2] = c[0, 2] * c[1, 0] - c[0, 0] * c[1, 2]
    out[2, 0] = c[1, 0] * c[2, 1] - c[1, 1] * c[2, 0]
    out[2, 1] = c[0, 1] * c[2, 0] - c[0, 0] * c[2, 1]
    out[2, 2] = c[0, 0] * c[1, 1] - c[0, 1] * c[1, 0]
    det = c[0, 0] * out[0, 0] + c[0, 1] * out[1, 0] + c[0, 2] * out[2, 0]
    for i in range(3):
        for j in range(3):
            out[i, j] /= det
    return det


def to_voigt(tensor: Floats, shear: float = 1.0) -> Floats:
    """Six numbers (..., 6) of symmetric tensors (..., 3, 3); shear = 2 for strains."""
    scale = np.array([1.0, 1.0, 1.0, shear, shear, shear])
    vector: Floats = tensor[..., I_OF, J_OF] * scale
    return vector


def from_voigt(vector: Floats, shear: float = 1.0) -> Floats:
    """Symmetric tensors (..., 3, 3) of six numbers (..., 6); shear = 2 for strains."""
    scale = np.array([1.0, 1.0, 1.0, shear, shear, shear])
    tensor: Floats = (vector / scale)[..., NUMBER_OF]
    return tensor


def strain_rotation(rotation: Floats) -> Floats:
    """Matrix T (6, 6) with strain' = T strain for axes turned by rotation (3, 3), e'_i = R_ij e_j."""
    columns = [to_voigt(rotation @ from_voigt(unit, 2.0) @ rotation.T, 2.0) for unit in np.eye(6)]
    return np.stack(columns, axis=1)
