"""What the page needs to build its form: the schema, and what is built in, with sources."""

from importlib.resources import files
from typing import Any

from softdot.commands.list import LISTS
from softdot.commands.new import UNITS
from softdot.config.default_design import default_design
from softdot.config.schema import Config
from softdot.config.toml import leaves, parse_toml
from softdot.studio.starts import starts
from solve.mechanisms import MECHANISMS
from solve.mechanisms.base import MechanismType


def form() -> dict[str, Any]:
    """Schema of the configuration, endings of keys and their units, materials, standards, mechanisms.

    basic : dotted keys that the page shows first, which are those that a template states. starts : designs to begin
    with (softdot.studio.starts).
    """
    return {
        "schema": Config.model_json_schema(),
        "units": UNITS,
        "basic": _basic(),
        "starts": starts(),
        **{what: LISTS[what]() for what in ("materials", "standards")},
        "mechanisms": [_mechanism(kind) for kind in MECHANISMS.values()],
    }


TEMPLATES = "dome", "slice"
"""Of a press; those of circuits and of time are for what is shown on demand."""


def _basic() -> list[str]:
    folder = files("softdot.templates")
    tables = [parse_toml(folder.joinpath(f"{name}.toml").read_text("utf-8"), name) for name in TEMPLATES]
    return sorted({".".join(way) for one in (default_design(), *tables) for way, _ in leaves(one)})


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
