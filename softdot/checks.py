"""Refuse what cannot be built or solved, before any work."""

from geometry.cache import check_folder
from geometry.checks import check_press_depth, check_pushed_dot, check_segment, press_warnings
from geometry.dot import DotShape, resolve_dot
from mesh.parameters import MeshOptions
from softdot.cost import refuse_huge_mesh
from softdot.warnings import held_rim_warnings
from solve.model import Model
from solve.solution.schedule import duration_s


def check_case(model: Model, options: MeshOptions) -> tuple[DotShape, list[str]]:
    """The dot at rest and what a user should know about this design. InputError."""
    check_folder()
    segment, press = model.segment, model.press
    if press.waveform is not None:
        duration_s(press.waveform)  # reads the file of shape = "file"
    warnings = check_segment(segment)
    depth = press.indentation_mm
    if depth is not None:
        check_press_depth(segment, depth)
    else:
        check_pushed_dot(model.dot, segment, press.path_xy_mm)
    dot_shape = resolve_dot(model.dot, segment)
    refuse_huge_mesh(segment, dot_shape, options)
    if depth is not None:
        warnings += press_warnings(dot_shape, segment, depth)
        warnings += held_rim_warnings(segment, dot_shape, depth)
    return dot_shape, warnings
