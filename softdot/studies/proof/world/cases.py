"""The cases: which effects at which size on which bench, from a number and a seed alone."""

from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import cycle
from typing import Any

import numpy as np

from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.details import Details
from softdot.studies.proof.world.effects import EFFECTS, KNOWN, STAGED, UNKNOWN, apply_effects, fits
from softdot.studies.proof.world.judge import Judge, judge_of, shares
from softdot.studies.proof.world.reality import PER_RUN, Reality, Signals, baseline, keys, noise_law, noise_of, record
from softdot.studies.proof.world.rigs import BENCHES, VOLTAGE_ONLY
from softdot.studies.proof.world.runs import Run

NONE, SINGLE, PAIR, LEFT_OUT, OUTSIDE, AMBIGUOUS = "none", "single", "pair", "left-out", "outside", "ambiguous"
KINDS = (NONE, SINGLE, PAIR, LEFT_OUT, OUTSIDE, AMBIGUOUS)
PATTERN = (
    NONE, SINGLE, NONE, SINGLE, NONE, OUTSIDE, SINGLE, NONE, SINGLE, NONE,
    SINGLE, NONE, LEFT_OUT, SINGLE, NONE, PAIR, NONE, SINGLE, NONE, AMBIGUOUS,
)  # fmt: skip
SIZES = (5.0, 10.0, 2.0, 20.0, 1.0, 0.5, 0.2)
PAIRS: list[tuple[str, ...]] = [
    ("leakage", "gap"), ("relaxing-medium2", "leakage"), ("soft-rig", "low-pass"), ("gap", "cable"),
]  # fmt: skip
SPECIMENS = 4
DISPLACEMENT_NOISE_MM = 2e-4
SIZING_STEPS = 4
AGAIN, FLAWS = 1, 2  # tell the draws of one more press, and of a rig's flaws, from those of the case


@dataclass(frozen=True)
class Case:
    """Plan of one concealed recording. size : whitened root mean square per sample that is aimed at, of each effect.
    without : left out of the tool.

    details : whether the rig has flaws that no mechanism describes.
    """

    number: int
    seed: int
    kind: str
    bench: str
    effects: tuple[str, ...] = ()
    size: float = 0.0
    without: str = ""
    details: bool = False

    @property
    def name(self) -> str:
        """Name of the recording, which says nothing of its content."""
        return f"case-{self.number:04d}"


@dataclass(frozen=True)
class Truth:
    """What is concealed. size : reached; per_run : (run, channel) -> share of the effect's energy.

    flaws : size of the rig's flaws, taken alike; 0 where it has none.
    """

    case: Case
    strengths: dict[str, float]
    values: dict[str, dict[str, float]]
    nuisance: dict[str, float]
    size: float
    sigma: float
    per_run: dict[str, float] = field(default_factory=dict)
    flaws: float = 0.0

    def plain(self) -> dict[str, Any]:
        """The truth as JSON has it."""
        mechanisms = [
            {
                "effect": name,
                "mechanism": EFFECTS[name].mechanism,
                "component": EFFECTS[name].component,
                "form": EFFECTS[name].form,
                "strength": s,
                "values": self.values[name],
            }
            for name, s in self.strengths.items()
        ]
        case = {"number": self.case.number, "seed": self.case.seed, "kind": self.case.kind, "bench": self.case.bench}
        return {
            **case,
            "without": self.case.without,
            "mechanisms": mechanisms,
            "nuisance": self.nuisance,
            "aimed_rms": self.case.size,
            "whitened_rms": self.size,
            "flaws_rms": self.flaws,
            "sigma": self.sigma,
            "per_run": self.per_run,
        }


def plan(
    count: int,
    seed: int,
    rigs: tuple[str, ...],
    staged: bool = True,
    kinds: tuple[str, ...] = KINDS,
    details: bool = False,
    mechanisms: tuple[str, ...] = (),
) -> list[Case]:
    """The first count cases of some kinds; all follow a fixed pattern, mechanisms, sizes and rigs take turns.

    mechanisms : to which the known effects are restricted; () for all. ValueError where no rig can have one of them.
    """
    known = tuple(name for name in (KNOWN[:STAGED] if staged else KNOWN) if _is_asked(name, mechanisms, rigs))
    if not known:
        raise ValueError("none of these rigs can have one of these mechanisms")
    turns = dict.fromkeys(KINDS, 0)
    cases: list[Case] = []
    for number, kind in enumerate(cycle(PATTERN), start=1):
        if len(cases) == count:
            break
        if kind in kinds:
            cases.append(replace(_case(number, seed, kind, turns[kind], rigs, known), details=details))
        turns[kind] += 1
    return cases


def _is_asked(name: str, mechanisms: tuple[str, ...], rigs: tuple[str, ...]) -> bool:
    """Whether an effect is of these mechanisms and one of the rigs has as many channels as it needs."""
    most = max(len(BENCHES[rig].made.electrodes) for rig in rigs)
    return EFFECTS[name].channels <= most and (not mechanisms or EFFECTS[name].mechanism in mechanisms)


def _case(number: int, seed: int, kind: str, turn: int, rigs: tuple[str, ...], known: tuple[str, ...]) -> Case:
    if kind == AMBIGUOUS:
        hidden = ("cable", "weak-film")[turn % 2]
        return Case(number, seed, kind, VOLTAGE_ONLY.name, (hidden,), SIZES[turn // 2 % 3])
    if kind == NONE:
        return Case(number, seed, kind, rigs[turn % len(rigs)])
    alone: list[tuple[str, ...]] = [(name,) for name in known]
    others: list[tuple[str, ...]] = [(name,) for name in UNKNOWN]
    choice = {SINGLE: alone, LEFT_OUT: alone, OUTSIDE: others, PAIR: PAIRS}[kind]
    lap, place = divmod(turn, len(choice))
    effects, sizes = choice[place], SIZES if kind == SINGLE else SIZES[:2]
    fitting = [rig for rig in rigs if all(fits(name, BENCHES[rig]) for name in effects)] or [BENCHES_FIRST]
    without = EFFECTS[effects[0]].mechanism if kind == LEFT_OUT else ""
    again, step = divmod(lap, len(sizes))
    rig = fitting[(place + step + again) % len(fitting)]  # every effect meets every rig at every size
    return Case(number, seed, kind, rig, effects, sizes[step], without)


BENCHES_FIRST = next(iter(BENCHES))


def conceal(case: Case) -> tuple[Truth, list[Signals]]:
    """Truth of a case and its recorded runs, noise included."""
    bench, rng = BENCHES[case.bench], np.random.default_rng([case.seed, case.number])
    judge, strengths = judge_of(case.bench), _strengths(case)
    nuisance = _nuisance(bench, rng)
    plainly = replace(baseline(bench), nuisance=nuisance, details=_details(case))
    reality = apply_effects(plainly, bench, strengths)
    left = judge.residual(reality, plainly)
    values = {name: EFFECTS[name].truth(bench, s) for name, s in strengths.items()}
    values = {name: {**one, **_force_ratio(name, bench, plainly, reality)} for name, one in values.items()}
    per_run = {f"{run} | {channel}": share for (run, channel), share in shares(left, bench).items()}
    named = {_nuisance_name(key): value for key, value in nuisance.items()}
    flaws = judge.rms(judge.residual(plainly, replace(plainly, details=None))) if case.details else 0.0
    truth = Truth(case, strengths, values, named, judge.rms(left), float(np.linalg.norm(left)), per_run, flaws)
    return truth, [_noisy(run, bench, rng) for run in record(reality, bench)]


def _nuisance_name(key: Any) -> str:
    if isinstance(key, str):
        return key
    name, run, *channel = key
    return f"{name} of run {run}" + "".join(f", channel {number + 1}" for number in channel)


def press_again(case: Case, run: Run, number: int) -> Signals:
    """Record one more run of the same specimen, with nuisances and noise of its own; number : of those asked for.

    RuntimeError or FloatingPointError without equilibrium.
    """
    bench, first = BENCHES[case.bench], np.random.default_rng([case.seed, case.number])
    rng = np.random.default_rng([case.seed, case.number, AGAIN, number])
    known: dict[Any, float] = {k: value for k, value in _nuisance(bench, first).items() if isinstance(k, str)}
    here = [(name, width) for name, width in bench.floating(run) if name in PER_RUN]
    one = replace(bench, runs=(run,))
    numbered = [((name, len(bench.runs), *key[2:]), width) for name, width in here for key in keys(name, one)]
    own = {key: width * float(rng.standard_normal()) for key, width in numbered}
    believed = replace(baseline(bench), nuisance=known | own, details=_details(case))
    reality = apply_effects(believed, bench, _strengths(case))
    return _noisy(record(reality, replace(bench, runs=(*bench.runs, run)))[-1], bench, rng)


def _details(case: Case) -> Details | None:
    """Flaws of the specimen; None where the case has none."""
    return Details.draw(np.random.default_rng([case.seed, case.number, FLAWS])) if case.details else None


def _strengths(case: Case) -> dict[str, float]:
    judge = judge_of(case.bench)
    return {name: _strength(judge, name, case.size) for name in case.effects}


def _nuisance(bench: Bench, rng: np.random.Generator) -> dict[Any, float]:
    """Draw nuisances within the declared widths; specimens come from a pool, so that their presses are solved once."""
    drawn: dict[Any, float] = {}
    pool = np.random.default_rng(sum(map(ord, bench.name))).standard_normal((SPECIMENS, 20)).clip(-2.0, 2.0)
    specimen = int(rng.integers(SPECIMENS))
    for column, (name, width) in enumerate(bench.nuisance):
        if name in PER_RUN:
            drawn |= {key: width * float(rng.standard_normal()) for key in keys(name, bench)}
        else:
            drawn[name] = width * float(pool[specimen, column])
    return drawn


@lru_cache(maxsize=512)
def _strength(judge: Judge, name: str, size: float) -> float:
    """Strength at which an effect has a size on the nominal bench, or the most that is real."""
    belief, effect, strength = baseline(judge.bench), EFFECTS[name], 1.0
    for _ in range(SIZING_STEPS):
        reached = judge.rms(judge.residual(apply_effects(belief, judge.bench, {name: strength}), belief))
        better = float(np.clip(strength * np.clip(size / max(reached, 1e-6), 0.1, 10.0), 1e-3, effect.most))
        if abs(better / strength - 1.0) < 0.05:
            break
        strength = better
    return float(f"{strength:.2g}")


def _force_ratio(name: str, bench: Bench, without: Reality, reality: Reality) -> dict[str, float]:
    """Ratio of the force with the effect to that without at the deepest press, for laws that stiffen."""
    if EFFECTS[name].mechanism != "hyperelastic-stiffening" or not bench.force:
        return {}
    on, off = (
        max(float(run["force_N"].max()) for run in record(replace(r, nuisance={}), bench)) for r in (reality, without)
    )
    return {"force_ratio": on / off}


def _noisy(run: Signals, bench: Bench, rng: np.random.Generator) -> Signals:
    noisy = dict(run)
    count = len(run["time_s"])
    noisy["displacement_mm"] = run["displacement_mm"] + DISPLACEMENT_NOISE_MM * rng.standard_normal(count)
    for name in (name for name in run if name not in ("time_s", "displacement_mm")):
        noisy[name] = run[name] + noise_of(bench)[name] * noise_law(name).draw(rng, count)
    return noisy


def rival_family(case: Case, names: tuple[str, ...]) -> list[Floats]:
    """Residuals that effects of these names leave on the bench, at the size of the case and at half of it."""
    judge, belief = judge_of(case.bench), baseline(BENCHES[case.bench])
    family = []
    for name in names:
        strength = _strength(judge, name, max(case.size, 1.0))
        family += [
            judge.residual(apply_effects(belief, judge.bench, {name: s}), belief) for s in (strength, 0.5 * strength)
        ]
    return family
