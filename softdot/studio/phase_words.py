"""The sentence of a phase: what the page says of the present design, and which buttons stand beside it."""

from collections.abc import Mapping
from typing import Any

STAGES = {
    "mesh": "meshing",
    "press": "the first load step",
    "error bars": "error bars",
    "loading": "the solver is being loaded",
}
OF_PHASE = {
    "edited": "The design is being checked.",
    "drawn": "The parts are drawn; the design is being checked.",
    "estimated": "Estimated from a press before; this design is pressed when your hand rests.",
    "checked": "The design is checked; its press follows.",
    "coarse": "Pressed on large elements; the accurate press follows.",
    "accurate": "Pressed, as softdot run does.",
}


def phase_words(
    phase: str,
    check: Mapping[str, Any] | None,
    pressed: tuple[str, str | None] | None,
    stopped: str | None,
    pressing: Mapping[str, Any] | None,
    estimated_by: str = "press",
) -> dict[str, Any]:
    """said, bad, busy (there is something to cancel) and again (it can be begun anew).

    check : of the present design. pressed : quality of its press, and why its steps end early. stopped : why a check or
    press has no answer. pressing : how far its press is; empty where it has only begun. estimated_by : press or family.
    """
    quality, failure = pressed or ("", None)
    is_final = phase in ("accurate", "failed", "cancelled") or quality == "array"
    words = {"said": OF_PHASE.get(phase, ""), "bad": phase == "failed", "busy": pressing is not None}
    words["again"] = pressing is None and is_final
    if phase == "estimated" and estimated_by == "family":
        words["said"] = "Estimated by the family; this design is pressed when your hand rests."
    if pressing is not None:
        words["said"] = _progress_words(pressing, phase)
    elif stopped is not None:
        words["said"] = stopped
    elif check is not None and check["mistakes"]:
        words |= {"said": "The design has a mistake; mend it and it is pressed.", "bad": True, "again": False}
    elif check is not None and check.get("press_hash") is None:
        words |= {"said": "Raise a dot of the cell to press it.", "again": False}
    elif failure is not None:
        words["said"] = f"Not converged, {failure}; the numbers are those of the steps before."
    elif quality == "array":
        words["said"] = "Pressed on large elements. Report and CAD is softdot array, as fine as the design asks for."
    return words


def _progress_words(progress: Mapping[str, Any], phase: str) -> str:
    """Such as: Pressing: load step 3 of 6, 4 s left."""
    stage, count = progress.get("stage"), progress.get("count")
    if stage == "waiting":
        return f"The press waits for {progress['text']}."
    if stage is None:
        return "Pressing: begins"
    begin = "Pressed" if phase == "accurate" else "Pressing"
    if stage == "press" and count:
        return f"{begin}: load step {progress['done']} of {count}{left_words(progress.get('left_s'))}"
    return f"{begin}: {STAGES.get(stage, stage)}"


def left_words(left_s: float | None) -> str:
    """Time that is left, none where it is not known."""
    if left_s is None:
        return ""
    return f", {max(1, round(left_s))} s left" if left_s < 90 else f", {left_s / 60:.1f} min left"
