"""By which powers of its numbers force, charge and voltage of a press grow, from its derivatives on its own mesh."""

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from foundation.errors import InputError
from foundation.worker_process import Tell
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.differentiation import variations_of
from softdot.prepared_press import PreparedPress
from softdot.studio.estimate import WITHOUT_EFFECT, dotted
from softdot.studio.work.design import case_of, pressed_part
from softdot.tolerances.questions import MOST_LOAD_STEPS, path_matters
from solve.solution.full_load import FullLoad
from solve.solution.linear import LinearSolveError

UNLIKELY = ("density", "pyroelectric", "yield_stress", "load_steps", "confidence")
"""Parts of keys that change no quasi-static press below its yield stress."""
FIRST = ("press.indentation_mm", "press.force_N", "thickness", "height", "length", "width", "modulus")
"""Parts of keys that a hand moves first."""


def exponents(text: str, wanted: Sequence[str], tell: Tell) -> dict[str, Any]:
    """Dotted key -> d ln(force, charge, voltage) / d ln(number) at full load, told of as they come.

    wanted : keys that are to come first. InputError where the path of the press matters, or an answer is zero.
    """
    config = pressed_part(case_of(text)).config
    steps = min(config.press.load_steps, MOST_LOAD_STEPS)
    config = config.model_copy(update={"press": config.press.model_copy(update={"load_steps": steps})})
    if path_matters(config) or config.array is not None:
        raise InputError("the answer of this press depends on its path and is not estimated")
    full = FullLoad(model_of(config), PreparedPress(config).solved_mesh)
    force, voltage = full.answer.force, full.answer.voltage
    if force <= 0.0 or voltage == 0.0:
        raise InputError("this press gives no force or no voltage")
    found: dict[str, Any] = {}
    for key, value in _keys(config, wanted).items():
        with suppress(InputError, ValueError, LinearSolveError):
            by_key = full.derivatives(variations_of(config, [key]))[key]
            of_voltage = by_key.voltage * value / voltage
            of_charge = of_voltage + _of_capacitance(config, key)
            found[key] = (by_key.force * value / force, of_charge, of_voltage)
            tell({"exponents": {key: found[key]}})
    return found


def _keys(config: Config, wanted: Sequence[str]) -> dict[str, float]:
    """Numbers above zero on which the press may depend, with their values, the likeliest first."""
    found = {
        key: value
        for key, value in dotted(config.model_dump(mode="json", exclude_none=True)).items()
        if type(value) in (int, float) and value > 0.0 and key.split(".", 1)[0] not in WITHOUT_EFFECT
        and not any(part in key for part in (*UNLIKELY, "electrodes"))
    }  # fmt: skip

    def rank(key: str) -> tuple[bool, int]:
        return key not in wanted, next((i for i, part in enumerate(FIRST) if part in key), len(FIRST))

    return {key: found[key] for key in sorted(found, key=rank)}


def _of_capacitance(config: Config, key: str) -> float:
    """d ln C / d ln(number) of a film between parallel electrodes, C = permittivity area / thickness."""
    if key == "segment.film.thickness_um":
        return -1.0
    if key == f"materials.{config.segment.film.material}.relative_permittivity":
        return 1.0
    is_side = key in ("segment.length_mm", "segment.width_mm")
    return 1.0 if is_side and not config.segment.film.electrodes else 0.0
