"""What shared layers, islands, grooves and a grid are worth: the same segments, joined in other ways, pressed alike."""

from dataclasses import dataclass

import numpy as np

from foundation.errors import InputError
from geometry.array.checks import check_array
from geometry.array.layout import ArrayLayout, array_layout
from geometry.array.parameters import Array, Groove
from geometry.parameters import LayerName
from softdot.arrays.case import ArrayCase
from softdot.arrays.presses import ArrayPresses
from softdot.arrays.roles import middle
from softdot.prepared_press import PreparedPress

GROOVE_WIDTH, GROOVE_DEPTH = 0.1, 0.75
"""Of the pitch, and of the thickness of medium 2."""
MEDIA: tuple[LayerName, ...] = ("film", "medium1", "medium2")


@dataclass(frozen=True)
class Worth:
    """One way of joining, with one segment pressed. largest_crosstalk_percent : of the voltage of the pressed one.

    why_not : why these segments cannot be joined so; the numbers are then None.
    """

    name: str
    segment: str
    force_N: float | None
    charge_pC: float | None
    voltage_V: float | None
    largest_crosstalk_percent: float | None
    why_not: str | None = None


def ways(layout: ArrayLayout) -> dict[str, Array]:
    """Name -> the array joined in that way, the stated one first."""
    array, effector, medium2 = layout.array, layout.segment.effector, layout.segment.medium2
    groove = Groove(
        layer="medium2",
        width_mm=round(GROOVE_WIDTH * layout.pitch_mm, 6),
        depth_mm=round(GROOVE_DEPTH * medium2.thickness_mm, 6),
    )
    bare = array.model_copy(update={"grooves": (), "grid_layers": ()})
    found = {"as stated": array}
    if effector is not None and effector.shape == "layer":
        found["all layers run through"] = bare.model_copy(update={"shared": ("effector", *MEDIA)})
    found["film and media run through"] = bare.model_copy(update={"shared": MEDIA})
    found["film and media run through, medium 2 with grooves"] = bare.model_copy(
        update={"shared": MEDIA, "grooves": (groove,)}
    )
    found["film and medium 2 run through"] = bare.model_copy(update={"shared": ("film", "medium2")})
    found["only the film runs through"] = bare.model_copy(update={"shared": ("film",)})
    found["nothing runs through"] = bare.model_copy(update={"shared": ()})
    held: tuple[LayerName, ...] = ("medium1", "film")
    if effector is not None and effector.shape == "layer":
        held = ("effector", *held)
    found["a grid holds all but medium 2"] = bare.model_copy(
        update={"shared": ("film", "medium2"), "grid_layers": held}
    )
    return found


def variant_presses(case: ArrayCase) -> tuple[dict[str, PreparedPress], dict[str, str]]:
    """Press of the segment nearest to the middle for each way of joining, by its name, or why there is none."""
    presses, why_not = {}, {}
    for name, array in ways(case.layout).items():
        other = ArrayCase(case.config.model_copy(update={"array": array}))
        try:
            check_array(array_layout(array, case.config.segment, case.config.dot))
        except InputError as error:
            why_not[name] = str(error)
        else:
            presses[name] = other.press_over(middle(case.layout))
    return presses, why_not


def worth(case: ArrayCase, solve: ArrayPresses) -> list[Worth]:
    """Worth of each way of joining, with the segment nearest to the middle pressed. StoppedPressError."""
    presses, why_not = variant_presses(case)
    solved, place, found = solve(presses), middle(case.layout), []
    number = case.layout.places.index(place)
    for name in ways(case.layout):
        if name in why_not:
            found.append(Worth(name, place.label, None, None, None, None, why_not[name]))
            continue
        press = solved[name]
        others = np.abs(np.delete(press.signal_V[-1], number))
        share = 100.0 * float(others.max(initial=0.0)) / abs(float(press.signal_V[-1, number]))
        force_N, charge_pC = float(press.force_N[-1]), float(press.charge_pC[-1, number])
        found.append(Worth(name, place.label, force_N, charge_pC, float(press.voltage_V[-1, number]), share))
    return found
