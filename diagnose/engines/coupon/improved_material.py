"""The material after a coupon test, as a configuration has it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from diagnose.engines.coupon.engine import CouponEngine
from diagnose.engines.coupon.tested_layer import LAYER, active_mechanisms
from diagnose.forward import Setting


@dataclass(frozen=True)
class ImprovedMaterial:
    """A material after a coupon test. name : as in rig.toml.

    table : [materials.NAME], its law with the fitted constants.

    mechanisms : [[mechanisms]] of the layer that is made of it, for relaxation and softening are no constants of a law.
    """

    name: str
    table: dict[str, Any]
    mechanisms: tuple[dict[str, Any], ...]


def improved_material(engine: CouponEngine, settings: Sequence[Setting], component: str = LAYER) -> ImprovedMaterial:
    """Material with fitted settings, nuisances of its modulus among them; component : the layer that is made of it."""
    of_material = [s for s in settings if s.candidate.component not in ("drive", "rig")]
    mechanisms = active_mechanisms(of_material)
    law = engine.model([one for one in mechanisms if not one.traits.memory]).materials[LAYER]
    table = law.model_dump(mode="json", exclude_none=True, exclude={"source", "confidence", "max_fitted_strain"})
    kept = tuple(
        {"name": one.name, "component": component, "parameters": dict(one.parameters)}
        for one in mechanisms
        if one.traits.memory
    )
    return ImprovedMaterial(engine.specimen.material, table, kept)
