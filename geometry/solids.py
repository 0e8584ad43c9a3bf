"""All parts of the assembly as labelled, coloured build123d solids."""

from geometry.case_solid import case_is_printable, case_solid
from geometry.dot_shape import DotShape
from geometry.dot_solid import dot_solid
from geometry.layer_solids import layer_solids
from geometry.parameters import Segment
from geometry.part import Part, labelled_part
from geometry.stack import layers

__all__ = ["Part", "build_parts", "layer_solids"]


def build_parts(segment: Segment, dot_shape: DotShape) -> tuple[Part, ...]:
    """The parts from the top down: effector (if any), medium1, film, medium2, case, dot.

    They are what would be made: a plane-strain section gives the same solids, width_mm wide. The segment and
    the dot must have passed their checks.
    """
    solids = layer_solids(segment, segment.film.thickness_um * 1e-3)
    soft = [
        labelled_part(layer.name, solids[layer.name], layer.material, printable=False)
        for layer in reversed(layers(segment))
    ]
    case = labelled_part("case", case_solid(segment), None, case_is_printable(segment))
    dot = labelled_part("dot", dot_solid(dot_shape, segment), None, printable=True)
    return (*soft, case, dot)
