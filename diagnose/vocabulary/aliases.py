"""Candidates that are one and the same element of a model: a leak at the amplifier and one through the film, say.

They are told by the models that they make, not by a list. One of them stays a candidate and knows the names of the
others, so that no recording can be asked to tell them apart.
"""

from collections.abc import Iterable
from dataclasses import replace

from diagnose.forward import Candidate, Setting
from solve.mechanisms import with_mechanisms
from solve.model import Model


def without_aliases(model: Model, candidates: Iterable[Candidate]) -> tuple[Candidate, ...]:
    """Candidates that differ in the model that they make; each knows those of the others that are identical to it."""
    kept: list[tuple[Candidate, Model | None]] = []
    for one in candidates:
        made = _changed(model, _example(one))
        same = next((n for n, found in enumerate(kept) if made is not None and _is_alias(one, made, *found)), None)
        if same is None:
            kept.append((one, made))
        else:
            first = kept[same][0]
            kept[same] = replace(first, identical_to=(*first.identical_to, one.name)), made
    return tuple(one for one, _ in kept)


def _is_alias(one: Candidate, made: Model, other: Candidate, made_by_other: Model | None) -> bool:
    return one.coordinates == other.coordinates and made == made_by_other


def _example(one: Candidate) -> Setting:
    return Setting(one, tuple(coordinate.starts[0] for coordinate in one.coordinates))


def _changed(model: Model, setting: Setting) -> Model | None:
    """The model with a setting, without its name; None where it cannot be switched on."""
    try:
        changed = with_mechanisms(model, [setting.candidate.as_mechanism(setting.values)])
    except ValueError:
        return None
    return replace(changed, mechanisms=())
