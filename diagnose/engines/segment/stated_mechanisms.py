"""What rig.toml states of the physics, on top of the tables of a press that keeps to one path.

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

STATED = Coordinate("stated", 0.0, 1.0, (1.0,), nodes=(1.0,))


def stated_apart(model: Model) -> tuple[Mechanism, ...]:
    """Mechanisms of a model that no table over depth holds: of the path, or of another phase in every run."""
    on = (one for one in model.mechanisms if not one.is_off)
    return tuple(one for one in on if one.traits.path_dependent or one.traits.free_phase)


def without_stated(model: Model) -> Model:
    """The model without them."""
    apart = stated_apart(model)
    stages = tuple(stage for stage in model.physics.stages if not isinstance(stage, Hum))
    terms = tuple(term for term in model.physics.terms if term.of_rig or not term.follows_time)
    physics = replace(model.physics, terms=terms, inelastic=linear_laws(model.physics.inelastic), stages=stages)
    return replace(model, physics=physics, mechanisms=tuple(one for one in model.mechanisms if one not in apart))


def always_on(model: Model) -> tuple[Setting, ...]:
    """Those of them that depend on the path, as settings."""
    return tuple(Setting(_stated(one), (1.0,)) for one in stated_apart(model) if one.traits.path_dependent)


def _stated(mechanism: Mechanism) -> Candidate:
    return Candidate(mechanism.name, mechanism.component, (STATED,), lambda _: dict(mechanism.parameters))


def readout_behind(model: Model, readout: Readout | None) -> Readout | None:
    """The read-out of a run with what the model's mechanisms make of it; None: the model's own."""
    if readout is None:
        return model.readout
    electrical = [one for one in model.mechanisms if one.traits.electrical]
    return with_mechanisms(replace(model, readout=readout), electrical).readout
