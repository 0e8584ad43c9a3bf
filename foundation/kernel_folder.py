"""Where compiled kernels are kept.

numba compiles one anew when its own file changes, not when a file changes whose pieces it calls. They are therefore
kept in a folder that is named by these files. It lies in the source, as by numba's default, but not in that of an
installed package: kernels would stay behind when pip removes it, and the folders that hold them would hide a source
checkout that is installed afterwards.
"""

import os
from hashlib import sha256
from pathlib import Path

PIECES = (
    "solve/compiled.py",
    "solve/decay.py",
    "solve/tensors.py",
    "solve/fem/*.py",
    "solve/materials/*.py",
    "solve/reduced/table_reading.py",
    "solve/readout/filters.py",
    "diagnose/engines/coupon/*.py",
)


def keep_kernels_apart(package: Path) -> None:
    """Before numba is loaded: where the kernels of a program are kept, one of whose packages is this folder.

    What the user has set stays.
    """
    if "NUMBA_CACHE_DIR" in os.environ:
        return
    kept = package.parent / "solve" / "__pycache__"
    if {"site-packages", "dist-packages"} & set(package.parts):
        from platformdirs import user_cache_path

        kept = user_cache_path("softdot", appauthor=False)
    os.environ["NUMBA_CACHE_DIR"] = str(kept / "kernels" / _state_of_pieces(package.parent))


def _state_of_pieces(program: Path) -> str:
    """A name that changes with the files whose pieces are compiled into kernels of other files; some milliseconds."""
    sources = sorted(file for place in PIECES for file in program.glob(place))
    return sha256(b"".join(file.read_bytes() for file in sources)).hexdigest()[:12]
