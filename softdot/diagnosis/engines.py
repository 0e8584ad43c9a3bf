"""The forward model that a recording asks for: a segment in 3D, a coupon, or no more than charge per force."""

from diagnose.forward import Engine, Report
from softdot.config import Config
from softdot.rig_file import Rig


def engine_for(rig: Rig, report: Report) -> Engine:
    """The engine for what rig.toml describes. InputError; NoEquilibriumError where its baseline has none."""
    if rig.config is not None:
        return _of_segment(rig, rig.config, report)
    if rig.recording.specimen is not None:
        from diagnose.coupon import coupon_engine

        return coupon_engine(rig.recording, rig.materials, report)
    from diagnose.proportional import proportional_engine

    return proportional_engine(rig.recording, report)


def _of_segment(rig: Rig, config: Config, report: Report) -> Engine:
    from diagnose.segment import segment_engine
    from softdot.actual import actual
    from solve.model import Model

    changed, physics = actual(config)
    materials = changed.layer_materials()
    model = Model(changed.segment, materials, changed.dot, changed.press, changed.readout, physics)
    return segment_engine(model, changed.mesh, rig.recording, report)
