"""All mechanisms that the program has: every one in a module of its own, known by being there."""

from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages

from solve.mechanisms.base import MECHANISMS, Traits

__all__ = ["MECHANISMS", "traits_of"]

HERE = "solve.mechanisms"

# they stand in folders beside this module, sorted by what they change
for _module in sorted(found.name for found in walk_packages([str(Path(__file__).parent)], f"{HERE}.")):
    if _module.count(".") > HERE.count(".") + 1:
        import_module(_module)


def traits_of(name: str) -> Traits:
    """Traits of a mechanism; the default ones of a name that is none, such as that of a nuisance parameter."""
    return MECHANISMS[name].traits if name in MECHANISMS else Traits()
