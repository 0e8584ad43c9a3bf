"""A compliant adhesive: what it adds along and across a bond to what rig.toml declares."""

from collections.abc import Iterator, Sequence
from math import asinh, inf, sinh
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.base import GIVES_WAY, Vocabulary, register
from diagnose.vocabulary.scene import Scene
from solve.mechanisms.boundaries.adhesive_compliance import ADHESIVE_COMPLIANCE
from solve.physics import BondLine

STIFF_N_PER_MM3 = 50.0  # a film of PVDF, a few mm long, begins to lag behind a medium
PERFECT_N_PER_MM3 = 1e6
RATIO = 300.0  # along to across, or the reverse: a layer of rubber has some 30; beyond, Newton's method has trouble
SOFTEST_N_PER_MM3 = 0.2  # half a millimetre of foam tape at 0.1 MPa
NODES = 0.1, 0.35, 0.65, 1.0  # of the way to the softest


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for every bond that the stack has."""
    yield from (_adhesive(scene, bond) for bond in scene.bonds)


def _adhesive(scene: Scene, bond: str) -> Candidate:
    """Compliance along and across the bond, added to what rig.toml declares."""
    declared = scene.model.physics.bonds.get(bond, BondLine(inf, inf))
    softest = asinh(STIFF_N_PER_MM3 / SOFTEST_N_PER_MM3)
    nodes = tuple(share * softest for share in NODES)
    starts = 0.15 * softest, 0.5 * softest
    coordinates = tuple(Coordinate(f"{way}_compliance", 0.0, softest, starts, nodes) for way in ("normal", "shear"))

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        have = declared.normal_stiffness_N_per_mm3, declared.shear_stiffness_N_per_mm3
        normal, shear = (1.0 / k + max(sinh(x), 0.0) / STIFF_N_PER_MM3 for k, x in zip(have, values, strict=True))
        return {
            "normal_stiffness_N_per_mm3": _stiffness(max(normal, shear / RATIO)),
            "shear_stiffness_N_per_mm3": _stiffness(max(shear, normal / RATIO)),
        }

    units = {"normal_stiffness_N_per_mm3": "N/mm3", "shear_stiffness_N_per_mm3": "N/mm3"}
    return Candidate(ADHESIVE_COMPLIANCE.name, bond, coordinates, parameters, units=units, together="glue")


def _stiffness(compliance: float) -> float:
    """Stiffness as a law takes it; what is stiffer than any glue is as good as perfect."""
    return 1.0 / max(compliance, 1.0 / PERFECT_N_PER_MM3)


register(Vocabulary(ADHESIVE_COMPLIANCE, "{} is compliant", of_segment=of_segment, kind=GIVES_WAY))
