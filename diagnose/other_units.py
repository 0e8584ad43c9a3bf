"""Channels whose values look as if they were recorded in another unit."""

import numpy as np

from diagnose.figures import figure
from diagnose.forward import Engine
from diagnose.signals.recording import Recording

THOUSAND = 1000.0
MEANT = {"V": "millivolts", "N": "millinewtons", "mm": "micrometres"}
KILO = {"N": "kilonewtons"}
"""A voltage may be a thousandth of what is expected, behind a leak; a force can not."""


def other_units(recording: Recording, engine: Engine) -> list[str]:
    """One sentence for each channel of a run whose size fits the model better after division by a thousand, or a force
    after multiplication with it.

    Both are compared by their largest absolute values; on a logarithmic scale a thousandth is nearer to the model where
    the ratio is above the root of a thousand. Physics that a model lacks takes signal away or adds a part of it.
    """
    said = []
    for number, run in enumerate(recording.runs):
        simulated = engine.predict(number, ())
        for channel in run.answers:
            used = run.usable(channel)
            recorded = float(np.abs(run.channels[channel][used]).max(initial=0.0))
            expected = float(np.abs(simulated[channel][used]).max(initial=0.0))
            meant = KILO if recorded < expected else MEANT
            apart = max(recorded, expected) > np.sqrt(THOUSAND) * min(recorded, expected)
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
