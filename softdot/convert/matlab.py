"""Arrays of a MATLAB .mat file, up to version 7."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from scipy.io import loadmat
from scipy.io.matlab import MatReadError, matfile_version

from geometry.base import InputError, nearest
from mesh.types import Floats

HDF5 = 2
"""Major version of files that MATLAB calls 7.3: an HDF5 library more would save their user one save(..., '-v7')."""


def read_mat(
    file: Path | str, variables: Mapping[str, str], factors: Mapping[str, float] | None = None
) -> dict[str, Floats]:
    """Columns (t,) of a recording from the variables of a .mat file.

    variables : column -> variable, 'name.field' for a field of a structure. factors : column -> number by which its
    values are multiplied to be in the unit of the column. InputError for a file, variable or shape that does not fit.
    """
    tables = _loaded(Path(file))
    return {
        column: (factors or {}).get(column, 1.0) * _vector(tables, path, Path(file))
        for column, path in variables.items()
    }


def _loaded(file: Path) -> Mapping[str, object]:
    found: Mapping[str, object] = {}
    try:
        version, _ = matfile_version(file, appendmat=False)
        if version != HDF5:
            found = loadmat(file, squeeze_me=True, simplify_cells=True, appendmat=False)
    except (OSError, ValueError, TypeError, MatReadError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise InputError(f"'{file}': cannot be read as a .mat file ({reason})") from None
    if version == HDF5:
        raise InputError(f"'{file}': is a version 7.3 file; save it again in MATLAB with save(..., '-v7')")
    return found


def _vector(tables: Mapping[str, object], path: str, file: Path) -> Floats:
    """One real variable as (t,)."""
    value: object = tables
    for name in path.split("."):
        known = {key for key in value if not key.startswith("__")} if isinstance(value, Mapping) else set()
        if not isinstance(value, Mapping) or name not in known:
            raise InputError(f"'{file}': has no variable '{path}'; {nearest(name, known)}")
        value = value[name]
    array = np.asarray(value)
    if array.dtype.kind not in "fiu" or array.ndim != 1:
        raise InputError(f"'{file}': variable '{path}' has shape {array.shape}, one column of real numbers is needed")
    return array.astype(np.float64)
