"""Designs that a tab keeps beside the present one: one list of what is drawn, compared and gone back to."""

from collections.abc import Callable
from typing import Any

from foundation.errors import InputError
from softdot.studio.comparison import compared
from softdot.studio.design_facts import Json
from softdot.studio.design_state import DesignState

MOST_KEPT = 4
LONGEST_NAME = 60


class KeptDesigns:
    """At most MOST_KEPT designs, each with name, text, values, press_hash, numbers (None before its press), hidden."""

    def __init__(self) -> None:
        self._designs: list[Json] = []
        self._version = 0

    def keep(self, state: DesignState, name: str) -> None:
        """Add the present design. InputError."""
        if len(self._designs) >= MOST_KEPT:
            raise InputError(f"{MOST_KEPT} designs are compared at most; take one out first")
        now = state.present
        if now.values is None or now.press_hash is None:
            raise InputError("a design with mistakes, or not checked yet, cannot be compared")
        kept = {"name": self._named(name), "text": now.text, "values": now.values, "press_hash": now.press_hash}
        self._designs.append({**kept, "numbers": None, "quality": None, "hidden": False})
        self._version += 1

    def rename(self, number: int, name: str) -> None:
        """Call one otherwise. IndexError."""
        self._designs[number]["name"] = self._named(name)
        self._version += 1

    def hide(self, number: int, hidden: bool) -> None:
        """Whether one is drawn. IndexError."""
        self._designs[number]["hidden"] = hidden
        self._version += 1

    def drop(self, number: int) -> None:
        """Take one out. IndexError."""
        del self._designs[number]
        self._version += 1

    def text(self, number: int) -> str:
        """Of one. IndexError."""
        return str(self._designs[number]["text"])

    def renew(self, state: DesignState) -> None:
        """Each has the numbers of its latest press."""
        curves = {one["press_hash"]: one for one in state.curves()}
        for kept in self._designs:
            found = curves.get(kept["press_hash"])
            if found is not None and found["numbers"] != kept["numbers"]:
                kept |= {"numbers": found["numbers"], "quality": found["quality"]}
                self._version += 1

    def names(self) -> list[Json]:
        """What the message of the state holds of them."""
        return [{"name": one["name"], "hidden": one["hidden"], "quality": one["quality"]} for one in self._designs]

    def message(self) -> tuple[Any, Callable[[], Json]]:
        """Version and content: the designs with their numbers, and the table that compares them."""
        shown = [{key: one[key] for key in ("name", "hidden", "quality", "numbers")} for one in self._designs]
        names = [one["name"] for one in self._designs]
        return self._version, lambda: {
            "names": names, "designs": shown, "rows": compared(self._designs), "most": MOST_KEPT,
        }  # fmt: skip

    def _named(self, name: str) -> str:
        return name[:LONGEST_NAME].strip() or f"design {len(self._designs) + 1}"
