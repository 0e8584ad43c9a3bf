"""Check for channels whose values look as if they were recorded in another unit."""

import numpy as np

from diagnose.figures import figure
from diagnose.forward import Engine
from diagnose.signals.recording import Recording

UNIT_RATIO = 1000.0
SMALLER_UNITS = {"V": "millivolts", "N": "millinewtons", "mm": "micrometres"}
LARGER_UNITS = {"N": "kilonewtons"}
"""Units a thousand times larger. Not for voltages, which a leak may reduce to a thousandth of what is expected."""


def other_units(recording: Recording, engine: Engine) -> list[str]:
    """Sentences on channels whose size fits the model better in another unit.

    A value is divided by a thousand, or that of a force multiplied with it. Both are compared by their largest absolute
    values; on a logarithmic scale a thousandth is nearer to the model where the ratio is above the root of a thousand.
    Physics that a model lacks takes signal away or adds a part of it.
    """
    said = []
    for number, run in enumerate(recording.runs):
        simulated = engine.predict(number, ())
        for channel in run.answers:
            used = run.usable(channel)
            recorded = float(np.abs(run.channels[channel][used]).max(initial=0.0))
            expected = float(np.abs(simulated[channel][used]).max(initial=0.0))
            meant = LARGER_UNITS if recorded < expected else SMALLER_UNITS
            apart = max(recorded, expected) > np.sqrt(UNIT_RATIO) * min(recorded, expected)
            unit = channel.rpartition("_")[2]
            if min(recorded, expected) > 0.0 and apart and unit in meant:
                said.append(_sentence(run.file, channel, recorded, expected, meant[unit]))
    return said


def _sentence(file: str, channel: str, recorded: float, expected: float, meant: str) -> str:
    unit = channel.rpartition("_")[2]
    return (
        f"recording '{file}', column {channel}: reaches {figure(recorded)} {unit}, {figure(recorded / expected)} times "
        f"the {figure(expected)} {unit} that the model of this rig gives; are these {meant}?"
    )
