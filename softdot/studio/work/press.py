"""The press of a design, coarse at once and accurate after that, with how far each can be trusted."""

import math
import pickle
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from export.solid_view import press_view
from foundation.errors import InputError
from foundation.worker_process import Tell
from mesh.types import MeshingError
from softdot.case import Case
from softdot.json_files import plain
from softdot.prepared_press import PreparedPress
from softdot.pressed import Pressed
from softdot.studio.design_facts import ANSWER
from softdot.studio.estimate import QUANTITIES
from softdot.studio.work.design import case_of, config_of, pressed_part
from softdot.studio.work.remedies import late_remedies
from softdot.summary import mesh_part, press_part
from softdot.tolerances.questions import coarser_press, path_matters, with_larger_elements
from softdot.tolerances.tolerances import PERMITTIVITY_ROW
from solve.result import PressResult, Step

COARSE = 3.0
"""Elements of the coarse press against those of the design: a few thousand unknowns."""


def coarse_press(text: str, tell: Tell) -> dict[str, Any]:
    """The press on large elements, extruded where the shape allows it: meshed in no time, some percent off.

    In few load steps where the path does not matter, so that full load is the same.
    """
    config = pressed_part(case_of(text)).config
    larger = (with_larger_elements if path_matters(config) else coarser_press)(config, COARSE)
    try:
        layered = Case(larger.model_copy(update={"mesh": larger.mesh.model_copy(update={"mesher": "layered"})}))
        return _pressed(layered, TaskProgress(tell), "coarse")
    except (InputError, MeshingError):
        return _pressed(Case(larger), TaskProgress(tell), "coarse")


def accurate_press(text: str, tell: Tell) -> dict[str, Any]:
    """The press of `softdot run`, told as soon as it is there; then returned with its error bars."""
    case, progress = pressed_part(case_of(text)), TaskProgress(tell)
    found = _pressed(case, progress, "accurate")
    if found["numbers"]["solver"]["converged"]:
        tell({"press": found})
        progress.stage("error bars")
        errors = with_charge(case.uncertainty(found["numbers"]))
        return {**found, "view": None, "numbers": {**found["numbers"], **plain(errors)}}
    return found


def full_load(text: str, tell: Tell) -> dict[str, Any]:
    """Force, charge and voltage of the accurate press at full load, with its warnings. InputError where it is not
    reached.
    """
    case = pressed_part(case_of(text))
    _ = case.checked_design
    pressed = _pressed_with_progress(case, TaskProgress(tell))
    numbers = press_part(case.model, pressed.result, pressed.course)
    if not numbers["solver"]["converged"]:
        raise InputError(f"not converged, {numbers['solver']['failure']}")
    answer = {name: numbers[key][-1] for name, key in zip(QUANTITIES, ANSWER, strict=True)}
    return dict(plain({**answer, "warnings": pressed.doubts}))


def with_charge(errors: Mapping[str, Any]) -> dict[str, Any]:
    """The uncertainty of a press with that of its charge, charge_percent, where the voltage has one.

    At open circuit V = Q / C, and C = eps A / t of the undeformed film: each part moves charge and voltage by the same
    share, but for the permittivity, which moves the voltage alone.
    """
    whole, mesh = errors.get("uncertainty", {}), errors.get("discretisation_error", {})
    if "voltage_percent" not in whole:
        return dict(errors)
    shares = [one["voltage_percent"] for one in whole["parts"] if not one["name"].startswith(PERMITTIVITY_ROW)]
    added = {"uncertainty": {**whole, "charge_percent": math.hypot(*shares)}}
    return {**errors, **added, "discretisation_error": {**mesh, "charge_percent": mesh["voltage_percent"]}}


def press_of_cell(text: str, tell: Tell) -> dict[str, Any]:
    """The press of an array by the cell of its dots, on large elements: what each segment reads. InputError."""
    case, progress = Case(with_larger_elements(config_of(text), COARSE)), TaskProgress(tell)
    _ = case.warnings
    press = case.by_cell()
    pressed = _pressed_with_progress(press, progress)
    numbers = {
        "cell": case.config.dot.cell,
        "depth_mm": pressed.indentation_mm[-1],
        "force_N": pressed.reaction_force_N[-1],
        "charge_pC": [charge[-1] for charge in pressed.charges_pC.values()],
        "voltage_V": [voltage[-1] for voltage in pressed.signals_V.values()],
        "amplified": press.is_amplified,
        "warnings": without_mesh(pressed.doubts),
        "failure": pressed.failure,
    }
    return {"array": plain(numbers), "view": _view(pressed)}


def _pressed_with_progress(press: PreparedPress, progress: "TaskProgress") -> Pressed:
    progress.stage("mesh")
    _ = press.solved_mesh
    progress.stage("press")
    return press.press(progress.on_step)


def _view(pressed: Pressed) -> dict[str, Any] | None:
    """For the page; None where no step converged."""
    result = pressed.result
    return press_view(result.tet_mesh, result, pressed.case.dot) if len(result.steps) > 1 else None


def _pressed(case: Case, progress: "TaskProgress", quality: str) -> dict[str, Any]:
    _ = case.checked_design
    pressed = _pressed_with_progress(case, progress)
    result = pressed.result
    numbers = {"mesh": mesh_part(case.mesh_quality, result.unknowns), **press_part(case.model, result, pressed.course)}
    doubts = without_mesh(pressed.doubts) if quality == "coarse" else pressed.doubts
    numbers |= {"warnings": doubts, "remedies": late_remedies(case.config, doubts)}
    return {
        "quality": quality,
        "numbers": plain(numbers),
        "view": _view(pressed),
        "history": pickle.dumps(without_fields(result)),
    }


def without_mesh(doubts: Sequence[str]) -> list[str]:
    """Warnings of a press on larger elements without those about its elements, which are not the design's."""
    return [one for one in doubts if "mesh." not in one]


def without_fields(result: PressResult) -> PressResult:
    """What a circuit needs of a press: its charges and times, a few kilobytes."""
    bare = tuple(replace(step, fields=None) for step in result.steps)  # type: ignore[arg-type]
    return replace(result, steps=bare, tet_mesh=None)  # type: ignore[arg-type]


class TaskProgress:
    """Tells the page the stage, how far it is, and the time that is left."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._name, self._start = tell, "", time.monotonic()
        self._known: list[str] = []

    def stage(self, name: str) -> None:
        """A stage begins."""
        self._name, self._start = name, time.monotonic()
        self._tell({"progress": {"stage": name, "done": 0, "count": 0, "left_s": None}})

    def step(self, number: int, count: int, text: str) -> None:
        """A step of it is done."""
        spent = time.monotonic() - self._start
        left = spent * (count - number) / number if number else None
        told = {"stage": self._name, "done": number, "count": count, "left_s": left, "text": text}
        told |= {"known": self._known} if self._known else {}
        self._tell({"progress": told})

    def note(self, text: str) -> None:
        """What is already known is told with every step that follows."""
        self._known = [*self._known, text]

    def on_step(self, step: Step, number: int, count: int) -> None:
        """A load step has converged."""
        self.step(number, count, f"{1e3 * step.indentation_m:.3f} mm, {step.reaction_force_N:.3g} N")


def circuit(text: str, history: bytes) -> dict[str, Any] | None:
    """What the amplifier of a design makes of a charge that was solved before: voltage at the steps, and over time.

    history : as a press gave it. None where the design has no amplifier.
    """
    along = case_of(text).course(pickle.loads(history))
    if along.together_V is None:
        return None
    told: Mapping[str, Any] = {
        "readout_voltage_V": along.together_V[along.solved], "time_s": along.time_s, "voltage_V": along.together_V,
    }  # fmt: skip
    return dict(plain(told))


def warm_up() -> None:
    """A press of a few elements with all that the page is told of one, which loads kernels, solver and libraries."""
    tiny = {"mesher": "layered", "element_size_mm": 1.0, "contact_element_size_mm": 0.5}
    _pressed(Case(mesh=tiny, press={"load_steps": 1}), TaskProgress(lambda _: None), "coarse")
