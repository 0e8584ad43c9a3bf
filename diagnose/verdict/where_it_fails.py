"""In which runs, phases and bands the simulation is off, and to which side, in one sentence."""

from collections.abc import Sequence

import numpy as np

from diagnose.figures import figure
from diagnose.findings import Findings, LocatedExcess
from diagnose.signals.phases import PHASES
from diagnose.signals.recording import Recording
from diagnose.verdict.names import listed
from foundation.arrays import Bools

MOST = 0.8  # of the excess: what a sentence has to cover
ONE_SIDED = 0.5  # mean over root mean square, beyond which an error has a sign
IN_WORDS = {
    "approach": "before the touch", "loading": "while loading", "hold": "in the hold",
    "unloading": "while unloading", "after": "after the press",
}  # fmt: skip
QUANTITIES = {"V": "voltage", "N": "force", "mm": "displacement"}


def significant(findings: Findings) -> list[LocatedExcess]:
    """Places where the excess is beyond the level, the largest share first; the strongest where none is alone."""
    found = [place for place in findings.places if place.p_value <= findings.detection.level]
    found = found or sorted(findings.places, key=lambda place: -place.score)[:1]
    return sorted(found, key=lambda place: -place.share)


def where_words(recording: Recording, findings: Findings) -> str:
    """Your simulation of the voltage is too high in the hold, below 2 Hz, in all runs."""
    places = _most(significant(findings))
    channels = list(dict.fromkeys(place.channel for place in places))
    phases = [phase for phase in PHASES if phase in {place.phase for place in places}]
    quantity = listed(list(dict.fromkeys(_quantity(channel) for channel in channels)))
    phase_words = listed([IN_WORDS[phase] for phase in phases]) if len(phases) < len(PHASES) else "throughout"
    parts = [f"{_side(recording, findings, places)} {phase_words}", _band(recording, places), _runs(recording, places)]
    return f"Your simulation of the {quantity} is {', '.join(part for part in parts if part)}."


def _most(places: Sequence[LocatedExcess]) -> list[LocatedExcess]:
    """The first places that together hold MOST of the excess of all of them."""
    shares = np.cumsum([max(place.share, 0.0) for place in places])
    count = int(np.searchsorted(shares, MOST * shares[-1])) + 1 if len(places) else 0
    return list(places[:count])


def _quantity(channel: str) -> str:
    name = QUANTITIES.get(channel.rpartition("_")[2], channel)
    number = channel.removeprefix("voltage_").removesuffix("_V")
    return f"{name} of channel {number}" if number.isdigit() else name


def _side(recording: Recording, findings: Findings, places: Sequence[LocatedExcess]) -> str:
    """Too high or too low against the recording, in the direction in which the signal goes; else off."""
    sides = [_excess(recording, findings, place) for place in places]
    weights = np.array([max(place.share, 1e-9) for place in places])
    mean = float(np.average(sides, weights=weights)) if sides else 0.0
    return "too high" if mean > ONE_SIDED else "too low" if mean < -ONE_SIDED else "off"


def _excess(recording: Recording, findings: Findings, place: LocatedExcess) -> float:
    """Mean over root mean square of simulated less recorded, positive where the simulated signal is the larger."""
    run, simulated = recording.run(place.run), findings.baseline[place.run][place.channel]
    inside = _inside(recording, place) & run.usable(place.channel)
    error = (simulated - run.channels[place.channel])[inside]
    size = float(np.sqrt(np.mean(error**2))) if len(error) else 0.0
    sign = np.sign(simulated[np.argmax(np.abs(simulated))])
    return float(sign * error.mean() / size) if size else 0.0


def _inside(recording: Recording, place: LocatedExcess) -> Bools:
    """Samples (t,) of the place's phase and press; every press where the place has none of its own."""
    number = [run.label for run in recording.runs].index(place.run)
    found = recording.phases[number]
    inside = found.phase == PHASES.index(place.phase)
    if 0 <= place.press < len(found.presses):
        inside &= found.press == place.press
    return np.asarray(inside)


def _band(recording: Recording, places: Sequence[LocatedExcess]) -> str:
    """Below, above or between frequencies; nothing where all bands are meant."""
    low = min(place.band_Hz[0] for place in places)
    high = max(max(place.band_Hz[1], 0.5 / _lasts_s(recording, place)) for place in places)
    fastest = min(0.5 / recording.run(place.run).step_s for place in places)
    slowest = min(1.0 / float(np.ptp(recording.run(place.run).time_s)) for place in places)
    from_bottom, to_top = low <= 2.0 * slowest, high >= 0.9 * fastest
    if from_bottom and to_top:
        return ""
    if from_bottom:
        return f"below {figure(high)} Hz"
    return f"above {figure(low)} Hz" if to_top else f"between {figure(low)} and {figure(high)} Hz"


def _lasts_s(recording: Recording, place: LocatedExcess) -> float:
    """How long its phase lasts: half a turn in it is the slowest change that it shows."""
    run = recording.run(place.run)
    return float(np.count_nonzero(_inside(recording, place)) * run.step_s) or run.step_s


def _runs(recording: Recording, places: Sequence[LocatedExcess]) -> str:
    hit = [run.label for run in recording.runs if run.label in {place.run for place in places}]
    if len(hit) == len(recording.runs):
        return "in all runs" if len(hit) > 1 else ""
    if len(hit) <= 2:
        return "in " + listed([f"“{label}”" for label in hit])
    return f"in {len(hit)} of {len(recording.runs)} runs"
