"""Plain models that an expert would write for a real recording: python -m benchmarks.experts JSON FOLDER…

Each is fitted by SciPy to the presses that a diagnosis trains on and shown on those that it holds out, so that its
error stands beside that of a verdict (benchmarks/verdicts.py). None shares a line with the diagnosis but the reading of
files and the cut into presses.

coupon in tension or shear : two elastic terms, each with Prony branches a decade apart (quasi-linear viscoelasticity;
Fung, Biomechanics, 1981), all constants by non-negative least squares; a thin strip does not push.
coupon in compression : a polynomial of the strain, less on the way back (hysteresis of a constant share).
Coulomb : a spring that slips at a constant force.
unknown sensor : V' + V / tau = k F' in each channel.
"""

import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares, minimize_scalar, nnls
from scipy.signal import lfilter

from benchmarks.timing import Table, file_argument
from diagnose.inference.true_refit import split
from diagnose.signals.reading import thin_recording
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Bools, Floats
from softdot.config.rig import RIG_FILE, load_rig

Chosen = Sequence[tuple[Run, Bools]]
"""Runs with the samples (t,) that are meant."""
Expert = Callable[[Recording, Chosen], Callable[[Run], dict[str, Floats]]]


def branches_s(recording: Recording) -> Floats:
    """A time of relaxation each decade, from the shortest step to the longest run."""
    low = min(run.step_s for run in recording.runs)
    high = max(float(np.ptp(run.time_s)) for run in recording.runs)
    return np.asarray(10.0 ** np.arange(np.log10(3.0 * low), np.log10(high) + 0.5))


def remembered(time_s: Floats, elastic: Floats, tau_s: float) -> Floats:
    """What one Maxwell branch still carries of an elastic response (t,)."""
    carried, now = np.zeros(len(elastic)), 0.0
    for n in range(1, len(elastic)):
        step = (time_s[n] - time_s[n - 1]) / tau_s
        now = now * np.exp(-step) + (elastic[n] - elastic[n - 1]) * -np.expm1(-step) / step
        carried[n] = now
    return carried


def quasi_linear(recording: Recording, train: Chosen) -> Callable[[Run], dict[str, Floats]]:
    """Tension or shear."""
    specimen = recording.specimen
    assert specimen is not None
    taus, shear = branches_s(recording), specimen.kind == "shear"

    def terms(run: Run) -> Floats:
        strain = run.channels["displacement_mm"] / specimen.gauge_mm
        if shear:
            both = [strain, strain / np.hypot(1.0, strain / 2.0)]  # of Ogden's exponents 2 and 1
        else:
            both = [1.0 + strain - (1.0 + strain) ** -2, 1.0 - (1.0 + strain) ** -3]
        columns = [column for one in both for column in (one, *(remembered(run.time_s, one, tau) for tau in taus))]
        return np.column_stack(columns)

    rows = np.concatenate([terms(run)[used] for run, used in train])
    force = np.concatenate([run.channels["force_N"][used] for run, used in train])
    size = np.linalg.norm(rows, axis=0)
    constants = nnls(rows / size, force)[0] / size
    push = -np.inf if shear else 0.0
    return lambda run: {"force_N": np.maximum(terms(run) @ constants, push)}


def polynomial(recording: Recording, train: Chosen) -> Callable[[Run], dict[str, Floats]]:
    """Compression: of the order eight, and a share of it less on the way back."""
    specimen = recording.specimen
    assert specimen is not None

    def terms(run: Run) -> Floats:
        strain = run.channels["displacement_mm"] / specimen.gauge_mm
        powers = strain[:, None] ** np.arange(1, 9)
        back = (np.gradient(strain, run.time_s) < 0.0)[:, None]
        return np.column_stack([powers, np.where(back, powers, 0.0)])

    rows = np.concatenate([terms(run)[used] for run, used in train])
    force = np.concatenate([run.channels["force_N"][used] for run, used in train])
    constants = np.linalg.lstsq(rows, force, rcond=1e-10)[0]
    return lambda run: {"force_N": terms(run) @ constants}


def coulomb(_recording: Recording, train: Chosen) -> Callable[[Run], dict[str, Floats]]:
    """Spring and slider in series, with an offset."""
    largest = max(float(np.abs(run.channels["force_N"][used]).max()) for run, used in train)
    travel = max(float(np.ptp(run.channels["displacement_mm"])) for run, _ in train)

    def force(run: Run, logs: Floats) -> Floats:
        stiffness, slips, offset = np.exp(logs[0]), np.exp(logs[1]), logs[2]
        moved, found = np.diff(run.channels["displacement_mm"], prepend=run.channels["displacement_mm"][0]), 0.0
        out = np.empty(len(moved))
        for n, change in enumerate(moved):
            found = float(np.clip(found + stiffness * change, -slips, slips))
            out[n] = found
        return out + offset

    def misfit(logs: Floats) -> Floats:
        return np.concatenate([(force(run, logs) - run.channels["force_N"])[used] for run, used in train])

    starts = [np.array([np.log(share * largest / travel), np.log(largest), 0.0]) for share in (3.0, 30.0, 300.0)]
    best = min((least_squares(misfit, start) for start in starts), key=lambda found: found.cost)
    return lambda run: {"force_N": force(run, best.x)}


def leaking(recording: Recording, train: Chosen) -> Callable[[Run], dict[str, Floats]]:
    """A high-pass of the force: one time constant of all channels, gain and offset of each."""
    names = recording.runs[0].voltages

    def passed(run: Run, tau_s: float) -> Floats:
        keep = np.exp(-run.step_s / tau_s)
        return np.asarray(lfilter([1.0, -1.0], [1.0, -keep], run.channels["force_N"] - run.channels["force_N"][0]))

    def constants(tau_s: float) -> tuple[float, dict[str, Floats]]:
        lost, found = 0.0, {}
        for name in names:
            shape = np.concatenate([passed(run, tau_s)[used] for run, used in train])
            seen = np.concatenate([run.channels[name][used] for run, used in train])
            rows = np.column_stack([shape, np.ones(len(shape))])
            found[name] = np.linalg.lstsq(rows, seen, rcond=None)[0]
            lost += float(((seen - rows @ found[name]) ** 2).sum() / (seen**2).sum())
        return lost, found

    grid = np.linspace(np.log(1e-3), np.log(1e3), 61)
    middle = float(min(grid, key=lambda log: constants(np.exp(log))[0]))
    best = minimize_scalar(lambda log: constants(np.exp(log))[0], bounds=(middle - 0.3, middle + 0.3), method="bounded")
    tau_s, (_, own) = float(np.exp(best.x)), constants(float(np.exp(best.x)))
    return lambda run: {name: own[name][0] * passed(run, tau_s) + own[name][1] for name in names}


def experts_of(recording: Recording) -> dict[str, Expert]:
    """Those that fit what was measured."""
    if recording.specimen is None:
        return {"leak": leaking}
    if recording.specimen.kind == "compression":
        return {"polynomial with hysteresis": polynomial}
    return {"quasi-linear viscoelasticity": quasi_linear, "Coulomb": coulomb}


def chosen(recording: Recording, presses: Sequence[tuple[int, int]]) -> list[tuple[Run, Bools]]:
    """Samples of some presses, by run."""
    found = []
    for number in dict.fromkeys(run for run, _ in presses):
        run, own = recording.runs[number], [press for at, press in presses if at == number]
        used = np.isin(recording.phases[number].press, own) & run.usable(run.answers[0])
        found.append((run, used))
    return found


def error(predict: Callable[[Run], dict[str, Floats]], held: Chosen) -> float:
    """Root mean square over the recording's, each channel counting alike."""
    channels = list(held[0][0].answers)
    missed, seen = dict.fromkeys(channels, 0.0), dict.fromkeys(channels, 0.0)
    for run, used in held:
        for name, values in predict(run).items():
            missed[name] += float(((values - run.channels[name])[used] ** 2).sum())
            seen[name] += float((run.channels[name][used] ** 2).sum())
    return float(np.sqrt(np.mean([missed[name] / seen[name] for name in channels])))


def main(path: Path, folders: list[Path]) -> None:
    """Fit what the file has not."""
    table = Table(path, "experts")
    for folder in sorted(place.parent for root in folders for place in root.rglob(RIG_FILE)):
        recording = thin_recording(load_rig(folder).recording)
        presses = [(n, press) for n, found in enumerate(recording.phases) for press in range(len(found.presses))]
        train, held = ([presses[n] for n in numbers] for numbers in split(len(presses)))
        for name, expert in experts_of(recording).items():
            if not table.has(recording=folder.name, expert=name):
                predict = expert(recording, chosen(recording, train))
                held_out = error(predict, chosen(recording, held or train))
                table.add({"recording": folder.name, "expert": name, "held_out": bool(held), "error": held_out})


if __name__ == "__main__":
    main(file_argument(), [Path(word) for word in sys.argv[2:]])
