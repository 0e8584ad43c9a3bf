"""The forward model of what rig.toml describes: a segment, a coupon or an unknown sensor."""

from collections.abc import Sequence

from diagnose.forward import Engine
from foundation.errors import InputError
from foundation.executor import HERE, Executor
from foundation.nearest_name import nearest_name_hint
from foundation.progress import Report
from softdot.config.rig import Rig
from softdot.config.schema import Config
from solve.mechanisms import MECHANISMS


def without_mechanisms(engine: Engine, without: Sequence[str]) -> Engine:
    """The engine without the candidates of some mechanisms. InputError for a name that no mechanism has."""
    for name in without:
        if name not in MECHANISMS:
            raise InputError(f"--without '{name}': {nearest_name_hint(name, MECHANISMS)}")
    return engine.with_candidates(tuple(one for one in engine.candidates if one.mechanism not in without))


def engine_for(rig: Rig, report: Report, executor: Executor = HERE) -> Engine:
    """The engine of the described rig. InputError; NoEquilibriumError where its baseline has none."""
    if rig.config is not None:
        return _segment_engine(rig, rig.config, report, executor)
    if rig.recording.specimen is not None:
        from diagnose.engines.coupon.engine import coupon_engine

        return coupon_engine(rig.recording, rig.materials, report, last={})
    from diagnose.engines.proportional.engine import proportional_engine

    return proportional_engine(rig.recording, report)


def _segment_engine(rig: Rig, config: Config, report: Report, executor: Executor) -> Engine:
    from diagnose.engines.segment.engine import segment_engine
    from softdot.config.model import model_of

    return segment_engine(model_of(config), config.mesh, rig.recording, report, executor)
