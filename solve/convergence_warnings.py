"""Why a press that converged should still be doubted: contact that overlaps, a snap, time that is cut too coarsely."""

from collections.abc import Sequence

import numpy as np

from solve.result import Record, Step
from solve.solution.march import SMALLEST_IN_TIME, TIME_TOLERANCE

PENETRATION_LIMIT = 0.05  # of the depth; contact holds in weighted means, so a coarse surface can overlap at points


def convergence_warnings(steps: Sequence[Step], records: Sequence[Record]) -> tuple[str, ...]:
    """Warnings about a press that converged, one sentence each. steps : the reported ones; records : all states."""
    deepest = max(steps, key=lambda step: step.indentation_m)
    of_records = *_snap_warning(records), *_time_warning(records)
    return *_contact_warning(records), *_penetration_warning(deepest), *of_records


def _contact_warning(records: Sequence[Record]) -> tuple[str, ...]:
    """One warning where the dot never reached the segment, else none."""
    if len(records) < 2 or any(record.contact_area_m2 > 0.0 for record in records):
        return ()
    return (
        "the dot never touched the segment, so that force and charge of the press are zero: press deeper "
        "(press.indentation_mm), or see dot.gap_mm, dot.offset_mm and the effector",
    )


def _penetration_warning(step: Step) -> tuple[str, ...]:
    """One warning where the dot overlaps the surface by more than PENETRATION_LIMIT of the depth, else none."""
    overlap = -float(step.fields.gap_m.min())
    if overlap <= PENETRATION_LIMIT * max(step.indentation_m, 0.0) or overlap <= 1e-9:
        return ()
    return (
        f"the dot overlaps the surface by up to {1e3 * overlap:.2g} mm at single points: "
        "a smaller mesh.contact_element_size_mm is needed",
    )


def _snap_warning(records: Sequence[Record]) -> tuple[str, ...]:
    """One warning where the segment lost one equilibrium and found another, else none."""
    depths_mm = [f"{1e3 * record.indentation_m:.3f}" for record in records if record.snapped]
    if not depths_mm:
        return ()
    return (
        f"at {', '.join(depths_mm)} mm something snapped: Newton found no equilibrium near the one before. The free "
        "side of a soft layer may crease, and elements of a poor shape may give way: the picture of the deformed "
        "segment or another mesh will tell",
    )


def _time_warning(records: Sequence[Record]) -> tuple[str, ...]:
    """One warning where the time integration errs by more than TIME_TOLERANCE of the largest path, else none.

    Each error is relative to the state it occurred in: where the dot had hardly moved it means little.
    """
    path = np.abs([record.dot_path_m for record in records])
    path = np.maximum(path, np.append(0.0, path[:-1]))
    errors = np.array([record.time_error for record in records]) * path / max(float(path.max()), 1e-300)
    worst = int(np.argmax(errors))
    if errors[worst] <= TIME_TOLERANCE:
        return ()
    return (
        f"at {records[worst].time_s:.4g} s the error of the time integration in one sub-step is {errors[worst]:.2g} of "
        f"the largest path or stress (tolerance {TIME_TOLERANCE:g}): motion that is too fast for 1/"
        f"{1 / SMALLEST_IN_TIME:.0f} of a load step, such as the rebound of a light dot, is damped; more load steps "
        "(press.load_steps) are needed to see it",
    )
