"""Candidates of the bonds: a compliant adhesive, a delaminated patch."""

from collections.abc import Iterator, Sequence
from math import asinh, inf, sinh, sqrt
from typing import Any

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary.scene import Scene
from solve.mechanisms import BONDS
from solve.model import BondLine

STIFF_N_PER_MM3 = 50.0  # a film of PVDF, a few mm long, begins to lag behind a medium
PERFECT_N_PER_MM3 = 1e6
RATIO = 300.0  # along to across, or the reverse: a layer of rubber has some 30; beyond, Newton's method has trouble
SOFTEST_N_PER_MM3 = 0.2  # half a millimetre of foam tape at 0.1 MPa
NODES = 0.1, 0.35, 0.65, 1.0  # of the way to the softest
LARGEST_PATCH = 0.9  # of the width


def of_bonds(scene: Scene) -> Iterator[Candidate]:
    """Of every bond that the stack has."""
    for bond in BONDS:
        if "effector" in bond and scene.model.segment.effector is None:
            continue
        yield _adhesive(scene, bond)
        yield _delamination(scene, bond)


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
    return Candidate("adhesive-compliance", bond, coordinates, parameters, units=units)


def _stiffness(compliance: float) -> float:
    """What is stiffer than any glue is as good as perfect."""
    return 1.0 / max(compliance, 1.0 / PERFECT_N_PER_MM3)


def _delamination(scene: Scene, bond: str) -> Candidate:
    """A patch at the centre, by its share of the width: of the area in a solid, of the length in a slice."""
    segment = scene.model.segment
    solid = segment.section == "solid"
    width = min(segment.length_mm, segment.width_mm) if solid else segment.length_mm
    most = LARGEST_PATCH**2 if solid else LARGEST_PATCH
    nodes = (0.2 * most, 0.5 * most, most)
    coordinate = Coordinate("share", 0.0, most, (0.1 * most, 0.5 * most), nodes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        share = max(values[0], 0.0)
        return {"center_mm": (0.0, 0.0), "diameter_mm": width * (sqrt(share) if solid else share)}

    return Candidate("delamination", bond, (coordinate,), parameters, units={"center_mm": "mm", "diameter_mm": "mm"})
