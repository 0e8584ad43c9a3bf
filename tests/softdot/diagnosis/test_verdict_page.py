"""A verdict page prints each quantity with one value, whatever was found and however extreme it is."""

import html
import re
from dataclasses import replace

import numpy as np
import pytest

from diagnose.findings import Fit, FittedModel, Interval
from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.next_press.choose import next_presses
from diagnose.verdict.content import verdict
from diagnose.verdict.names import interval_words, mechanism_words
from diagnose.verdict.resimulation import Resimulation
from diagnose.verdict.words import sentences
from softdot.diagnosis.report import page_text
from softdot.json_files import plain
from solve.mechanisms import MECHANISMS
from tests.cases import for_each
from tests.diagnose.verdict.toy import LEAK, RELAXING, ToyEngine, fitted, found, toy_recording

UNITS = ("MOhm", "pF", "Hz", "V", "s", "K", "pC", "MPa", "mm", "um", "N_per_mm3", "mm_per_N", "g")
INTERVALS = {
    "ordinary": (1001.2, 995.49, 1006.7),
    "narrow": (1001.2, 1001.19, 1001.21),
    "narrower than its digits": (1.0, 1.0 - 1e-12, 1.0 + 1e-12),
    "one-sided": (0.9, 0.31, 0.9),
    "open": (5e3, 2e3, np.inf),
    "tiny": (3.2e-9, 1.1e-9, 7.7e-9),
    "huge": (4.4e12, 3.9e12, 6.2e12),
    "negative": (-0.031, -0.052, -0.011),
    "about zero": (0.0, -0.004, 0.004),
}
PLACES = [(name, component) for name, kind in MECHANISMS.items() for component in dict.fromkeys(kind.components[:9])]
NUMBER = r"[−\d.]+(?: × 10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?|−?∞"

PRINTED = rf" ({NUMBER})(?: [^\d(]+)? \(90 % interval ({NUMBER}) to ({NUMBER})"


def unit_of(name):
    return next((unit for unit in sorted(UNITS, key=len, reverse=True) if name.endswith(f"_{unit}")), "")


def model_of(mechanism, component, ends, probability=1.0):
    """A fitted mechanism all of whose parameters have the same value and interval."""
    fields = MECHANISMS[mechanism].parameters.model_fields
    intervals = {name: Interval(*ends, unit_of(name)) for name in fields}
    if "order" in fields:
        intervals["order"] = Interval(1.0, 1.0, 1.0, "", high_searched=True, fixed=True)
    values = dict.fromkeys(fields, ends[0])
    candidate = Candidate(mechanism, component, (Coordinate("it", -1.0, 1.0, (0.1,)),), lambda _: values)
    return FittedModel((Setting(candidate, (0.5,)),), (intervals,), 123.4, 98.7, probability, 0.0)


@pytest.fixture(scope="module")
def recording():
    return toy_recording([Setting(LEAK, (0.5,))])


@pytest.fixture(scope="module")
def of_the_toy(recording):
    """Everything that does not depend on what is named."""
    return found(recording, (fitted(LEAK, 0.5),), fitted(LEAK, 0.5), ((0,),))


def page(recording, findings, resimulated=(), following=()):
    """What is told, verdict.json and the text of the page without its marks."""
    told = sentences(recording, findings, following, resimulated)
    summary = plain(verdict(findings, [str(one) for one in told], following, resimulated, ()))
    text = page_text(findings, told, summary, ())
    body = re.sub(r"<style.*?</style>", "", text, flags=re.DOTALL)
    return " ".join(map(str, told)), summary, html.unescape(body)


def rows(body):
    """Cells of every row of every table."""
    found = re.findall(r"<tr>(.*?)</tr>", body, re.DOTALL)
    cells = (re.findall(r"<td[^>]*>(.*?)</td>", row, re.DOTALL) for row in found)
    return [[re.sub(r"<[^>]+>", "", cell).strip() for cell in row] for row in cells if row]


def shown(text):
    """The number that a text stands for."""
    if "∞" in text:
        return -np.inf if "−" in text else np.inf
    mantissa, _, power = text.replace("−", "-").partition(" × 10")
    digits = power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    return float(mantissa) * 10.0 ** int(digits or 0)


def significant(text):
    digits = text.partition(" × ")[0].replace(".", "").lstrip("−0")
    return max(len(digits), 1)


@pytest.mark.press
@for_each(("mechanism", "component"), PLACES)
def test_a_parameter_has_one_value_in_headline_table_and_file(recording, of_the_toy, mechanism, component):
    for ends in INTERVALS.values():
        printed_alike(recording, of_the_toy, model_of(mechanism, component, ends))


def printed_alike(recording, of_the_toy, best):
    mechanism, component = best.settings[0].candidate.name
    told, summary, body = page(recording, replace(of_the_toy, models=(best,), best=best))
    assert mechanism_words(mechanism, component) in told
    table = {row[1]: row for row in rows(body[body.index('id="parameters"') :]) if len(row) == 7}
    assert table
    for name, its in summary["missing_physics"][0]["parameters"].items():
        words = interval_words(name, best.parameters[0][name])
        assert words in told
        row = next(row for row in table.values() if words.startswith(f"{row[1]} {row[2]}"))
        assert its["fixed"] == (row[3] == "–")
        if its["fixed"]:
            continue
        value, low, high = words_of = re.search(PRINTED, words).groups()
        assert row[2:5] == list(words_of)
        for text, stored in zip(words_of, (its["value"], its["low"], its["high"]), strict=True):
            rounding = 0.51 * 10.0 ** (1 - significant(text))
            assert stored is None or shown(text) == pytest.approx(stored, rel=rounding, abs=1e-12)
        if value in (low, high):
            assert "same as the value" in words
            assert "same as the value" in row[6]


def test_what_was_not_fitted_has_no_interval(recording, of_the_toy):
    best = model_of("low-pass", "readout", INTERVALS["ordinary"])
    told, _, body = page(recording, replace(of_the_toy, models=(best,), best=best))
    assert "order 1," in told
    (order,) = (row for row in rows(body) if len(row) == 7 and row[1] == "order")
    assert order[2:] == ["1", "–", "–", "", "not fitted"]


def test_an_end_that_the_search_set_is_called_so(recording, of_the_toy):
    best = fitted(RELAXING, 0.9)
    ((values),) = best.parameters
    intervals = {name: Interval(0.9, 0.7, 0.9, one.unit, high_searched=True) for name, one in values.items()}
    best = replace(best, parameters=(intervals,))
    told, _, body = page(recording, replace(of_the_toy, models=(best,), best=best))
    words = "the upper end is a limit of the search, not of the data"
    assert f"(90 % interval 0.7 to 0.9; {words})" in told
    assert words in body


ERRORS = [(1.0, 0.011, 0.017), (0.84, 0.03, 0.026), (1234.5, 1e-7, 3e-9), (0.5, 0.5, 0.5), (0.02, 0.031, 0.01)]


@for_each(("before", "after", "noise"), ERRORS)
@for_each("named", [True, False], ids=["named", "unexplained"])
def test_an_error_has_one_value_and_a_definition(recording, of_the_toy, before, after, noise, named):
    fit = Fit(("slow, press 1",), before, after, noise, 17.0)
    parts = {"held_out": fit} if named else {"best": None, "unexplained": True, "unnamed": fit, "reasons": ("Why.",)}
    told, _, body = page(recording, replace(of_the_toy, **parts))
    row = next(row for row in rows(body) if row[0].startswith("held out") and (named or "closest" in row[0]))
    said = re.search(r"from (\S+ %|\S+ × \S+ %) to (\S+ %|\S+ × \S+ %) of the recorded signal \((.*?)\)", told)
    if named or after < before:
        assert list(said.groups()[:2]) == row[2:4]
        assert row[4] in said[3]
        assert said[3].startswith("no more than the estimated noise") == (after <= noise)
    assert "An error is the root mean square of recorded minus simulated signal, divided by" in body


def test_the_title_does_not_say_that_nothing_explains_what_several_do(recording, of_the_toy):
    unexplained = replace(of_the_toy, best=None, unexplained=True)
    _, _, none = page(recording, unexplained)
    _, _, several = page(recording, replace(unexplained, ambiguous=True))
    assert "no known mechanism explains it" in none
    assert "several known mechanisms explain it alike" in several
    assert "no known mechanism explains it" not in several


def test_the_error_of_the_full_model_is_told_as_its_own(recording, of_the_toy):
    """It is another model on other presses: no two numbers stand under one name."""
    one = Resimulation(
        "slow", "held-out", "3D FEM", {"voltage_V": 0.01, "force_N": 0.02}, {"voltage_V": 1.2, "force_N": 0.05},
        {"voltage_V": 0.047, "force_N": 0.013}, {},
    )  # fmt: skip
    told, summary, body = page(recording, of_the_toy, [one])
    together = summary["fit"]["resimulated"][0]["nrmse_after_all_channels"]
    assert together == pytest.approx(np.sqrt((0.047**2 + 0.013**2) / 2.0))
    assert "in the run “slow” (held-out) alone, the error of the full model (3D FEM) is 3.4 % with it" in told
    assert ["slow", "held-out", "all channels", "85 %", "3.4 %", ""] in rows(body)
    assert "It can therefore differ from the error of the fast model on all presses" in body


@for_each("p", [0.0, 1e-320, 1e-17, 1e-9, 0.001, 0.4, 1.0])
def test_no_probability_is_nothing(recording, of_the_toy, p):
    models = tuple(replace(one, probability=p) for one in of_the_toy.models)
    detection = replace(of_the_toy.detection, p_value=p, least_p_value=0.001)
    screened = {("charge-leakage", "readout"): p, ("friction", "dot"): p}
    found = replace(of_the_toy, models=models, best=models[0], detection=detection, screened=screened)
    told, _, body = page(recording, found)
    for text in (told, body):
        assert not re.search(r"p (=|≤) 0(?![.\d])", text)
    assert [row[2] for row in rows(body) if row[:2] == ["friction", "the dot"]] not in ([["0"]], [["−0"]])
    (explained,) = (row for row in rows(body) if row[0].endswith("(named)"))
    assert explained[1] not in ("0", "1")
    if p == 0.001:
        assert "p ≤ 0.001" in body  # as small as the random draws can give


def test_agreement_tells_its_p_value_once_and_alike(recording, of_the_toy):
    quiet = replace(of_the_toy, mismatch=False, best=None, models=(), groups=(), train=None, held_out=None)
    told, _, body = page(recording, replace(quiet, detection=replace(quiet.detection, p_value=0.41234)))
    assert set(re.findall(r"p [=<≤] [\d.]*\d", told + body)) == {"p = 0.41"}


def test_the_separation_of_the_next_press_is_one_number(recording):
    leaks, relaxes = fitted(LEAK, 0.5), fitted(RELAXING, 0.3, 0.09)
    findings = found(recording, (leaks, relaxes), leaks, ((0, 1),))
    told, _, body = page(recording, findings, (), next_presses(recording, ToyEngine(recording), findings))
    assert len(set(re.findall(rf"differ by ({NUMBER}) standard", told + body))) == 1
