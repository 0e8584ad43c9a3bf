"""Where a press stopped and what a user can do about it."""

import numpy as np

from foundation.arrays import Floats, Ints
from solve.solution.crushing import CRUSHED_VOLUME_RATIO, smallest_volumes
from solve.solution.errors import LostContactError, NoEquilibriumError
from solve.solution.held_rim import rim_met
from solve.solution.linear import LinearSolveError
from solve.system import Load, State, System
from solve.terms.solid import InvertedElementError

FINER_ADVICE = (
    "try more load steps (press.load_steps), a finer mesh (mesh.contact_element_size_mm), or a smaller depth or force"
)
HELD_ADVICE = (
    "something can move freely, or the dot presses on a part that the case holds: change "
    "segment.held_layers, stiffen the bonds, or move the dot"
)
RIM_ADVICE = (
    "move the dot (dot.offset_mm, dot.tilt_deg), enlarge the segment, hold fewer layers (segment.held_layers) or press "
    "less deep"
)
SAME_VOLUME = 1e-6  # of det F: round-off must not choose between two elements
CONTACT_ADVICE = (
    "keep the dot over the segment (dot.offset_mm, press.path_xy_mm), or prescribe the depth (press.indentation_mm)"
)


def explain_failure(system: System, failure: NoEquilibriumError, last: State, load: Load) -> str:
    """Say why a press stopped, in which part and where (undeformed, mm), and what to do.

    last : the last converged state; load : the one for which there is no equilibrium.

    Of an inversion the part and the place are those of the element that was nearest to it there: which one a diverging
    iteration inverts first is round-off.
    """
    rim = rim_met(system, last, load)
    if rim is not None:
        part = _part_with(system, rim)
        at = _place_words(system, system.points[[rim]])
        return f"the dot meets the rim of {part} that the case holds{at}, and neither can deform; {RIM_ADVICE}"
    cause, (volume, crushed) = failure.__cause__, _nearest_to_inversion(system, last)
    if crushed is not None and volume < CRUSHED_VOLUME_RATIO:
        to = f"{100.0 * volume:.0f} % of its volume"
        said = f"an element of {crushed.region} is crushed to {to} and turned inside out"
        return f"{said}{_place_words(system, system.points[crushed.nodes])}; {_advice(system, failure)}"
    if isinstance(cause, InvertedElementError):
        inverted = crushed or cause
        return f"{inverted}{_place_words(system, system.points[inverted.nodes])}; {_advice(system, failure)}"
    return f"{failure}{_failure_place(system, failure)}; {_advice(system, failure)}"


def _nearest_to_inversion(system: System, state: State) -> tuple[float, InvertedElementError | None]:
    """The smallest det F and its element, of equal ones the first; None in a state that squeezes none."""
    displacement = system.displacement(state.x)
    least: list[tuple[float, str, Ints]] = []
    for name, region in ({solid.name: solid for solid in system.solids} | {"film": system.film}).items():
        smallest = smallest_volumes(region, displacement)
        first = int(np.argmax(smallest <= (1.0 + SAME_VOLUME) * smallest.min()))
        least.append((float(smallest[first]), name, region.tets[first]))
    bound = (1.0 + SAME_VOLUME) * min(volume for volume, _, _ in least)
    volume, name, nodes = next(one for one in least if one[0] <= bound)
    return volume, InvertedElementError(name, nodes) if volume < 1.0 - SAME_VOLUME else None


def _advice(system: System, failure: NoEquilibriumError) -> str:
    """Advice for a failure whose part and place are known."""
    if isinstance(failure, LostContactError):
        return CONTACT_ADVICE
    advice = HELD_ADVICE if isinstance(failure.__cause__, LinearSolveError) else FINER_ADVICE
    return f"{advice}; under a force, {CONTACT_ADVICE}" if system.force_driven else advice


def _failure_place(system: System, failure: NoEquilibriumError) -> str:
    """Words for the part and the place of the largest unbalanced force; empty where nothing is known."""
    if isinstance(failure, LostContactError):
        contact = system.contact
        part = _part_with(system, int(contact.facets[0, 0]))
        return f" over {part}{_place_words(system, system.points[contact.facets.ravel()])}"
    if failure.worst is None:
        return ""
    return f", worst in {_part_with(system, failure.worst)}{_place_words(system, system.points[[failure.worst]])}"


def _part_with(system: System, node: int) -> str:
    """Name of a part that a node belongs to."""
    regions = {solid.name: solid.tets for solid in system.solids} | {"film": system.film.tets}
    return next(name for name, tets in regions.items() if (tets == node).any())


def _place_words(system: System, points: Floats) -> str:
    """Words for the mean of points (n, 3)."""
    x, y, z = 1e3 * system.units.length * np.mean(points, axis=0)
    return f" at x = {x:.2f}, y = {y:.2f}, z = {z:.2f} mm"
