"""The folder in which numba keeps compiled kernels.

numba compiles a kernel anew when its own file changes, not when a file changes whose functions it calls. The folder is
therefore named by a hash of these files. It lies in the source, as by numba's default, but not in that of an
installed package: kernels would stay behind when pip removes it, and the folders that hold them would hide a source
checkout that is installed afterwards.
"""

import os
from hashlib import sha256
from pathlib import Path

SHARED_KERNEL_SOURCES = (
    "solve/compiled.py",
    "solve/decay.py",
    "solve/tensors.py",
    "solve/fem/*.py",
    "solve/materials/*.py",
    "solve/reduced/table_reading.py",
    "solve/readout/filters.py",
    "diagnose/engines/coupon/*.py",
    "softdot/reading/line_filter/*.py",
)


def set_kernel_folder(package: Path) -> None:
    """Set NUMBA_CACHE_DIR, before numba is loaded, unless the user has set it.

    package : folder of one of the packages of the program.
    """
    if "NUMBA_CACHE_DIR" in os.environ:
        return
    kept = package.parent / "solve" / "__pycache__"
    if {"site-packages", "dist-packages"} & set(package.parts):
        from platformdirs import user_cache_path

        kept = user_cache_path("softdot", appauthor=False)
    os.environ["NUMBA_CACHE_DIR"] = str(kept / "kernels" / _sources_hash(package.parent))


def _sources_hash(program: Path) -> str:
    """Return a name that changes with the files whose functions are compiled into kernels of other files."""
    sources = sorted(file for place in SHARED_KERNEL_SOURCES for file in program.glob(place))
    return sha256(b"".join(file.read_bytes() for file in sources)).hexdigest()[:12]
