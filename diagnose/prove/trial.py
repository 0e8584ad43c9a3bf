"""One case from its seed to its score: conceal, commit, diagnose in isolation, reveal, verify, compare.

The presses that a verdict asks for, made in the hidden world, and whether the longer recording settles the name.

Commit, diagnose, reveal, verify: a truth is fixed by a hash before anybody looks at its recording.

A commitment is the SHA-256 of a random salt and the truth as canonical JSON. The salt keeps short truths from being
guessed; nobody can exchange the truth afterwards (Blum, Coin flipping by telephone, 1981).
"""

import hashlib
import json
import secrets
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from diagnose.prove import rivals
from diagnose.prove.folder import files
from diagnose.prove.isolation import Heard, diagnosed
from diagnose.prove.score import Name, Score, scored
from diagnose.prove.world.bench import Bench, Run, traced
from diagnose.prove.world.cases import Case, concealed, pressed_again, rival_family
from diagnose.prove.world.effects import EFFECTS, fits
from diagnose.prove.world.reality import Judge, Signals
from diagnose.prove.world.rigs import BENCHES

SHAPE = frozenset({"speed_factor", "hold_s", "displacement_mm", "cycles"})
"""Changes that the waveform holds already."""
RESISTOR, CAPACITANCE, RECORDS = "input_resistance_MOhm", "input_capacitance_pF", "records"


def asked_run(bench: Bench, experiment: Mapping[str, Any], wave: str) -> Run | None:
    """A run that a verdict asks for, its waveform as CSV text; None where this world cannot change what is asked."""
    changes = experiment["changes"]
    if not changes.keys() <= SHAPE | {RESISTOR, CAPACITANCE, RECORDS}:
        return None
    like = next(run for run in bench.runs if run.label == experiment["as_in"])
    time_s, path_mm = np.loadtxt(wave.splitlines(), delimiter=",", skiprows=1, unpack=True)
    added_pF = changes.get(CAPACITANCE, bench.amplifier.capacitance_pF) - bench.amplifier.capacitance_pF
    resistance = changes.get(RESISTOR, like.resistance_MOhm)
    label = f"as asked for, {experiment['waveform'].removesuffix('.csv')}"
    return traced(label, time_s, path_mm, resistance, added_pF, like.place_mm, RECORDS in changes)


def with_asked(
    case: Case, runs: Sequence[Signals], experiment: Mapping[str, Any], waves: Mapping[str, str]
) -> tuple[Bench, list[Signals]] | None:
    """Bench and recording with all runs of next_experiment that can be made here; None without any.

    waves : file -> text of each waveform.
    """
    bench, signals = BENCHES[case.bench], list(runs)
    for number, asked in enumerate([experiment, *experiment["then"]]):
        run = asked_run(BENCHES[case.bench], asked, waves[asked["waveform"]])
        if run is None:
            continue
        try:
            more = pressed_again(case, run, number)
        except (RuntimeError, FloatingPointError):  # no equilibrium that deep
            continue
        bench, signals = replace(bench, runs=(*bench.runs, run)), [*signals, more]
    return (bench, signals) if len(signals) > len(runs) else None


@dataclass(frozen=True)
class Sealed:
    """A truth with its salt; digest is what may be shown before."""

    truth: Mapping[str, Any]
    salt: str

    @property
    def digest(self) -> str:
        """SHA-256 in hexadecimal."""
        return digest_of(self.truth, self.salt)


def seal(truth: Mapping[str, Any]) -> Sealed:
    """With a new salt of 256 bits."""
    return Sealed(truth, secrets.token_hex(32))


def digest_of(truth: Mapping[str, Any], salt: str) -> str:
    """SHA-256 of salt and truth."""
    text = json.dumps(truth, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(f"{salt}\n{text}".encode()).hexdigest()


def verified(truth: Mapping[str, Any], salt: str, digest: str) -> bool:
    """Whether truth and salt are those of the digest."""
    return secrets.compare_digest(digest_of(truth, salt), digest)


FAST = "--fast-model-only"
"""What the full model presses again comes after the name and changes no score."""
Commit = Callable[[str, str], None]
"""Publishes name of the recording and digest, before the diagnosis begins."""


@dataclass(frozen=True)
class Terms:
    """cache : of the diagnosis, for its meshes and presses. limit_s : for one diagnosis."""

    cache: Path
    limit_s: float = 3600.0


def tried(case: Case, terms: Terms, commit: Commit) -> dict[str, Any]:
    """The record of a case: truth, salt and digest, verdict, score and what rivals say."""
    truth, runs = concealed(case)
    sealed = seal(truth.plain())
    digest = sealed.digest
    commit(case.name, digest)
    heard = _heard(case, terms, files(BENCHES[case.bench], runs))
    if not verified(sealed.truth, sealed.salt, digest):
        raise RuntimeError(f"{case.name}: the truth does not match its hash")
    found = {name: asdict(opinion) for name, opinion in rivals.opinions(case.bench, runs).items()}
    record = {"case": asdict(case), "truth": sealed.truth, "salt": sealed.salt, "digest": digest, "rivals": found}
    if heard.verdict is None:
        nothing = {"verdict": None, "score": None}
        return {**record, "status": "no verdict", "reason": heard.reason, "seconds": heard.seconds, **nothing}
    score = _scored(case, sealed.truth, heard.verdict, heard.seconds)
    if score.equals > 1 and heard.next_presses:
        longer = with_asked(case, runs, heard.verdict["next_experiment"], heard.next_presses)
        if longer is not None:
            record["asked"], resolved, left = _settled(case, terms, sealed.truth, files(*longer))
            score = replace(score, resolved=resolved, smaller=None if resolved is None else 0 < left < score.equals)
    own = {"seconds": heard.seconds, "verdict": heard.verdict, "score": score.plain()}
    return {**record, "status": "scored", "reason": None, **own}


def _heard(case: Case, terms: Terms, recording: Mapping[str, str]) -> Heard:
    options = (FAST, "--without", case.without) if case.without else (FAST,)
    return diagnosed(recording, terms.cache, terms.limit_s, options)


def _scored(case: Case, truth: Mapping[str, Any], verdict: Mapping[str, Any], seconds: float) -> Score:
    return scored(truth, verdict, lambda name: separation(case, name), seconds)


def _settled(
    case: Case, terms: Terms, truth: Mapping[str, Any], recording: Mapping[str, str]
) -> tuple[dict[str, Any], bool | None, int]:
    """What a recording with the presses that were asked for tells, whether it names just the truth, and its equals.

    No equals where the truth is not among what is as good as the best.
    """
    heard = _heard(case, terms, recording)
    if heard.verdict is None:
        return {"reason": heard.reason}, None, 0
    score = _scored(case, truth, heard.verdict, heard.seconds)
    left = score.equals if score.exact or score.equals > 1 else 0
    told = {"named": [list(name) for name in score.named], "group": score.group, "equals": left}
    return {**told, "seconds": heard.seconds}, score.exact and score.group == 1, left


def separation(case: Case, rival: Name) -> float | None:
    """Sigmas between the true effects and the nearest that a rival mechanism can do, in the generator's own model."""
    bench = BENCHES[case.bench]
    names = tuple(n for n, e in EFFECTS.items() if (e.mechanism, e.component) == rival and fits(n, bench))
    if not names or not case.effects:
        return None
    true = np.sum([rival_family(case, (name,))[0] for name in case.effects], axis=0)
    return Judge.separation(true, rival_family(case, names))
