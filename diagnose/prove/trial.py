"""One case from its seed to its score: conceal, commit, diagnose in the clean room, reveal, verify, compare."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from diagnose.prove import rivals
from diagnose.prove.folder import files
from diagnose.prove.room import Heard, diagnosed
from diagnose.prove.score import Name, scored
from diagnose.prove.seal import seal, verified
from diagnose.prove.world.bench import BENCHES
from diagnose.prove.world.cases import Case, concealed, rival_family
from diagnose.prove.world.effects import EFFECTS, fits
from diagnose.prove.world.size import Judge

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
    options = (FAST, "--without", case.without) if case.without else (FAST,)
    heard = diagnosed(files(case.bench, runs), terms.cache, terms.limit_s, options)
    if not verified(sealed.truth, sealed.salt, digest):
        raise RuntimeError(f"{case.name}: the truth is not what was committed")
    found = {name: asdict(opinion) for name, opinion in rivals.opinions(case.bench, runs).items()}
    record = {"case": asdict(case), "truth": sealed.truth, "salt": sealed.salt, "digest": digest, "rivals": found}
    return {**record, **_judged(case, sealed.truth, heard)}


def _judged(case: Case, truth: Mapping[str, Any], heard: Heard) -> dict[str, Any]:
    """Score and verdict; without a verdict the reason."""
    if heard.verdict is None:
        nothing = {"verdict": None, "score": None}
        return {"status": "no verdict", "reason": heard.reason, "seconds": heard.seconds, **nothing}
    score = scored(truth, heard.verdict, lambda name: separation(case, name), heard.seconds)
    return {
        "status": "scored", "reason": None, "seconds": heard.seconds, "verdict": heard.verdict, "score": score.plain()
    }


def separation(case: Case, rival: Name) -> float | None:
    """Sigmas between the true effects and the nearest that a rival mechanism can do, in the generator's own model."""
    bench = BENCHES[case.bench]
    names = tuple(n for n, e in EFFECTS.items() if (e.mechanism, e.component) == rival and fits(n, bench))
    if not names or not case.effects:
        return None
    true = np.sum([rival_family(case, (name,))[0] for name in case.effects], axis=0)
    return Judge.separation(true, rival_family(case, names))
