"""One case from its seed to its score: conceal, commit, diagnose in isolation, reveal, verify, compare."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from softdot.studies.proof import rivals
from softdot.studies.proof.asked_presses import with_asked
from softdot.studies.proof.commitment import matches_digest, seal
from softdot.studies.proof.isolation import Heard, diagnose_isolated
from softdot.studies.proof.recording_folder import files
from softdot.studies.proof.score import Name, Score, score_verdict
from softdot.studies.proof.world.cases import Case, conceal, rival_family
from softdot.studies.proof.world.effects import EFFECTS, fits
from softdot.studies.proof.world.judge import Judge
from softdot.studies.proof.world.rigs import BENCHES

FAST = "--fast-model-only"
"""What the full model presses again comes after the name and changes no score."""
Commit = Callable[[str, str], None]
"""Publishes name of the recording and digest, before the diagnosis begins."""


@dataclass(frozen=True)
class Terms:
    """Terms of a trial. cache : of the diagnosis, for its meshes and presses. limit_s : for one diagnosis."""

    cache: Path
    limit_s: float = 3600.0


def try_case(case: Case, terms: Terms, commit: Commit) -> dict[str, Any]:
    """Try a case; its record: truth, salt and digest, verdict, score and what rivals say."""
    truth, runs = conceal(case)
    sealed = seal(truth.plain())
    digest = sealed.digest
    commit(case.name, digest)
    heard = _heard(case, terms, files(BENCHES[case.bench], runs))
    if not matches_digest(sealed.truth, sealed.salt, digest):
        raise RuntimeError(f"{case.name}: the truth does not match its hash")
    found = {name: asdict(opinion) for name, opinion in rivals.opinions(case.bench, runs).items()}
    record = {"case": asdict(case), "truth": sealed.truth, "salt": sealed.salt, "digest": digest, "rivals": found}
    if heard.verdict is None:
        nothing = {"verdict": None, "score": None}
        return {**record, "status": "no verdict", "reason": heard.reason, "seconds": heard.seconds, **nothing}
    score = _score(case, sealed.truth, heard.verdict, heard.seconds)
    if score.equals > 1 and heard.next_presses:
        longer = with_asked(case, runs, heard.verdict["next_experiment"], heard.next_presses)
        if longer is not None:
            record["asked"], resolved, left = _settle(case, terms, sealed.truth, files(*longer))
            score = replace(score, resolved=resolved, smaller=None if resolved is None else 0 < left < score.equals)
    own = {"seconds": heard.seconds, "verdict": heard.verdict, "score": score.plain()}
    return {**record, "status": "scored", "reason": None, **own}


def _heard(case: Case, terms: Terms, recording: Mapping[str, str]) -> Heard:
    options = (FAST, "--without", case.without) if case.without else (FAST,)
    return diagnose_isolated(recording, terms.cache, terms.limit_s, options)


def _score(case: Case, truth: Mapping[str, Any], verdict: Mapping[str, Any], seconds: float) -> Score:
    return score_verdict(truth, verdict, lambda name: separation(case, name), seconds)


def _settle(
    case: Case, terms: Terms, truth: Mapping[str, Any], recording: Mapping[str, str]
) -> tuple[dict[str, Any], bool | None, int]:
    """Verdict on a recording with the presses that were asked for: its content, whether it names just the truth, and
    how many are its equals.

    No equals where the truth is not among what is as good as the best.
    """
    heard = _heard(case, terms, recording)
    if heard.verdict is None:
        return {"reason": heard.reason}, None, 0
    score = _score(case, truth, heard.verdict, heard.seconds)
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
