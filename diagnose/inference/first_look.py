"""A first look: where the simulation differs, and which candidates resemble the difference, before any fit."""

from dataclasses import replace

from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.observed_model import ObservedModel
from diagnose.inference.findings_of_fits import baseline_findings
from diagnose.inference.localisation import excess_places
from diagnose.inference.residual_test import Checked
from diagnose.inference.screening import Screening
from diagnose.verdict.names import join_words, mechanism_words
from diagnose.verdict.where_it_fails import where_words

SHOWN = 3


def where_it_differs(model: ObservedModel, baseline: LinearisedSystem, found: Checked) -> str:
    """Sentence on the runs and phases in which the fitted baseline is off."""
    places = excess_places(model.samples, found, {})
    differing = replace(baseline_findings(model, baseline, found, ()), mismatch=True, places=places)
    return f"First look: {where_words(model.samples.recording, differing)}"


def foremost_candidates(found: Screening) -> str:
    """Sentence on the candidates whose effect, scaled alone, takes most of the square of the difference."""
    foremost = found.survivors[:SHOWN]
    if not foremost:
        return f"First look: none of {len(found.candidates)} candidates resembles the difference on its own."
    told = [f"{mechanism_words(*found.candidates[n].name)} ({100 * found.tests.explained[n]:.0f} %)" for n in foremost]
    return (
        f"First look: of {len(found.candidates)} candidates, scaled alone and before any fit, these take most of the "
        f"square of the difference: {join_words(told)}."
    )
