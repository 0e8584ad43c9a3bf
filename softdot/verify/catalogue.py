"""All problems of softdot verify, in the order in which they are reported."""

from foundation.errors import InputError
from foundation.nearest_name import nearest_name_hint
from softdot.verify.problem import Problem
from softdot.verify.problems import (
    bonded,
    circuit,
    contact,
    cook,
    cylinder,
    delamination,
    film,
    friction,
    nafems,
    other_codes,
    patch,
    plates,
    segments,
    tension,
)

FAMILIES = (
    patch, tension, cylinder, plates, nafems, bonded, cook, contact, friction, delamination, film, circuit, segments,
    other_codes,
)  # fmt: skip
PROBLEMS: dict[str, Problem] = {problem.name: problem for family in FAMILIES for problem in family.PROBLEMS}


def chosen_problems(names: list[str]) -> list[Problem]:
    """The problems of these names, in the order of the catalogue; all for no name. InputError for an unknown name."""
    for name in names:
        if name not in PROBLEMS:
            raise InputError(f"--only {name}: no such problem; {nearest_name_hint(name, PROBLEMS)}")
    return [problem for problem in PROBLEMS.values() if not names or problem.name in names]
