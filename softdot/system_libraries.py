"""System libraries that a wheel needs and a machine may lack, with the command that installs them."""

import re
from collections.abc import Iterator
from contextlib import contextmanager

from foundation.errors import InputError

DEBIAN_PACKAGES = {
    "libGL.so.1": "libgl1",
    "libX11.so.6": "libx11-6",
    "libEGL.so.1": "libegl1",
    "libgomp.so.1": "libgomp1",
    "libstdc++.so.6": "libstdc++6",
}
"""System library -> the package of Debian that holds it."""
INSTALL_COMMAND = "apt-get install -y libgl1 libegl1"


@contextmanager
def name_missing_library() -> Iterator[None]:
    """Turn an ImportError of a wheel that lacks a system library into an InputError with the remedy, within a block."""
    try:
        yield
    except ImportError as error:
        found = re.search(r"(lib[\w+.-]+?\.so[.\d]*): cannot open shared object", str(error))
        if found is None:
            raise
        library = found.group(1)
        package = DEBIAN_PACKAGES.get(library, "the package that holds it")
        raise InputError(
            f"system library {library} is missing: install {package} (on Debian or Ubuntu '{INSTALL_COMMAND}')"
        ) from error
