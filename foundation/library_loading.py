"""Large libraries of which a few modules are loaded without the rest."""

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec, module_from_spec
from typing import Any


def load_alone(package: str, *modules: str) -> None:
    """Load some modules of a package without the rest, which may take far longer; their names become the package's.

    Any other attribute of the package loads all of it. Nothing is done where the package is loaded already.
    ModuleNotFoundError where it is not installed.
    """
    if package in sys.modules:
        return
    spec = find_spec(package)
    if spec is None or spec.loader is None:
        raise ModuleNotFoundError(f"No module named '{package}'", name=package)
    alone, loader = module_from_spec(spec), spec.loader
    sys.modules[package] = alone
    for name in modules:
        module = import_module(f"{package}.{name}")
        vars(alone).update({known: value for known, value in vars(module).items() if not known.startswith("_")})

    def rest(name: str) -> Any:
        if name.startswith("__") and name not in ("__all__", "__version__"):  # Python looks for these by itself
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        vars(alone).pop("__getattr__")
        loader.exec_module(alone)
        return getattr(alone, name)

    vars(alone)["__getattr__"] = rest


@contextmanager
def without_garbage_collection() -> Iterator[None]:
    """Switch the garbage collector off for a block that loads libraries: it costs a quarter of their time."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.freeze()  # what is loaded stays, so it is never looked through
            gc.enable()
