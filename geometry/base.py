"""What every package shares: the one exception for bad input, and what a mistyped name was probably meant to be.

Large libraries, of which a few modules are loaded without the rest.
"""

import difflib
import gc
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec, module_from_spec
from typing import Any


class InputError(ValueError):
    """One clear sentence: the field, its value and what is allowed. The command line exits with 2."""


def nearest(word: str, known: Iterable[str]) -> str:
    """The sentence end "did you mean 'x'?" where something is near, else the list of what is known.

    >>> nearest("thicknes_mm", ["thickness_mm", "material"])
    "did you mean 'thickness_mm'?"
    """
    names = sorted(known)
    best = max(names, key=lambda name: (_likeness(word, name), name), default="")
    return f"did you mean '{best}'?" if _likeness(word, best) >= 0.5 else f"known are {', '.join(names)}"


def _likeness(word: str, name: str) -> float:
    """How alike two names are: letter by letter and by the words that they are made of, whichever is more.

    >>> typed = "feedback_capacitance_pF"
    >>> _likeness(typed, "feedback_pF") > _likeness(typed, "input_capacitance_pF")
    True
    """
    letters = difflib.SequenceMatcher(None, name, word).ratio()
    mine, theirs = set(re.split("[_-]", word)), set(re.split("[_-]", name))
    words = len(mine & theirs) / len(mine | theirs)
    return max(letters, words) + 0.5 * words if len(mine & theirs) > 1 else letters


Report = Callable[[str, int, int], None]
"""Told of long work: what, done, of how many."""


def load_alone(package: str, *modules: str) -> None:
    """Load some modules of a package without the rest, which may take longer by far; their names are the package's.

    What else is asked of the package loads all of it, so that nobody misses anything. Nothing is done where the package
    is loaded already.
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
def without_collector() -> Iterator[None]:
    """For a block that loads libraries: they leave no garbage, and to look for it takes a quarter of their time."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.freeze()  # what is loaded stays, so it is never looked through
            gc.enable()
