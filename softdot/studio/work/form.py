"""What the page needs to build its form: the schema, and what is built in, with sources."""

from typing import Any

from softdot.commands.list import LISTS
from softdot.commands.new import UNITS
from softdot.config.schema import Config
from solve.mechanisms import MECHANISMS
from solve.mechanisms.base import MechanismType


def form() -> dict[str, Any]:
    """Schema of the configuration, endings of keys and their units, materials, standards, mechanisms."""
    return {
        "schema": Config.model_json_schema(),
        "units": UNITS,
        **{what: LISTS[what]() for what in ("materials", "standards")},
        "mechanisms": [_mechanism(kind) for kind in MECHANISMS.values()],
    }


def _mechanism(kind: MechanismType) -> dict[str, Any]:
    return {
        "name": kind.name,
        "about": (kind.parameters.__doc__ or "").strip().split("\n")[0],
        "components": list(kind.components),
        "schema": kind.parameters.model_json_schema(),
        "typical": dict(kind.typical),
        "example": dict(kind.example),
    }


def warm_up() -> None:
    """Load what the form takes."""
    form()
    from solve.readout import course  # noqa: F401 - the filters of the first circuit
