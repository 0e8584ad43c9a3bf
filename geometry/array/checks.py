"""Checks that refuse impossible arrays by name before anything is built."""

from foundation.errors import InputError
from geometry.array.layout import AXIS_NAMES, ArrayLayout
from geometry.part_checks import covers_footprint
from geometry.stack import layers

ROUNDING_MM = 1e-9
LEAST_GAP_MM = 0.02
"""A narrower gap is a knife's kerf, and neighbours that bulge would touch across it, which the model does not know."""

ROUND_EFFECTOR_SHARE = 0.95
"""Largest diameter of a round effector as a share of the segment's width, so that elements beside it have room."""


def check_array(layout: ArrayLayout) -> list[str]:
    """Raise InputError for an array that cannot be built; return warnings about one that can."""
    _check_segment(layout)
    _check_names(layout)
    _check_pitch(layout)
    _check_walls(layout)
    _check_grid(layout)
    for number in range(len(layout.array.grooves)):
        _check_groove(layout, number)
    _check_electrodes(layout)
    return _warnings(layout)


def _check_segment(layout: ArrayLayout) -> None:
    segment = layout.segment
    if layout.is_slice and layout.array.rows > 1:
        raise InputError(
            f"array.rows = {layout.array.rows}: segment.section = 'plane-strain' has nothing that varies over y; must "
            "be 1"
        )
    if segment.film.electrodes:
        raise InputError(
            "segment.film.electrodes: an array has one electrode on each segment; leave them out and give "
            "array.electrode_margin_mm"
        )
    if segment.bonds:
        raise InputError("segment.bonds: an array has perfect bonds; leave them out")
    effector = segment.effector
    if effector is None or effector.shape == "layer":
        return
    if "effector" in layout.array.shared:
        raise InputError(
            f"array.shared: names 'effector', whose shape '{effector.shape}' stands on each segment alone; use shape "
            "'layer'"
        )
    widest = ROUND_EFFECTOR_SHARE * min(layout.size_mm)
    if effector.diameter_mm is not None and effector.diameter_mm > widest + ROUNDING_MM:
        raise InputError(
            f"segment.effector.diameter_mm = {effector.diameter_mm:g}: in an array at most {widest:g}, "
            f"{ROUND_EFFECTOR_SHARE:g} of the segment's width"
        )


def _check_names(layout: ArrayLayout) -> None:
    present = {layer.name for layer in layers(layout.segment)}
    for field, names in (("shared", layout.array.shared), ("grid_layers", layout.array.grid_layers)):
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"array.{field}: '{name}' is named twice")
            if name not in present:
                raise InputError(f"array.{field}: names '{name}', but segment.{name} is absent")


def _check_pitch(layout: ArrayLayout) -> None:
    """Refuse segments or cells that overlap."""
    for axis, name in enumerate(("length_mm", "width_mm")):
        size, count = layout.size_mm[axis], len(layout.centres(axis))
        across = layout.array.columns if axis == 0 else layout.array.rows
        if across > 1 and size > layout.pitch_mm + ROUNDING_MM:
            raise InputError(
                f"array.pitch_mm = {layout.pitch_mm:g}: the segments overlap along {AXIS_NAMES[axis]}, "
                f"segment.{name} = {size:g} may be at most the pitch"
            )
        if axis == 0 and count > across and _column_distance_between_cells(layout) < size - ROUNDING_MM:
            raise InputError(
                f"array.cell_pitch_mm = {layout.cell_pitch_mm:g}: the cells overlap, it must be at least "
                f"{(across - 1) * layout.pitch_mm + size:g} for {across} columns of segments {size:g} mm long"
            )


def _column_distance_between_cells(layout: ArrayLayout) -> float:
    """Distance in mm from the middle of a cell's last column to that of the next cell's first one."""
    return layout.cell_pitch_mm - (layout.array.columns - 1) * layout.pitch_mm


def _check_walls(layout: ArrayLayout) -> None:
    """Refuse islands and layers held by the grid where no gap is left between the segments."""
    for layer in layers(layout.segment):
        if not layout.ends_at_walls(layer.name):
            continue
        for axis, name in enumerate(("length_mm", "width_mm")):
            foot, size = layout.foot_mm(layer.name)[axis], layout.size_mm[axis]
            gap = layout.gap_mm[axis] + size - foot
            if gap < LEAST_GAP_MM - ROUNDING_MM:
                why = "held by the grid" if layer.name in layout.array.grid_layers else "not in array.shared"
                raise InputError(
                    f"segment.{name} = {size:g}: leaves a gap of {max(gap, 0.0):g} mm along {AXIS_NAMES[axis]} at the "
                    f"pitch of {layout.pitch_mm:g} mm, and {layer.name}, which is {why}, needs at least "
                    f"{LEAST_GAP_MM:g} mm"
                )


def _check_grid(layout: ArrayLayout) -> None:
    held, boundary = layout.array.grid_layers, layout.segment.boundary
    if held and boundary == "elastic":
        raise InputError("segment.boundary = 'elastic': beside a stiff grid the rim is 'free' or 'clamped'")
    if "effector" in held and not covers_footprint(layout.segment):
        raise InputError("array.grid_layers: names 'effector', which is narrower than its segment and meets no grid")


def _check_groove(layout: ArrayLayout, number: int) -> None:
    groove = layout.array.grooves[number]
    field, name = f"array.grooves[{number}]", groove.layer
    if layout.ends_at_walls(name):
        why = "the grid holds it" if name in layout.array.grid_layers else "it does not run through"
        raise InputError(f"{field}.layer = '{name}': has no groove, as {why}; grooves are cut into array.shared layers")
    if not any(layer.name == name for layer in layers(layout.segment)):
        raise InputError(f"{field}.layer = '{name}': segment.{name} is absent")
    if len(layout.grooves(name)) > 1:
        raise InputError(f"{field}.layer = '{name}': has a groove already")
    layer = next(layer for layer in layers(layout.segment) if layer.name == name)
    if groove.depth_mm > layer.thickness_mm + ROUNDING_MM:
        raise InputError(f"{field}.depth_mm = {groove.depth_mm:g}: deeper than {name}, {layer.thickness_mm:g} mm")
    if len(layout.places) == 1:
        raise InputError(f"{field}: one segment has no neighbour to be cut from")
    nearest = min(layout.gap_mm[axis] + layout.size_mm[axis] for axis in (0, 1))
    if groove.width_mm >= nearest - ROUNDING_MM:
        raise InputError(f"{field}.width_mm = {groove.width_mm:g}: must be less than the pitch, {nearest:g} mm")


def _check_electrodes(layout: ArrayLayout) -> None:
    margin, narrow = layout.array.electrode_margin_mm, min(layout.size_mm)
    if 2 * margin >= narrow - ROUNDING_MM:
        raise InputError(
            f"array.electrode_margin_mm = {margin:g}: leaves no electrode on a segment {narrow:g} mm wide, must be "
            f"less than {narrow / 2:g}"
        )


def _warnings(layout: ArrayLayout) -> list[str]:
    runs_through = [layer for layer in layers(layout.segment) if not layout.ends_at_walls(layer.name)]
    margin = layout.array.electrode_margin_mm
    if len(layout.places) > 1 and runs_through and min(layout.gap_mm) + 2 * margin < LEAST_GAP_MM:
        return [
            f"the electrodes of neighbouring segments lie {max(min(layout.gap_mm), 0.0) + 2 * margin:g} mm apart: "
            "a real film mask needs array.electrode_margin_mm"
        ]
    return []
