"""Mechanisms that rig.toml states, on top of the tables of a press that keeps to one path.

Friction, softening and yield are pressed as they are for a candidate, against the same segment without them: each is a
candidate with one value, 1, which is always on. What acts on the read-out acts on that of every run, as runs may state
amplifiers of their own. Hum has another phase in every run, so that nothing can be predicted of it: where it is stated,
the lines that a recording shows at rest are noise, however loud.
"""

from dataclasses import replace

from diagnose.forward import Candidate, Coordinate, Setting
from solve.mechanisms import Mechanism, with_mechanisms
from solve.model import Model, Readout
from solve.physics import linear_laws
from solve.readout.stages import Hum

STATED_COORDINATE = Coordinate("stated", 0.0, 1.0, (1.0,), nodes=(1.0,))


def untabulated_mechanisms(model: Model) -> tuple[Mechanism, ...]:
    """Mechanisms of a model that no table over depth holds: of the path, or of another phase in every run."""
    on = (one for one in model.mechanisms if not one.is_off)
    return tuple(one for one in on if one.traits.path_dependent or one.traits.free_phase)


def without_untabulated(model: Model) -> Model:
    """Model without the mechanisms that no table over depth holds."""
    apart = untabulated_mechanisms(model)
    stages = tuple(stage for stage in model.physics.stages if not isinstance(stage, Hum))
    terms = tuple(term for term in model.physics.terms if term.of_rig or not term.follows_time)
    physics = replace(model.physics, terms=terms, inelastic=linear_laws(model.physics.inelastic), stages=stages)
    return replace(model, physics=physics, mechanisms=tuple(one for one in model.mechanisms if one not in apart))


def permanent_settings(model: Model) -> tuple[Setting, ...]:
    """Settings, always on, of the model's mechanisms that depend on the path."""
    return tuple(
        Setting(_stated_candidate(one), (1.0,)) for one in untabulated_mechanisms(model) if one.traits.path_dependent
    )


def _stated_candidate(mechanism: Mechanism) -> Candidate:
    return Candidate(mechanism.name, mechanism.component, (STATED_COORDINATE,), lambda _: dict(mechanism.parameters))


def run_readout(model: Model, readout: Readout | None) -> Readout | None:
    """Read-out of a run with what the model's mechanisms make of it; that of the model where the run has none."""
    if readout is None:
        return model.readout
    electrical = [one for one in model.mechanisms if one.traits.electrical]
    return with_mechanisms(replace(model, readout=readout), electrical).readout
