"""An array that a recording was made of, as the one wide segment that it is where all its layers run through."""

from collections.abc import Sequence

from diagnose.signals.recording import RunTable
from foundation.errors import InputError
from geometry.array.checks import check_array
from geometry.array.layout import ArrayLayout, array_layout
from geometry.stack import layers
from softdot.config.model import as_segment
from softdot.config.schema import Config


def as_one_segment(config: Config, runs: Sequence[RunTable]) -> tuple[Config, tuple[RunTable, ...]]:
    """The configuration with an electrode on each segment, and the runs with their dots over the segments they press.

    Without an array both are returned unchanged. InputError for a run over a segment that is not there, and for an
    array with islands, grooves or a grid, which no mesh of one segment has.
    """
    if config.array is None:
        for number, run in enumerate(runs):
            if run.over is not None:
                raise InputError(
                    f"runs[{number}].over = {list(run.over)}: there is no [array], which has such segments"
                )
        return config, tuple(runs)
    layout = array_layout(config.array, config.segment, config.dot)
    check_array(layout)
    _refuse_interrupted_layers(layout)
    return as_segment(config, layout), tuple(_run_over_segment(run, number, layout) for number, run in enumerate(runs))


def _refuse_interrupted_layers(layout: ArrayLayout) -> None:
    """InputError for an array whose layers do not all run through: a diagnosis presses one segment."""
    for name in ("grooves", "grid_layers"):
        if getattr(layout.array, name):
            raise InputError(f"array.{name}: a diagnosis takes arrays whose layers run through without them")
    islands = [f"'{layer.name}'" for layer in layers(layout.segment) if layout.ends_at_walls(layer.name)]
    if islands:
        raise InputError(
            f"array.shared: leaves out {', '.join(islands)}, but a diagnosis takes arrays whose layers all run through"
        )


def _run_over_segment(run: RunTable, number: int, layout: ArrayLayout) -> RunTable:
    """The run with its dot moved over the segment that run.over names; the same run where it names none. InputError."""
    if run.over is None:
        return run
    found = [place for place in layout.places if (place.row, place.column) == run.over]
    if not found:
        rows, columns = layout.places[-1].row, layout.places[-1].column
        raise InputError(
            f"runs[{number}].over = {list(run.over)}: must be a row from 1 to {rows} and a column from 1 to {columns}"
        )
    x, y = run.dot_offset_mm
    return run.model_copy(update={"dot_offset_mm": (x + found[0].x_mm, y + found[0].y_mm)})
