"""A family of designs that answers in milliseconds: courses with intervals and derivatives, and no answer outside."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.config.schema import Config
from softdot.differentiation import value_of
from softdot.families.presses import nearest
from softdot.families.quantity import FamilyQuantity, QuantityCourse
from softdot.families.space import FamilySpace

EDGE = 1e-9
"""How far beyond an end, in places, round-off may carry a value."""
SAME = 1e-9
"""Largest relative difference of numbers that are the same."""


@dataclass(frozen=True, repr=False)
class FamilyCourse:
    """Courses over the load steps, index 0 unloaded, of one design (s,), or of an array of designs (..., s).

    courses : quantity -> values, with the unit in its name, each an attribute too (course.reaction_force_N). interval :
    quantity -> low and high end, within which the whole course of a design drawn from the family lies with a
    probability of 95 %. slopes : key -> quantity -> derivative by the key, in the units of both.
    """

    courses: Mapping[str, Floats]
    interval: Mapping[str, tuple[Floats, Floats]]
    slopes: Mapping[str, Mapping[str, Floats]]

    def __getattr__(self, name: str) -> Floats:
        """The values of a quantity."""
        courses = self.__dict__.get("courses", {})
        if name in courses:
            return np.asarray(courses[name])
        raise AttributeError(f"this family has no quantity '{name}', only {', '.join(courses)}")

    def __repr__(self) -> str:
        """The deepest step of one design in a line."""
        if self.courses["reaction_force_N"].ndim > 1:
            return f"FamilyCourse of {self.courses['reaction_force_N'].shape[:-1]} designs"
        told = []
        for name, values in self.courses.items():
            low, high = (end[-1] for end in self.interval[name])
            told.append(f"{name} = {values[-1]:.4g} ({low:.4g} to {high:.4g})")
        return f"FamilyCourse({', '.join(told)})"


@dataclass(frozen=True)
class Region:
    """Where designs can be pressed. good : places (g, d) at which they can; refused : (f, d) at which they cannot, with
    a reason each.
    """

    good: Floats
    refused: Floats
    reasons: tuple[str, ...]

    def holds(self, places: Floats) -> NDArray[np.bool_]:
        """Whether places (q, d) are nearer to a good one than to a refused one; (q,)."""
        if not len(self.refused):
            return np.ones(len(places), dtype=bool)
        return np.asarray(nearest(places, self.good) < nearest(places, self.refused))

    def reason(self, place: Floats) -> str:
        """The reason at the refused place that is nearest to a place (d,)."""
        return self.reasons[int(np.linalg.norm(self.refused - place, axis=1).argmin())]


class Family:
    """The presses of a family and its surrogate. quantities : name -> quantity; facts : what family.json holds."""

    def __init__(
        self, space: FamilySpace, quantities: Mapping[str, FamilyQuantity], region: Region, facts: Mapping[str, Any]
    ) -> None:
        self.space, self.quantities, self.region, self.facts = space, dict(quantities), region, dict(facts)
        self.places = next(iter(self.quantities.values())).places
        self._names = {name: number for number, one in enumerate(space.ranges) for name in (one.name, *one.keys)}

    @property
    def keys(self) -> list[str]:
        """First key of each axis."""
        return [one.keys[0] for one in self.space.ranges]

    def press(self, **values: Any) -> FamilyCourse:
        """The answer for a design, or for arrays of designs at once, by short names of keys.

        family.press(medium1_thickness_mm=0.6): a key that is left out has the middle value of its range; whole keys are
        taken too, family.press(**{"segment.medium1.thickness_mm": 0.6}). InputError outside of the family.
        """
        columns = [one.values(0.0) for one in self.space.ranges]
        for name, value in values.items():
            if name not in self._names:
                raise InputError(f"{name}: this family varies {', '.join(one.name for one in self.space.ranges)}")
            columns[self._names[name]] = _numbers(name, value)
        try:
            stacked = np.broadcast_arrays(*columns)
        except ValueError:
            raise InputError("the arrays of a family's press differ in their shapes") from None
        return self.at_values(np.stack(stacked, axis=-1))

    def press_config(self, config: Config) -> FamilyCourse:
        """The answer for a configuration. InputError unless it differs from this family in its keys alone."""
        values = np.array([value_of(config, one.keys[0]) for one in self.space.ranges])
        places = np.array([one.places(value) for one, value in zip(self.space.ranges, values, strict=True)])
        self._refuse_outside(values[None], places[None])
        different = _first_difference(self.space.config_at(places), config)
        if different is not None:
            raise InputError(f"{different}: differs from that of the family, which varies {', '.join(self.keys)} alone")
        return self.at_values(values)

    def at_values(self, values: Floats) -> FamilyCourse:
        """The answer for values (..., d) of the axes in their order. InputError outside of the family."""
        flat = np.asarray(values, dtype=np.float64).reshape(-1, self.space.count)
        columns = [one.places(column) for one, column in zip(self.space.ranges, flat.T, strict=True)]
        places = np.column_stack(columns)
        self._refuse_outside(flat, places)
        found = {name: one.course(places) for name, one in self.quantities.items()}
        return self._told(found, places, np.shape(values)[:-1])

    def _told(self, found: Mapping[str, QuantityCourse], places: Floats, shape: tuple[int, ...]) -> FamilyCourse:
        """The answer in the shape (..., s) of what was asked, with slopes by the keys."""
        slopes: dict[str, dict[str, Floats]] = {}
        for number, one in enumerate(self.space.ranges):
            by_value = one.slopes(places[:, number])[:, None]
            slopes[one.keys[0]] = {
                name: (course.slopes[:, number] / by_value).reshape(*shape, -1) for name, course in found.items()
            }
        return FamilyCourse(
            {name: course.value.reshape(*shape, -1) for name, course in found.items()},
            {name: (course.low.reshape(*shape, -1), course.high.reshape(*shape, -1)) for name, course in found.items()},
            slopes,
        )

    def _refuse_outside(self, values: Floats, places: Floats) -> None:
        """InputError for values (q, d) at places (q, d) outside of a range, or in a region that cannot be pressed."""
        for number, one in enumerate(self.space.ranges):
            outside = ~(np.abs(places[:, number]) <= 1.0 + EDGE)
            if outside.any():
                worst = values[np.flatnonzero(outside)[0], number]
                raise InputError(f"{one.keys[0]} = {worst:.6g}: outside of this family, {one.low:g} to {one.high:g}")
        good = self.region.holds(places)
        if not good.all():
            first = int(np.flatnonzero(~good)[0])
            raise InputError(
                f"{self.space.told(places[first])}: within a region of this family that cannot be pressed "
                f"({self.region.reason(places[first])})"
            )


def _numbers(name: str, value: Any) -> Floats:
    """A value as finite numbers. InputError."""
    try:
        found = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name} = {value!r}: must be a number or an array of numbers") from None
    if not np.isfinite(found).all():
        raise InputError(f"{name}: must be finite numbers")
    return found


def _first_difference(one: Config, other: Config) -> str | None:
    """The first key in which two configurations differ, numbers up to round-off; None where they are the same."""

    def compare(left: Any, right: Any, way: str) -> str | None:
        if isinstance(left, dict) and isinstance(right, dict):
            for key in [*left, *(key for key in right if key not in left)]:
                found = compare(left.get(key), right.get(key), f"{way}.{key}" if way else str(key))
                if found is not None:
                    return found
            return None
        if isinstance(left, float) and isinstance(right, float):
            return None if abs(left - right) <= SAME * max(abs(left), abs(right)) else way
        return None if left == right else way

    dumped = [config.model_dump(mode="json", exclude={"fabrication", "mesh"}) for config in (one, other)]
    return compare(dumped[0], dumped[1], "")
