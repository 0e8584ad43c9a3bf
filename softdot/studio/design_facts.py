"""Facts about a design, each with the design to which it belongs."""

from dataclasses import dataclass
from typing import Any, Literal

Json = dict[str, Any]
Phase = Literal["edited", "checked", "drawn", "estimated", "coarse", "accurate", "failed", "cancelled"]
ANSWER = "reaction_force_N", "film_charge_pC", "open_circuit_voltage_V"


@dataclass(frozen=True)
class Origin:
    """The design of which something was made. values : of its configuration, None before it was checked.

    press_hash : of all that its press depends on, None where that is not known or nothing is pressed.
    """

    revision: int
    text: str
    values: Json | None = None
    press_hash: str | None = None


@dataclass(frozen=True)
class Artefact:
    """Something that was made of a design. number : grows with every artefact, so that a newer one is known by it."""

    origin: Origin
    content: Any
    number: int


@dataclass(frozen=True)
class KnownPress:
    """A press. quality : coarse, accurate, or array. complete : nothing of it is still to come."""

    origin: Origin
    label: str
    quality: str
    found: Json
    complete: bool
    number: int

    @property
    def failure(self) -> str | None:
        """Why its steps end early, None where all converged."""
        if self.quality == "array":
            failure: str | None = self.found["array"].get("failure")
            return failure
        solver = self.found["numbers"]["solver"]
        return None if solver["converged"] else str(solver["failure"])

    @property
    def answer(self) -> tuple[float, float, float] | None:
        """Force (N), charge (pC) and voltage (V) at full load of an accurate press; None where that was not reached."""
        if self.quality != "accurate" or self.failure is not None:
            return None
        numbers = self.found["numbers"]
        force, charge, voltage = (numbers[name][-1] for name in ANSWER)
        return force, charge, voltage

    @property
    def point(self) -> Json | None:
        """Its answer as a point of a response; None as of answer."""
        if self.answer is None:
            return None
        force, charge, voltage = self.answer
        warnings = self.found["numbers"].get("warnings", [])
        return {"force_N": force, "charge_pC": charge, "voltage_V": voltage, "warnings": warnings}

    @property
    def mesh_errors(self) -> tuple[float, float, float]:
        """By which shares its mesh may put force, charge and voltage off."""
        off = self.found["numbers"].get("discretisation_error") or {}
        force, voltage = (0.01 * (off.get(name) or 0.0) for name in ("force_percent", "voltage_percent"))
        return force, voltage, voltage


@dataclass(frozen=True)
class Stop:
    """A check or press that ended without an answer: that of this text, or of this press_hash."""

    origin: Origin
    phase: Phase
    said: str
