"""Physics and geometry that this program lacks: hints for those who ask, and the table of docs/limits.md."""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class NotModelled:
    """One thing that is not modelled.

    what : its name. instead : what there is in its place. words : parts of a key or a value that ask for it. under :
    dotted key of the table below which they do; "" for any.
    """

    what: str
    instead: str
    words: frozenset[str]
    under: str = ""


def _entry(what: str, instead: str, words: str, under: str = "") -> NotModelled:
    return NotModelled(what, instead, frozenset(words.split()), under)


NOT_MODELLED = (
    _entry(
        "rings, or electrodes with holes",
        "electrodes are rectangles, circles (radius_mm) and polygons (corners_mm)",
        "diameter round circular ring annulus hole",
        "segment.film.electrodes",
    ),
    _entry(
        "thick or stiff electrodes", "electrodes have no thickness", "thickness material", "segment.film.electrodes"
    ),
    _entry("a curved base", "the base and all layers are flat", "curved curvature bent"),
    _entry(
        "a dot that is no surface of revolution, from a STEP or STL file",
        "the dot is a cap, a ridge, a plate, or a profile over its radius, which softdot scan fits to a surface",
        "step stl file scan scanned mesh heightmap",
        "dot",
    ),
    _entry(
        "parts of the segment from a STEP or STL file",
        "mesh.file takes a mesh of your own with the parts and sizes of [segment]",
        "step stl cad scan file",
        "segment",
    ),
    _entry(
        "other layers, or more of them",
        "the stack is medium2, film, medium1 and an effector",
        "medium0 medium3 medium4 film1 film2 films layers substrate",
        "segment",
    ),
    _entry(
        "humidity, swelling, shrinkage",
        "a material has the constants that you state",
        "humidity moisture swelling shrinkage",
    ),
    _entry(
        "thermal expansion, conduction of heat, constants that depend on temperature",
        "the mechanism pyroelectric-drift gives the charge of a warmer film",
        "expansion conduction conductivity thermal",
    ),
    _entry("ageing, fatigue, wear", "state the constants and sizes of today", "ageing aging fatigue wear"),
    _entry(
        "depolarisation of the film",
        "a run warns of a field that could do it",
        "depolarisation depolarization depoling poling",
    ),
    _entry("shear coefficients of the film", "d31, d32 and d33 are all that load electrodes on its faces", "d15 d24"),
    _entry(
        "tearing, cracks, failure of glue",
        "a run warns beyond the yield stress and the fitted range",
        "tear tearing crack fracture failure",
    ),
    _entry("gravity", "a segment weighs some 20 mg", "gravity weight"),
    _entry("adhesion of the dot", "contact only pushes; friction is a mechanism", "adhesion sticky"),
)


def not_modelled(word: str, under: str = "") -> str:
    """The hint for a key or a value that asks for something which does not exist, "" for any other.

    under : the dotted key of its table.

    >>> not_modelled("thickness_um", "segment.film.electrodes[0]")
    'not modelled: thick or stiff electrodes; electrodes have no thickness'
    """
    parts = set(re.split(r"[^a-z0-9]+", word.lower()))
    for one in NOT_MODELLED:
        if parts & one.words and under.startswith(one.under):
            return f"not modelled: {one.what}; {one.instead}"
    return ""
