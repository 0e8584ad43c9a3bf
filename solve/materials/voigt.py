"""Symmetric tensors as six numbers: 11, 22, 33, 12, 23, 13; strains carry engineering shears."""

import numpy as np

from mesh.types import Floats

PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))


def to_voigt(tensor: Floats, shear: float = 1.0) -> Floats:
    """(..., 3, 3) -> (..., 6); shear = 2 for strains."""
    scale = np.array([1.0, 1.0, 1.0, shear, shear, shear])
    vector: Floats = np.stack([tensor[..., i, j] for i, j in PAIRS], axis=-1) * scale
    return vector


def from_voigt(vector: Floats, shear: float = 1.0) -> Floats:
    """(..., 6) -> (..., 3, 3); shear = 2 for strains."""
    tensor = np.empty((*vector.shape[:-1], 3, 3))
    for k, (i, j) in enumerate(PAIRS):
        value = vector[..., k] / (shear if k > 2 else 1.0)
        tensor[..., i, j] = tensor[..., j, i] = value
    return tensor


def strain_rotation(rotation: Floats) -> Floats:
    """(6, 6) matrix T with strain' = T strain for axes turned by rotation (3, 3), e'_i = R_ij e_j."""
    columns = [to_voigt(rotation @ from_voigt(unit, 2.0) @ rotation.T, 2.0) for unit in np.eye(6)]
    return np.stack(columns, axis=1)
