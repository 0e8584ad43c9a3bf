"""The whole chain: from a recording and a forward model to findings."""

from collections.abc import Callable

import numpy as np

from diagnose.findings import Findings
from diagnose.fit.baseline import fit_baseline
from diagnose.fit.linearised_system import linearise
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.rig_discrepancy import RigDiscrepancy
from diagnose.fit.samples import Samples
from diagnose.forward import Engine
from diagnose.inference import hum
from diagnose.inference.findings_of_fits import baseline_findings, findings_of
from diagnose.inference.first_look import foremost_candidates, where_it_differs
from diagnose.inference.grades import Agreement, Evidence, judged
from diagnose.inference.held_out_scores import USUAL_ROUGH
from diagnose.inference.hypotheses import Judge, compared
from diagnose.inference.residual_test import checked
from diagnose.inference.screening import screen
from diagnose.noise.estimate import noise_models
from diagnose.signals.recording import Recording
from foundation.progress import Report


def diagnose(
    recording: Recording, engine: Engine, seed: int, report: Report, tell: Callable[[str], None] = lambda _: None
) -> Findings:
    """All findings of a recording. The same seed gives the same findings. InputError for a channel without noise.

    tell : called with a sentence on what is known while the rest is still to come.
    """
    rng = np.random.default_rng(seed)
    noise = noise_models(recording)
    loud = hum.loud_lines(recording, noise)
    if any(candidate.traits.free_phase for candidate in engine.candidates):
        engine = hum.HumEngine(engine, recording, loud)
        noise = hum.without(noise, loud)
    model = ObservedModel(Samples(recording, noise), engine)
    engine.prepare([one.candidate for one in model.nuisances if one.candidate is not None], report)
    report("baseline", 0, 1)
    baseline = fit_baseline(model)
    found = checked(model.samples, baseline, rng)
    verdict = judged(Evidence(found.p_value, best="?"))
    if isinstance(verdict, Agreement):
        return baseline_findings(model, baseline, found, verdict.reasons)
    tell(where_it_differs(model, baseline, found))
    engine.prepare_roughly(engine.candidates, report)
    discrepancy = RigDiscrepancy(model, baseline.values)
    model = model.with_tolerance(USUAL_ROUGH**2 * discrepancy.rough[0])
    screening = screen(model, linearise(model, baseline.values), report)
    tell(foremost_candidates(screening))
    hypotheses = compared(Judge(model, screening, discrepancy), rng, report)
    return findings_of(hypotheses, found, report)
