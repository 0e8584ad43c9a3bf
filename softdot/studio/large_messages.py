"""The contents of artefacts, each in a message of its own that is sent again only where it has changed."""

from collections.abc import Callable
from functools import partial
from typing import Any

from softdot.studio.design_facts import Artefact, Json
from softdot.studio.design_state import DesignState
from softdot.studio.response import drawn_values

Content = Callable[[], Json]


def large_messages(state: DesignState) -> dict[str, tuple[Any, Content]]:
    """Kind of the message -> its version, and its content, which bears the revision of the design it belongs to."""
    made = state.artefacts()
    found: dict[str, tuple[Any, Content]] = {}
    for name, one in made.items():
        if name == "numbers":
            continue
        version: Any = one.number
        if name == "curves":
            version = state.version_of_curves
        elif name == "view":  # large, and the same again where the same is pressed again
            version = one.origin.revision, one.origin.press_hash, one.content.get("quality")
        elif name == "response":
            version = one.number, state.estimator.version
        found[name] = version, partial(_content, state, name, one)
    return found


def _content(state: DesignState, name: str, made: Artefact) -> Json:
    head, content = {"revision": made.origin.revision}, made.content
    if name == "curves":
        return {**head, "curves": state.curves()}
    if name == "parts":
        return {**head, "view": content}
    if name == "view":
        return {**head, "view": content["view"], "quality": content.get("quality", "array")}
    if name == "circuit":
        return {**head, "found": content["found"]}
    if name == "array":
        return {**head, "pressed": {**content, "press_hash": made.origin.press_hash}}
    if name == "response" and "line" not in content["result"]:
        asked = content["result"]
        line = state.estimator.along(made.origin.text, asked["key"], drawn_values(asked["range"]))
        return {**head, **content, "result": {**asked, "line": line, "by": "derivatives"}}
    return {**head, **content}
