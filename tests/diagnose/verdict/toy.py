"""A sensor that one can calculate by hand, a recording of it, and findings about it."""

from copy import copy
from dataclasses import replace

import numpy as np

from diagnose.findings import Detection, Findings, Fit, FittedModel, Interval, LocatedExcess
from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.noise.estimate import noise_models
from diagnose.signals.recording import Recording, Run
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import amplify
from tests.diagnose.rigs import trapezoid

NEWTONS_PER_MM, PICOCOULOMBS_PER_MM, PICOFARADS = 2.0, 50.0, 100.0
RELAXATION_S = 0.3
LEAK = Candidate(
    "charge-leakage",
    "readout",
    (Coordinate("conductance", 0.0, 10.0, (0.1,)),),
    lambda values: {"resistance_MOhm": 1e3 / values[0]},
    units={"resistance_MOhm": "MOhm"},
)
RELAXING = Candidate(
    "viscoelasticity",
    "medium2",
    (Coordinate("relaxed", 0.0, 0.9, (0.2,)),),
    lambda values: {"relative_moduli": [values[0]], "relaxation_times_s": [RELAXATION_S]},
    lambda values: {"relaxed_fraction": values[0]},
    units={"relaxed_fraction": "1"},
)
DEAF = Candidate("friction", "dot", (Coordinate("coefficient", 0.0, 1.0, (0.3,)),), lambda v: {"coefficient": v[0]})
AMPLIFIER = Readout(input_resistance_MOhm=10_000.0)


class ToyEngine:
    """Force and charge in proportion to the depth; the film discharges through the input and a leak beside it.

    A relaxing medium takes its share of the charge with one relaxation time, and of the force too.
    """

    name = "toy"
    candidates = (LEAK, RELAXING)
    free_nuisances = ()

    def __init__(self, recording, full_error=0.0):
        self.recording, self.full_error = recording, full_error
        self.accuracy = {"voltage_V": 0.002, "force_N": 0.002}
        self.shortfalls = ()

    def nuisance(self, name):
        return None

    def with_candidates(self, candidates):
        fewer = copy(self)
        fewer.candidates = candidates
        return fewer

    def prepare(self, candidates, report):
        report("prepared", len(candidates), len(candidates))

    prepare_roughly = prepare

    def refine(self, _settings, _report):
        return ()

    def predict(self, run, settings):
        return self.imagine(self.recording.runs[run], settings)

    def imagine(self, run, settings):
        if run.drive_values.max() > 0.31:
            raise ValueError("deeper than 0.31 mm was not prepared")
        if run.dot_offset_mm != (0.0, 0.0):
            raise ValueError("the dot stands where it was not prepared")
        on = {setting.candidate.mechanism: setting.values[0] for setting in settings}
        depth = np.clip(run.drive_values, 0.0, None)
        share = relaxed(run.time_s, depth, on.get("viscoelasticity", 0.0))
        own = (run.readout or Readout()).input_resistance_MOhm
        siemens = (1.0 / own if own else 0.0) + 1e-3 * on.get("charge-leakage", 0.0)
        readout = Readout(
            input_resistance_MOhm=1.0 / siemens if siemens else None,
            input_capacitance_pF=(run.readout or Readout()).input_capacitance_pF,
        )
        charge = 1e-12 * PICOCOULOMBS_PER_MM * share
        voltage = amplify(run.time_s, charge, 1e-12 * PICOFARADS, readout, Physics())
        answers = {"voltage_V": voltage, "force_N": NEWTONS_PER_MM * share}
        return {name: answers[name] for name in run.answers}

    def solve(self, run, mechanisms, report):
        report("toy press", 1, 1)
        by_name = {candidate.mechanism: candidate for candidate in self.candidates}
        value = {
            "charge-leakage": lambda p: 1e3 / p["resistance_MOhm"],
            "viscoelasticity": lambda p: p["relative_moduli"][0],
        }
        settings = [Setting(by_name[m.name], (value[m.name](m.parameters),)) for m in mechanisms]
        return {name: (1.0 + self.full_error) * v for name, v in self.predict(run, settings).items()}


def relaxed(time_s, values, share):
    """values (t,) less what a Prony term of this share has relaxed."""
    memory, left = 0.0, np.zeros(len(values))
    for n in range(1, len(values)):
        fade = np.exp(-(time_s[n] - time_s[n - 1]) / RELAXATION_S)
        memory = fade * memory + share * np.sqrt(fade) * (values[n] - values[n - 1])
        left[n] = memory
    return (1.0 - share) * values + left if share else values


def toy_run(label="slow", rise_s=0.2, hold_s=0.5, depth=0.3, rows=300, channels=("voltage_V",), readout=AMPLIFIER):
    """A run without samples of its answers."""
    time = np.arange(rows) / 100.0
    drive = trapezoid(time, depth, rise_s=rise_s, hold_s=hold_s)
    names = ("displacement_mm", *channels)
    return Run(
        label=label,
        file=f"{label}.csv",
        time_s=time,
        drive="displacement_mm",
        channels=dict.fromkeys(names, drive),
        valid={name: np.ones(rows, dtype=bool) for name in names},
        saturated={name: np.zeros(rows, dtype=bool) for name in names},
        readout=readout,
        nuisance={"gain": 0.02},
    )


def toy_recording(settings=(), runs=None, noise=1e-3, seed=0):
    """Runs as the toy gives them with these settings, and white noise of 1 mV and 1 mN."""
    runs = runs or (toy_run("slow"), toy_run("quick", rise_s=0.1, hold_s=0.3))
    engine, rng = ToyEngine(Recording(runs)), np.random.default_rng(seed)
    return Recording(tuple(_measured(run, engine.imagine(run, settings), noise, rng) for run in runs))


def _measured(run, signals, noise, rng):
    noisy = {name: values + noise * rng.standard_normal(len(values)) for name, values in signals.items()}
    return replace(run, channels={**run.channels, **noisy})


def fitted(candidate, value, probability=0.9, gain=100.0):
    """A model of one mechanism, with an interval of a fifth."""
    both = {**candidate.parameters([value]), **candidate.derived([value])}
    numbers = {name: v for name, v in both.items() if not isinstance(v, list)}
    intervals = {n: Interval(v, 0.8 * v, 1.2 * v, candidate.units.get(n, "")) for n, v in numbers.items()}
    return FittedModel((Setting(candidate, (value,)),), (intervals,), gain, 0.5 * gain, probability, 0.4)


def found(recording, models=(), best=None, groups=(), mismatch=True, unexplained=False, **more):
    """Findings as an inference would put them, with the toy's own signals."""
    engine = ToyEngine(recording)
    numbered = list(enumerate(recording.runs))
    settings = best.settings if best is not None else ()
    noise = {key: model.summary() for key, model in noise_models(recording).items()}
    place = LocatedExcess(recording.runs[0].label, "voltage_V", "hold", 0, (0.0, 2.0), 12.0, 1e-4, 0.9, "readout")
    fit = Fit(tuple(f"{run.label}, press 1" for run in recording.runs), 0.84, 0.03, 0.026, 100.0)
    parts = {
        "engine": "toy",
        "engine_accuracy": {"force_N": 0.004, "voltage_V": 0.011},
        "detection": Detection(12.0, 1e-4 if mismatch else 0.4, 0.0032, noise),
        "places": (place,) if mismatch else (),
        "shares": {"readout": 0.8, "medium2": 0.1} if mismatch else {},
        "screened": {("charge-leakage", "readout"): 1e-9, ("friction", "dot"): 0.7},
        "mismatch": mismatch,
        "unexplained": unexplained,
        "reasons": (),
        "models": tuple(models),
        "best": best,
        "groups": groups,
        "train": fit if models else None,
        "held_out": fit if models else None,
        "nuisances": {"gain of slow": (0.001, 0.02)},
        "baseline": {run.label: engine.predict(n, ()) for n, run in numbered},
        "improved": {run.label: engine.predict(n, settings) for n, run in numbered} if best else None,
        "black_box_gain": 2.0,
    }
    return Findings(**{**parts, **more})
