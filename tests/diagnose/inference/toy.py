"""A sensor of springs, branches and one RC amplifier that is solved in a millisecond, for tests of the inference.

Force: two relaxing springs in parallel, F = R1(k1 u) + R2(k2 u^3). Charge: Q = a u^2 + b u + c (part that relaxes).
Voltage: a film and its input, (C + Cin) V' = Q' - V / R, then a low-pass.
"""

from copy import copy
from dataclasses import dataclass, field

import numpy as np
from scipy.signal import lfilter

from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording, Run

TAUS = (0.05, 0.5, 5.0)
LEAK_S = 20.0  # time constant of the input


def press(time, touch, rise, hold, depth, clear=-0.1):
    """A trapezoid from clear of the sensor."""
    reach = rise * -clear / depth
    corners = [touch - reach, touch + rise, touch + rise + hold, touch + 2 * rise + hold + reach]
    return np.interp(time, corners, [clear, depth, depth, clear])


def drives(duration=6.0, rate=1000.0):
    """Six presses that differ in speed, depth and hold."""
    time = np.arange(int(duration * rate)) / rate
    kinds = [(0.05, 1.5, 0.3), (0.3, 1.0, 0.3), (1.0, 0.3, 0.3), (0.1, 2.0, 0.2), (0.1, 1.5, 0.4), (0.02, 0.2, 0.35)]
    return time, [press(time, 1.0, rise, hold, depth) for rise, hold, depth in kinds]


def relaxed(time, values, moduli, taus):
    """The stress of a Prony solid: values less what its branches have forgotten, exact for straight lines."""
    step = time[1] - time[0]
    change = np.diff(values, prepend=values[0])
    total = values * (1.0 - sum(moduli))
    for modulus, tau in zip(moduli, taus, strict=True):
        decay = np.exp(-step / tau)
        total = total + modulus * lfilter([-np.expm1(-step / tau) * tau / step], [1.0, -decay], change)
    return total


@dataclass
class Sensor:
    """All physics of the toy, off by default. mixed : moduli of the branches of both springs."""

    branches1: tuple = (0.0, 0.0, 0.0)
    branches2: tuple = (0.0, 0.0, 0.0)
    taus: tuple = TAUS
    leak: float = 0.0  # conductance over that of the input's 20 s, times 20
    capacitance: float = 0.0  # over that of the film
    low_pass_s: float = 0.0
    stiffening: float = 0.0
    gap_mm: float = 0.0
    compliance: float = 0.0
    modulus1: float = 0.0
    modulus2: float = 0.0
    d31: float = 0.0
    pyro: float = 0.0
    friction: float = 0.0
    touch_charge: float = 0.0
    inverse_limit: float = 0.0  # 1/V
    # Other forms of the same physics, which the engine does not have:
    stiffening_power: float = 3.0
    pyro_s: float = 1.0
    slip_mm_per_s: float = 0.02
    low_pass_order: int = 1
    rounding_mm: float = 0.0  # of the touch
    step_charge: float = 0.0  # a jump at half depth: nothing that is in any list

    def answers(self, time, drive):
        u = np.maximum(drive - self.gap_mm, 0.0)
        if self.rounding_mm:
            u = u - self.rounding_mm * -np.expm1(-u / self.rounding_mm)
        u = u - self.compliance * (2.0 * u + 8.0 * u**3)
        u = np.maximum(u, 0.0)
        spring1 = 2.0 * (1.0 + self.modulus1) * (u + self.stiffening * u * (u / 0.3) ** (self.stiffening_power - 1.0))
        spring2 = 20.0 * (1.0 + self.modulus2) * u**3
        part1 = relaxed(time, spring1, self.branches1, self.taus)
        part2 = relaxed(time, spring2, self.branches2, self.taus)
        rate = np.gradient(u, time)
        force = (part1 + part2) * (1.0 + self.friction * np.tanh(rate / self.slip_mm_per_s))
        charge = 3.0 * u**2 + 1.2 * part1 + 0.3 * part2
        charge = charge * (1.0 + self.d31)
        since = np.maximum(time - time[np.argmax(u > 0)], 0.0)
        charge = charge + self.pyro * (1.0 - np.exp(-since / self.pyro_s)) + self.touch_charge * np.sqrt(u / 0.3)
        charge = charge + self.step_charge * (u > 0.5 * u.max())
        step, total = time[1] - time[0], 1.0 + self.capacitance
        tau = LEAK_S * total / (1.0 + 20.0 * self.leak)
        decay = np.exp(-step / tau)
        change = np.diff(charge, prepend=charge[0]) / total
        voltage = lfilter([-np.expm1(-step / tau) * tau / step], [1.0, -decay], change)
        if self.inverse_limit > 0.0:
            voltage = np.clip(voltage, -1.0 / self.inverse_limit, 1.0 / self.inverse_limit)
        if self.low_pass_s > 0.0:
            share = -np.expm1(-step / self.low_pass_s)
            for _ in range(self.low_pass_order):
                voltage = lfilter([share], [1.0, share - 1.0], voltage)
        return {"force_N": force, "voltage_V": voltage}


def one(mechanism, component, name, low, high, *starts):
    """A candidate with one coordinate, a field of the sensor."""
    coordinate = Coordinate(name, low, high, starts)
    return Candidate(mechanism, component, (coordinate,), lambda v: {name: v[0]}, units={name: "1"})


def prony(component, name):
    """Three branches with times that are set."""
    coordinates = tuple(Coordinate(f"{name}_{n}", 0.0, 0.9, (0.1,)) for n in range(3))

    def derived(v):
        between = [np.exp(-0.1 / tau) - np.exp(-10.0 / tau) for tau in TAUS]
        return {"relaxed_fraction": float(np.dot(v, between))}

    return Candidate("viscoelasticity", component, coordinates,
                     lambda v: {"relative_moduli": list(v), "relaxation_times_s": list(TAUS)}, derived)  # fmt: skip


CANDIDATES = (
    one("charge-leakage", "readout", "leak", 0.0, 20.0, 0.5),
    one("parasitic-capacitance", "readout", "capacitance", 0.0, 20.0, 0.3),
    one("low-pass", "readout", "low_pass_s", 0.0, 0.3, 0.01),
    prony("medium1", "branches1"),
    prony("medium2", "branches2"),
    one("hyperelastic-stiffening", "medium1", "stiffening", 0.0, 5.0, 0.2),
    one("contact-gap", "dot", "gap_mm", 0.0, 0.15, 0.02),
    one("rig-compliance", "rig", "compliance", 0.0, 0.2, 0.03),
    one("property-error", "medium1", "modulus1", -0.7, 2.0, 0.2),
    one("property-error", "medium2", "modulus2", -0.7, 2.0, 0.2),
    one("property-error", "film", "d31", -0.7, 2.0, 0.2),
    one("pyroelectric-drift", "film", "pyro", -2.0, 2.0, 0.1),
    one("friction", "dot", "friction", 0.0, 0.5, 0.05),
    one("contact-electrification", "film", "touch_charge", -2.0, 2.0, 0.1),
)


@dataclass
class ToyEngine:
    """The sensor as an engine; accuracy as that of a coarse 3D model."""

    recording: Recording
    candidates: tuple = CANDIDATES
    accuracy: dict = field(default_factory=lambda: {"force_N": 0.01, "voltage_V": 0.01})
    shortfalls: tuple[str, ...] = ()
    name: str = "toy"
    free_nuisances: tuple = ()

    def nuisance(self, name):
        fields = {"modulus.medium1": "modulus1", "modulus.medium2": "modulus2", "d31": "d31", "offset_mm": "gap_mm"}
        if name not in fields:
            return None
        return one("property-error", name, fields[name], -0.9, 3.0, 0.05)

    def with_candidates(self, candidates):
        fewer = copy(self)
        fewer.candidates = candidates
        return fewer

    def prepare(self, candidates, report):
        pass

    prepare_roughly = prepare

    def refine(self, _settings, _report):
        return ()

    def predict(self, run, settings):
        sensor = sensor_of(settings)
        its = self.recording.runs[run]
        found = sensor.answers(its.time_s, its.drive_values)
        return {name: found[name] for name in its.answers}

    def imagine(self, run, settings):
        return sensor_of(settings).answers(run.time_s, run.drive_values)


def sensor_of(settings):
    """Settings add up."""
    total = {}
    for setting in settings:
        for coordinate, value in zip(setting.candidate.coordinates, setting.values, strict=True):
            total[coordinate.name] = total.get(coordinate.name, 0.0) + value
    for name in ("branches1", "branches2"):
        own = tuple(total.pop(f"{name}_{n}", 0.0) for n in range(3))
        total[name] = own
    return Sensor(**total)


NUISANCE = {"gain": 0.03, "offset_V": 0.01, "lag_s": 0.002, "modulus.medium1": 0.05, "modulus.medium2": 0.05}


def coloured(rng, count, sigma, memory=0.5):
    """Noise with an autoregression of order one, sigma of one sample."""
    white = rng.standard_normal(count + 100) * sigma * np.sqrt(1.0 - memory**2)
    return lfilter([1.0], [1.0, -memory], white)[100:]


def recording(sensor, rng, noise=(0.005, 0.005), nuisance=None, scatter=1.0, time=None, courses=None, distort=0.0):
    """What a laboratory would record of a sensor that is not the engine's. noise : of force and voltage.

    distort : one sigma of a smooth error of its own numerics.
    """
    nuisance = NUISANCE if nuisance is None else nuisance
    if time is None:
        time, courses = drives()
    shared = {n: scatter * rng.normal(0.0, s) for n, s in nuisance.items() if n.startswith("modulus")}
    sensor.modulus1 += shared.get("modulus.medium1", 0.0)
    sensor.modulus2 += shared.get("modulus.medium2", 0.0)
    bend = distort * rng.standard_normal((2, 3))
    runs = []
    for number, drive in enumerate(courses):
        own = {n: scatter * rng.normal(0.0, s) for n, s in nuisance.items() if not n.startswith("modulus")}
        found = sensor.answers(time, drive)
        deep = np.clip(drive / 0.4, 0.0, 1.0)
        bent = 1.0 + bend @ np.array([np.ones(len(time)), deep - 0.5, (2 * deep - 1) ** 2 - 0.5])
        force = found["force_N"] * bent[0] + coloured(rng, len(time), noise[0])
        late = np.interp(time - own.get("lag_s", 0.0), time, found["voltage_V"] * bent[1])
        voltage = (1.0 + own.get("gain", 0.0)) * late + own.get("offset_V", 0.0) + coloured(rng, len(time), noise[1])
        channels = {"displacement_mm": drive, "force_N": force, "voltage_V": voltage}
        there = np.ones(len(time), dtype=bool)
        valid, limited = dict.fromkeys(channels, there), dict.fromkeys(channels, ~there)
        runs.append(Run(f"run {number}", f"{number}.csv", time, "displacement_mm", channels, valid, limited,
                        nuisance=nuisance))  # fmt: skip
    return Recording(tuple(runs))


LOGS = np.logspace(-2.5, 1.5, 13)


def stretched(total, power=0.5, tau=0.5):
    """Moduli of many branches that make a stretched exponential, which no three branches are."""
    edges = np.concatenate([[0.0], np.sqrt(LOGS[1:] * LOGS[:-1]), [1e9]])
    return tuple(total * np.diff(1.0 - np.exp(-((edges / tau) ** power))))


NONE = (0.0,) * len(LOGS)
CONCEALED = {
    ("charge-leakage", "readout"): {"leak": 1.0},
    ("parasitic-capacitance", "readout"): {"capacitance": 0.5},
    ("low-pass", "readout"): {"low_pass_s": 0.03, "low_pass_order": 2},
    ("viscoelasticity", "medium1"): {"branches1": stretched(0.4), "branches2": NONE, "taus": tuple(LOGS)},
    ("viscoelasticity", "medium2"): {"branches2": stretched(0.4), "branches1": NONE, "taus": tuple(LOGS)},
    ("hyperelastic-stiffening", "medium1"): {"stiffening": 0.5, "stiffening_power": 3.5},
    ("contact-gap", "dot"): {"gap_mm": 0.03},
    ("rig-compliance", "rig"): {"compliance": 0.08},
    ("property-error", "medium1"): {"modulus1": 0.6},
    ("property-error", "medium2"): {"modulus2": 0.6},
    ("property-error", "film"): {"d31": 0.4},
    ("pyroelectric-drift", "film"): {"pyro": 0.3, "pyro_s": 1.5},
    ("friction", "dot"): {"friction": 0.15, "slip_mm_per_s": 0.04},
    ("contact-electrification", "film"): {"touch_charge": 0.2},
}
"""What is concealed in recordings, most of it by another law than the engine's."""


def concealed(name):
    """A sensor with one mechanism, of a size well above the noise."""
    return Sensor(**CONCEALED[name])


def silent(*_):
    """Reports to nobody."""


def small(seed, sensor=None, runs=6, rate=100.0, duration=6.0, noise=0.005, **more):
    """A recording that is quick to diagnose; its numerics are half a per cent off."""
    time, courses = drives(duration, rate)
    rng = np.random.default_rng(seed)
    given = {"distort": 0.005, "noise": (noise, noise), **more}
    return recording(sensor or Sensor(), rng, time=time, courses=courses[:runs], **given)
