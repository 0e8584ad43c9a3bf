"""Sentence on the runs, phases and bands in which the simulation is off, and to which side."""

from collections.abc import Sequence

import numpy as np

from diagnose.figures import figure
from diagnose.findings import Findings, LocatedExcess
from diagnose.signals.phases import PHASES
from diagnose.signals.recording import Recording
from diagnose.verdict.names import join_words
from foundation.arrays import Bools

COVERED_EXCESS_SHARE = 0.8  # of the excess: what a sentence has to cover
ONE_SIDED_RATIO = 0.5  # mean over root mean square, beyond which an error has a sign
PHASE_WORDS = {
    "approach": "before the touch", "loading": "while loading", "hold": "in the hold",
    "unloading": "while unloading", "after": "after the press",
}  # fmt: skip
QUANTITY_OF_UNIT = {"V": "voltage", "N": "force", "mm": "displacement"}


def significant_places(findings: Findings) -> list[LocatedExcess]:
    """Places with an excess beyond the level, the largest share first; the strongest one where no place is alone."""
    found = [place for place in findings.places if place.p_value <= findings.detection.level]
    found = found or sorted(findings.places, key=lambda place: -place.score)[:1]
    return sorted(found, key=lambda place: -place.share)


def where_words(recording: Recording, findings: Findings) -> str:
    """Sentence such as: Your simulation of the voltage is too high in the hold, below 2 Hz, in all runs."""
    places = _main_places(significant_places(findings))
    channels = list(dict.fromkeys(place.channel for place in places))
    phases = [phase for phase in PHASES if phase in {place.phase for place in places}]
    quantity = join_words(list(dict.fromkeys(_channel_words(channel) for channel in channels)))
    phase_words = join_words([PHASE_WORDS[phase] for phase in phases]) if len(phases) < len(PHASES) else "throughout"
    parts = [
        f"{_side_words(recording, findings, places)} {phase_words}",
        _band_words(recording, places),
        _run_words(recording, places),
    ]
    return f"Your simulation of the {quantity} is {', '.join(part for part in parts if part)}."


def _main_places(places: Sequence[LocatedExcess]) -> list[LocatedExcess]:
    """First places that together hold COVERED_EXCESS_SHARE of the excess of all of them."""
    shares = np.cumsum([max(place.share, 0.0) for place in places])
    count = int(np.searchsorted(shares, COVERED_EXCESS_SHARE * shares[-1])) + 1 if len(places) else 0
    return list(places[:count])


def _channel_words(channel: str) -> str:
    name = QUANTITY_OF_UNIT.get(channel.rpartition("_")[2], channel)
    number = channel.removeprefix("voltage_").removesuffix("_V")
    return f"{name} of channel {number}" if number.isdigit() else name


def _side_words(recording: Recording, findings: Findings, places: Sequence[LocatedExcess]) -> str:
    """Words for the side, in the direction of the signal: "too high" or "too low" against the recording, else "off"."""
    sides = [_relative_mean_error(recording, findings, place) for place in places]
    weights = np.array([max(place.share, 1e-9) for place in places])
    mean = float(np.average(sides, weights=weights)) if sides else 0.0
    return "too high" if mean > ONE_SIDED_RATIO else "too low" if mean < -ONE_SIDED_RATIO else "off"


def _relative_mean_error(recording: Recording, findings: Findings, place: LocatedExcess) -> float:
    """Mean over root mean square of simulated less recorded, positive where the simulated signal is the larger."""
    run, simulated = recording.run(place.run), findings.baseline[place.run][place.channel]
    inside = _place_mask(recording, place) & run.usable(place.channel)
    error = (simulated - run.channels[place.channel])[inside]
    size = float(np.sqrt(np.mean(error**2))) if len(error) else 0.0
    sign = np.sign(simulated[np.argmax(np.abs(simulated))])
    return float(sign * error.mean() / size) if size else 0.0


def _place_mask(recording: Recording, place: LocatedExcess) -> Bools:
    """Flags (t,) of the place's phase and press; of every press where the place has none of its own."""
    number = [run.label for run in recording.runs].index(place.run)
    found = recording.phases[number]
    inside = found.phase == PHASES.index(place.phase)
    if 0 <= place.press < len(found.presses):
        inside &= found.press == place.press
    return np.asarray(inside)


def _band_words(recording: Recording, places: Sequence[LocatedExcess]) -> str:
    """Words for a band, below, above or between frequencies; "" where all bands are meant."""
    low = min(place.band_Hz[0] for place in places)
    high = max(max(place.band_Hz[1], 0.5 / _phase_duration_s(recording, place)) for place in places)
    fastest = min(0.5 / recording.run(place.run).step_s for place in places)
    slowest = min(1.0 / float(np.ptp(recording.run(place.run).time_s)) for place in places)
    from_bottom, to_top = low <= 2.0 * slowest, high >= 0.9 * fastest
    if from_bottom and to_top:
        return ""
    if from_bottom:
        return f"below {figure(high)} Hz"
    return f"above {figure(low)} Hz" if to_top else f"between {figure(low)} and {figure(high)} Hz"


def _phase_duration_s(recording: Recording, place: LocatedExcess) -> float:
    """Duration in s of the place's phase: half a turn in it is the slowest change that it shows."""
    run = recording.run(place.run)
    return float(np.count_nonzero(_place_mask(recording, place)) * run.step_s) or run.step_s


def _run_words(recording: Recording, places: Sequence[LocatedExcess]) -> str:
    hit = [run.label for run in recording.runs if run.label in {place.run for place in places}]
    if len(hit) == len(recording.runs):
        return "in all runs" if len(hit) > 1 else ""
    if len(hit) <= 2:
        return "in " + join_words([f"“{label}”" for label in hit])
    return f"in {len(hit)} of {len(recording.runs)} runs"
