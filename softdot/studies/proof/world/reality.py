"""One reality: what was made, and everything between the stage, the film and the recorder."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
from scipy.special import erfc

from softdot.studies.proof.world.amplifier import Amplifier
from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.channels import Wiring, voltages
from softdot.studies.proof.world.details import Details
from softdot.studies.proof.world.made import Made
from softdot.studies.proof.world.march import Course, Table, table
from softdot.studies.proof.world.noise import Autoregression, noises
from softdot.studies.proof.world.remembering_presses import AskedPath, forgetful, scaled_memory
from softdot.studies.proof.world.runs import Run

PYRO_PC_PER_MM2_K = 30.0
Signals = dict[str, Floats]


@dataclass(frozen=True)
class Reality:
    """Everything is off by default but the baseline.

    gap_mm, compliance_mm_per_N, mass_g : between stage and dot. guide_N : friction of the stage's guide, which the
    load cell carries. leak_MOhm : across the film. heat : step (K) and
    time (s) of a half-space that warms. touch_pC : charge left by the touch at the largest area. sensitivity : of the
    film, on all its constants d. fatigue : share of its charge that the film loses from one press to the next.
    drift : relative change of the gain over a minute. jump_s : the clock of the voltage jumps by this in the middle
    of every run. pickup : volt per mm/s. wiring : of several channels. nuisance : name, or (name, number of run), or
    (name, number of run, channel), -> value. details : flaws of the rig, which no mechanism describes.
    """

    made: Made
    amplifier: Amplifier
    gap_mm: float = 0.0
    compliance_mm_per_N: float = 0.0
    mass_g: float = 0.0
    guide_N: float = 0.0
    leak_MOhm: float | None = None
    heat: tuple[float, float] = (0.0, 1.0)
    touch_pC: float = 0.0
    sensitivity: float = 1.0
    fatigue: float = 0.0
    drift: float = 0.0
    jump_s: float = 0.0
    pickup: float = 0.0
    wiring: Wiring = field(default_factory=Wiring)
    nuisance: Mapping[Any, float] = field(default_factory=dict)
    details: Details | None = None

    def of(self, name: str, run: int, channel: int = 0) -> float:
        """A nuisance of a run and, where each has its own, of a channel."""
        known = self.nuisance
        return known.get((name, run, channel), known.get((name, run), known.get(name, 0.0)))


def baseline(bench: Bench) -> Reality:
    """The reality that the experimenter believes in."""
    return Reality(bench.made, bench.amplifier)


def record(reality: Reality, bench: Bench) -> list[Signals]:
    """Signals of every run without noise: time_s, displacement_mm, force_N (when measured), voltage_V."""
    real = replace(reality, made=with_scatter(reality))
    places = {run.place_mm for run in bench.runs}
    of = {place: _mechanics(_at(reality.made, place), _at(real.made, place), bench) for place in places}
    return [_record_run(real, bench, run, number, of[run.place_mm]) for number, run in enumerate(bench.runs)]


def _at(made: Made, place_mm: float) -> Made:
    return replace(made, offset_mm=made.offset_mm + place_mm)


def _mechanics(made: Made, scattered: Made, bench: Bench) -> "Mechanics":
    depth_mm = DEEPER * bench.deepest_mm
    known = table(forgetful(scattered), depth_mm)
    return Mechanics(made, known, table(forgetful(made), depth_mm) if made.remembers else known)


DEEPER = 1.05


@dataclass(frozen=True)
class Mechanics:
    """Tables of a specimen. known : table of what is really there without its memory; nominal : of the same without the
    specimen's scatter.

    made : without scatter, with its memory.
    """

    made: Made
    known: Table
    nominal: Table

    def course(self, path: Floats, asked: Callable[[], AskedPath]) -> Course:
        """Answers to the path of the dot; asked : only where something is remembered."""
        elastic = self.known.at(path)
        if not self.made.remembers:
            return elastic
        way = asked()
        nominal = self.nominal.at(way.path_mm)
        return scaled_memory(self.made, way, elastic, nominal, float(self.nominal.depth_mm[-1]))


def with_scatter(reality: Reality) -> Made:
    """The stack as it was made, with the declared scatter of this specimen in it."""
    made = reality.made
    layers = []
    for layer in made.layers:
        name = getattr(layer, "name", "film")
        modulus = 1.0 + reality.nuisance.get(f"modulus.{name}", 0.0)
        layers.append(replace(layer, modulus_MPa=modulus * layer.modulus_MPa))
    return replace(made, layers=tuple(layers))


def _record_run(reality: Reality, bench: Bench, run: Run, number: int, mechanics: Mechanics) -> Signals:
    """Signals of one run without noise."""
    time = run.times(bench.rate_Hz)
    stage, details = run.depth(time) - reality.of("offset_mm", number), reality.details
    surface = stage if details is None else details.path(time, stage, number)
    course = mechanics.course(
        _path(reality, surface, mechanics.known), partial(_asked_path, reality, bench, number, mechanics.known)
    )
    force = course.force_N if details is None else details.force(stage, course.force_N)
    force = force + 1e-6 * reality.mass_g * run.acceleration_mm_per_s2(time)
    if reality.guide_N > 0.0:  # a loop over all samples
        force = force + reality.guide_N * dahl(stage, BEFORE_SLIP_MM)
    charge = reality.sensitivity * course.charge_pC * ((1.0 - reality.fatigue) ** run.presses_before(time))[:, None]
    films = np.array(reality.made.capacitances_pF)
    other = _warmth(reality, run, time) + reality.touch_pC * _touched_share(course)
    charge = charge + other[:, None] * films / films.sum()
    amplified = voltages(_amplifier(reality, run), reality.wiring, time, charge, tuple(films), 1.7 * number)
    signals = {"time_s": time, "displacement_mm": run.depth(time)}
    if bench.force or run.load_cell:
        signals["force_N"] = (1.0 + reality.of("force_gain", number)) * force + reality.of("offset_N", number)
    for channel, (name, voltage) in enumerate(zip(bench.voltages, amplified.T, strict=True)):
        voltage = voltage + reality.pickup * run.speed_mm_per_s(time)
        voltage = voltage * (1.0 + reality.drift * time / 60.0 * (number + 1))
        voltage = voltage if details is None else details.voltage(time, voltage, bench.peak_V, number)
        late = reality.of("lag_s", number, channel) + np.where(time > 0.5 * time[-1], reality.jump_s, 0.0)
        voltage = np.interp(time - late, time, voltage)
        signals[name] = (1.0 + reality.of("gain", number, channel)) * voltage + reality.of("offset_V", number, channel)
    return signals


def _asked_path(reality: Reality, bench: Bench, number: int, known: Table) -> AskedPath:
    """The path of the dot that a run asks for, after the runs before it at the same place."""
    run = bench.runs[number]
    paths = [
        _path(reality, one.depth(one.times(bench.rate_Hz)), known)
        for one in bench.runs[: number + 1]
        if one.place_mm == run.place_mm
    ]
    before_mm = max((float(path.max()) for path in paths[:-1]), default=0.0)
    return AskedPath(run.times(bench.rate_Hz), paths[-1], before_mm)


def _path(reality: Reality, stage: Floats, known: Table) -> Floats:
    """The dot behind gap and compliance. ValueError for a compliance with memory."""
    path = stage - reality.gap_mm
    if reality.compliance_mm_per_N == 0.0:
        return path
    if reality.made.remembers:
        raise ValueError("a compliant rig with a medium that remembers is not in the proof")
    dense = np.linspace(0.0, known.depth_mm[-1], 2000)
    reached = dense + reality.compliance_mm_per_N * known.at(dense).force_N
    return np.where(path > 0.0, np.interp(path, reached, dense), path)


def _warmth(reality: Reality, run: Run, time: Floats) -> Floats:
    """Pyroelectric charge of a half-space that warms from the first touch on: erfc of the root of time."""
    step, constant = reality.heat
    since = np.clip(time - run.lead_s, 1e-9, None)
    warm = np.where(time > run.lead_s, erfc(np.sqrt(constant / since)), 0.0)
    return np.asarray(PYRO_PC_PER_MM2_K * reality.made.length_mm * reality.made.width_mm * step * warm)


BEFORE_SLIP_MM = 0.01


def dahl(path: Floats, travel_mm: float) -> Floats:
    """Friction (t,) along a path (t,) from -1 to 1: after a reversal it turns over a travel, exponentially.

    Dahl, A solid friction model, Aerospace Corporation TOR-0158(3107-18)-1 (1968), of the exponent 1.
    """
    found = np.zeros(len(path))
    for n, step in enumerate(np.diff(path), start=1):
        towards = np.sign(step)
        found[n] = towards + (found[n - 1] - towards) * np.exp(-abs(step) / travel_mm)
    return found


def _touched_share(course: Course) -> Floats:
    """Share (t,) of the largest contact area, to the power 0.8."""
    return np.asarray((course.area_mm2 / max(float(course.area_mm2.max()), 1e-12)) ** 0.8)


def _amplifier(reality: Reality, run: Run) -> Amplifier:
    """Amplifier with the resistor and the capacitor of this run and the leak beside them."""
    have = run.resistance_MOhm if run.resistance_MOhm is not None else reality.amplifier.resistance_MOhm
    capacitance = reality.amplifier.capacitance_pF + run.added_pF
    return replace(reality.amplifier, resistance_MOhm=have, capacitance_pF=capacitance).leaking(reality.leak_MOhm)


PER_RUN = {"gain", "force_gain", "lag_s", "offset_V", "offset_N", "offset_mm"}
PER_CHANNEL = {"gain", "lag_s", "offset_V"}
"""Of these, what each of several channels has for itself."""


def keys(name: str, bench: Bench) -> list[Any]:
    """Keys of the numbers of one nuisance."""
    if name not in PER_RUN:
        return [name]
    runs, count = range(len(bench.runs)), len(bench.voltages)
    if name in PER_CHANNEL and count > 1:
        return [(name, run, channel) for run in runs for channel in range(count)]
    return [(name, run) for run in runs]


def channels(bench: Bench) -> tuple[str, ...]:
    """Answers that this bench records."""
    return ("force_N", *bench.voltages) if bench.force else bench.voltages


def noise_of(bench: Bench) -> Mapping[str, float]:
    """One sigma of each channel."""
    return {"force_N": bench.noise * bench.peak_N, **dict.fromkeys(bench.voltages, bench.noise * bench.peak_V)}


def noise_law(channel: str) -> Autoregression:
    """Noise of a channel: all voltages have the same."""
    return noises()["voltage_V" if channel.startswith("voltage") else channel]
