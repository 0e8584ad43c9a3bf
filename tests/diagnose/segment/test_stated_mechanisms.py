"""What rig.toml states acts as the same physics does that a diagnosis found, so that improved.toml is believed."""

import tomllib
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import tomlkit

from diagnose.engines.segment import kept_answers as recent
from diagnose.engines.segment.response import mechanics
from diagnose.forward import Setting
from diagnose.inference.diagnose import diagnose
from diagnose.signals.recording import Recording
from softdot.config.loading import config_from
from softdot.config.rig import RIG_FILE, Bench, Rig
from softdot.diagnosis.engine import engine_for
from softdot.diagnosis.improved import improved_text
from tests.diagnose.segment import rigs

pytestmark = pytest.mark.press

TABLES = {
    **rigs.TABLES,
    "mesh": {"element_size_mm": 0.9, "contact_element_size_mm": 0.35},
    "readout": {"input_resistance_MOhm": 1000.0, "input_capacitance_pF": 100.0},
}


def runs():
    """Two presses behind the amplifier of TABLES, of other depths and speeds."""
    shallow = rigs.press(np.arange(0.0, 1.6, 0.002), depth_mm=0.15, rise_s=0.1, hold_s=0.6)
    return rigs.run(label="deep"), rigs.run(values=shallow, label="shallow")


def rig(folder, tables):
    (folder / RIG_FILE).write_text(tomlkit.dumps(tables), "utf-8")
    return Rig(folder, tables, config_from(tables), Bench(), Recording(runs()))


def improved(folder, of, setting):
    """The engine of the rig that improved.toml describes once this setting was named."""
    named = SimpleNamespace(best=SimpleNamespace(settings=(setting,)))
    tables = tomllib.loads(improved_text(rig(folder, TABLES), of, named))
    del tables["press"]
    return engine_for(rig(folder, tables), rigs.silent)


@pytest.fixture(scope="module", autouse=True)
def _elastic():
    """Nothing here is about what layers remember."""
    with rigs.without_memory():
        yield


@pytest.fixture(scope="module")
def believed(tmp_path_factory):
    """The engine of the rig without any of it."""
    return engine_for(rig(tmp_path_factory.mktemp("believed"), TABLES), rigs.silent)


STATED = {
    "a leak": ("charge-leakage", "readout"),
    "the capacitance of a cable": ("parasitic-capacitance", "readout"),
    "a low-pass": ("low-pass", "readout"),
    "friction": ("friction", "dot"),
    "a medium that softens": ("stress-softening", "medium2"),
}


@pytest.mark.parametrize(("mechanism", "component"), STATED.values(), ids=STATED)
def test_what_was_found_and_what_is_stated_give_the_same_signals(believed, tmp_path, mechanism, component):
    """At a value that was pressed, so that nothing is interpolated."""
    chosen = rigs.candidate(believed, mechanism, component)
    believed.prepare([chosen], rigs.silent)
    values = [one.nodes[-1] if one.nodes else one.starts[0] for one in chosen.coordinates]
    if chosen.together == "fading":  # pressed with the first alone too, and faintest at the ends of the others
        values[1:] = [0.0] * (len(values) - 1)
    found = Setting(chosen, tuple(values))
    stated = improved(tmp_path, believed, found)
    for number in range(2):
        without, one, other = (of.predict(number, on) for of, on in ((believed, []), (believed, [found]), (stated, [])))
        for name, signal in one.items():
            assert np.abs(other[name] - signal).max() < 1e-4 * np.abs(signal).max()
        assert any(np.abs(one[name] - without[name]).max() > 0.02 * np.abs(without[name]).max() for name in one)


def test_what_is_stated_is_no_candidate_too(tmp_path):
    tables = {**TABLES, "mechanisms": [{"name": "friction", "component": "dot", "parameters": {"coefficient": 0.5}}]}
    stated = engine_for(rig(tmp_path, tables), rigs.silent)
    assert not any(candidate.mechanism == "friction" for candidate in stated.candidates)


def test_a_drive_is_followed_once_where_only_what_stands_behind_the_film_changes(believed, monkeypatch):
    followed = []
    monkeypatch.setattr(recent, "mechanics", lambda *given: followed.append(given) or mechanics(*given))
    leak, gap = (rigs.candidate(believed, *name) for name in (("charge-leakage", "readout"), ("contact-gap", "dot")))
    believed.prepare([gap], rigs.silent)
    signals = [believed.predict(0, [Setting(leak, (value,))])["voltage_V"] for value in (0.3, 0.6, 0.9)]
    assert not np.allclose(signals[0], signals[2])
    assert len(followed) <= 1  # or none, where an earlier test followed it
    followed.clear()
    believed.predict(0, [Setting(leak, (0.3,)), Setting(gap, (0.02,))])
    assert len(followed) == 1


def humming(believed, hum_V):
    """What the rig records with hum of another phase in each run, and white noise."""
    random, found = np.random.default_rng(7), []
    sigma = {name: 0.01 * np.abs(signal).max() for name, signal in believed.predict(0, []).items()}
    for number, one in enumerate(runs()):
        signals = believed.predict(number, [])
        shown = {name: s + sigma[name] * random.standard_normal(len(s)) for name, s in signals.items()}
        shown["voltage_V"] += hum_V * np.sin(2.0 * np.pi * (50.0 * one.time_s + random.random()))
        found.append(replace(one, channels={**one.channels, **shown}))
    return Recording(tuple(found))


def test_hum_that_is_stated_is_no_mismatch_whatever_its_phase(believed, tmp_path):
    hum_V = 0.05 * np.abs(believed.predict(0, [])["voltage_V"]).max()
    recording = humming(believed, hum_V)
    stated = {"name": "mains-hum", "component": "readout", "parameters": {"amplitude_V": float(hum_V)}}
    for tables, mismatch in ((TABLES, True), ({**TABLES, "mechanisms": [stated]}, False)):
        told = engine_for(replace(rig(tmp_path, tables), recording=recording), rigs.silent)
        hums = tuple(one for one in told.candidates if one.mechanism == "mains-hum")
        assert len(hums) == mismatch
        assert diagnose(recording, told.with_candidates(hums), 1, rigs.silent).mismatch == mismatch
