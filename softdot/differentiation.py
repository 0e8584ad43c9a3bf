"""Derivatives of one press by any number of its configuration."""

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from foundation.arrays import Floats
from foundation.errors import InputError
from mesh.types import TetMesh
from softdot.config.loading import config_from
from softdot.config.model import model_of
from softdot.config.schema import Config
from solve.result import PressResult

if TYPE_CHECKING:
    from solve.solution.sensitivity import Slopes, Variation


RELATIVE_STEP = 1e-4


UNITS_OF_KEYS = {"mm", "um", "mm3", "MPa", "N", "V", "s", "pF", "MOhm", "Hz", "deg", "m3", "h", "g", "K"}
"""Endings of keys that are units."""


@dataclass(frozen=True, repr=False)
class Derivative:
    """Derivatives d(quantity)/d(key), in the quantity's unit over the key's own; (t,) over the times of the press.

    readout_voltage_V is None without an amplifier: no [readout] and no mechanism of one.
    """

    key: str
    value: float
    time_s: Floats
    reaction_force_N: Floats
    film_charge_pC: Floats
    open_circuit_voltage_V: Floats
    readout_voltage_V: Floats | None

    @property
    def units(self) -> dict[str, str]:
        """Unit of each quantity's derivative, such as N/mm for a force by a thickness in mm."""
        ending = self.key.rpartition("_")[2]
        below = f"/{ending}" if ending in UNITS_OF_KEYS else ""
        named = {
            "reaction_force_N": "N",
            "film_charge_pC": "pC",
            "open_circuit_voltage_V": "V",
            "readout_voltage_V": "V",
        }
        return {name: f"{unit}{below}" for name, unit in named.items() if getattr(self, name) is not None}

    def __repr__(self) -> str:
        """The derivatives at the last time, with their units."""
        last = (f"{name} {getattr(self, name)[-1]:.4g} {unit}" for name, unit in self.units.items())
        return f"Derivative(by {self.key} at {self.value:g}: {', '.join(last)})"


def derivatives_of_press(config: Config, keys: Sequence[str], tet_mesh: TetMesh) -> list[Derivative]:
    """Derivatives along the press of a configuration. InputError for the keys, and where the press does not
    converge.
    """
    result, found = press_with_derivatives(config, keys, tet_mesh)
    if not result.converged:
        raise InputError(f"the press stopped early: {result.failure}")
    return found


def press_with_derivatives(
    config: Config, keys: Sequence[str], tet_mesh: TetMesh
) -> tuple[PressResult, list[Derivative]]:
    """The press of a configuration that passed its checks, as far as it converged, and its derivatives along it.

    tet_mesh : of its segment. InputError for the keys.
    """
    from solve.solution.sensitivity import press_with_sensitivities

    try:
        result, slopes = press_with_sensitivities(model_of(config), variations_of(config, keys), tet_mesh)
    except ValueError as error:
        raise InputError(str(error)) from None
    return result, [_derivative(config, key, slope) for key, slope in slopes.items()]


def variations_of(config: Config, keys: Sequence[str]) -> dict[str, "Variation"]:
    """The models a little below and above each key. InputError for the keys."""
    from solve.solution.sensitivity import Variation

    variations = {}
    for key in keys:
        step = RELATIVE_STEP * abs(value_of(config, key))
        below, above = (model_of(with_changes(config, {key: sign * step})) for sign in (-1.0, 1.0))
        variations[key] = Variation(below, above, 2.0 * step)
    return variations


def _derivative(config: Config, key: str, slope: "Slopes") -> Derivative:
    return Derivative(
        key=key,
        value=value_of(config, key),
        time_s=slope.trace.time_s,
        reaction_force_N=slope.trace.reaction_force_N,
        film_charge_pC=1e12 * slope.trace.film_charge_C.sum(axis=1),
        open_circuit_voltage_V=slope.open_circuit_voltage_V,
        readout_voltage_V=slope.readout_voltage_V,
    )


def value_of(config: Config, key: str) -> float:
    """The number under a dotted key. InputError where there is none."""
    found: Any = config.model_dump(mode="json")
    for part in _parts(key):
        try:
            found = found[part]
        except (KeyError, IndexError, TypeError):
            raise InputError(f"{key}: the configuration has no such key") from None
    if isinstance(found, bool) or not isinstance(found, int | float) or found == 0.0:
        raise InputError(f"{key} = {found!r}: must be a number that is not zero")
    return float(found)


def _parts(key: str) -> list[str | int]:
    """Names and indices of a key: segment.film.electrodes[0].size_mm[1] -> segment, film, electrodes, 0, size_mm, 1."""
    parts: list[str | int] = []
    for name in key.split("."):
        head, *indices = name.replace("]", "").split("[")
        parts += [head, *(int(i) for i in indices)]
    return parts


def with_changes(config: Config, changes: Mapping[str, float]) -> Config:
    """The configuration with a change added to the value of each key. InputError for values that are not allowed."""
    tables = copy.deepcopy(config.model_dump(mode="json", exclude_none=True))
    for key, change in changes.items():
        table: Any = tables
        *path, last = _parts(key)
        for part in path:
            table = table[part]
        table[last] += change
    return config_from(tables)
