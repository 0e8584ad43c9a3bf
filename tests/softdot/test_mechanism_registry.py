"""A mechanism is one module that others ask by its traits: one more needs no other file to change."""

import ast
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
from pydantic import Field

from diagnose.forward import Candidate, Coordinate
from diagnose.vocabulary import base as vocabulary
from diagnose.vocabulary.base import Vocabulary
from examples.recordings import leaky_amplifier
from geometry.parameters import NonNegative
from softdot import derivatives, run_config
from softdot.config.loading import config_from
from softdot.diagnosis import folder as command
from softdot.outcome import outcome
from solve.mechanisms import MECHANISMS, register
from solve.mechanisms.base import MechanismType, Parameters, Traits, with_physics
from solve.readout.stages import INPUT

ROOT = Path(__file__).parents[2]
NAME = "quadratic-capacitance"
K_PER_V2 = 1e-3


@dataclass(frozen=True)
class QuadraticInput:
    """An input whose capacitance grows with the voltage, C (1 + k V^2): a charge q = C V0 shows V (1 + k V^2) = V0."""

    k_per_V2: float
    place: ClassVar[int] = INPUT

    def apply(self, time_s, voltage_V):
        found = np.asarray(voltage_V, dtype=float).copy()
        for _ in range(60):
            found -= (found * (1 + self.k_per_V2 * found**2) - voltage_V) / (1 + 3 * self.k_per_V2 * found**2)
        return found

    def largest_gain(self):
        return 1.0


class QuadraticCapacitance(Parameters):
    """An input whose capacitance grows with the square of the voltage."""

    k_per_V2: NonNegative = Field(description="relative growth per square of the voltage")


def switch_on(model, component, values):  # noqa: ARG001 - as all are called
    return with_physics(model, stages=(*model.physics.stages, QuadraticInput(values.k_per_V2)))


def of_segment(scene):
    scale = 1.0 / scene.voltage_V**2
    coordinate = Coordinate("k", 0.0, 20.0, (0.1, 1.0))
    yield Candidate(
        NAME, "readout", (coordinate,), lambda values: {"k_per_V2": scale * values[0]}, units={"k_per_V2": "1/V2"}
    )


@pytest.fixture
def registered():
    """The mechanism, known as long as a test lasts."""
    kind = register(
        MechanismType(
            NAME, ("readout",), QuadraticCapacitance, switch_on, {"k_per_V2": 0.0},
            traits=Traits(electrical=True, acts_on_tables=True),
        )
    )  # fmt: skip
    vocabulary.vocabulary()
    vocabulary.register(Vocabulary(kind, "the capacitance of {} grows with the voltage", of_segment))
    yield
    del MECHANISMS[NAME], vocabulary.VOCABULARY[NAME]


TABLES = {
    "segment": {
        "section": "plane-strain", "boundary": "free", "width_mm": 16.0,
        "medium1": {"thickness_mm": 0.5, "material": "vnr"}, "film": {"thickness_um": 28.0},
        "medium2": {"thickness_mm": 2.0, "material": "vnr-soft"},
    },
    "dot": {"shape": "ridge", "radius_mm": 1.15},
    "press": {"indentation_mm": 0.1, "load_steps": 2},
    "mesh": {"element_size_mm": 0.6, "contact_element_size_mm": 0.2, "mesher": "layered"},
    "readout": {},
}  # fmt: skip


def with_k(k_per_V2):
    return config_from({**TABLES, "mechanisms": [on(k_per_V2)]})


def on(k_per_V2):
    return {"name": NAME, "component": "readout", "parameters": {"k_per_V2": k_per_V2}}


@pytest.mark.process
@pytest.mark.usefixtures("registered")
def test_it_runs_and_its_off_value_changes_nothing(tmp_path):
    """V (1 + k V^2) is the voltage without it."""
    plain = outcome(config_from(TABLES))["readout_voltage_V"]
    assert outcome(with_k(0.0))["readout_voltage_V"] == plain
    found = np.array(run_config(with_k(0.5), tmp_path / "on")["readout_voltage_V"])
    np.testing.assert_allclose(found * (1 + 0.5 * found**2), plain, rtol=1e-9)
    assert found[-1] < 0.9 * plain[-1]


@pytest.mark.process
@pytest.mark.usefixtures("registered")
def test_it_has_derivatives():
    """dV/dk = -V^3 / (1 + 3 k V^2) at the amplifier, and nothing changes before it."""
    (slope,) = derivatives(with_k(0.5), ["mechanisms[0].parameters.k_per_V2"])
    below, above = (readout_voltage_V(with_k(k)) for k in (0.49, 0.51))
    assert slope.readout_voltage_V[-1] == pytest.approx((above - below) / 0.02, rel=1e-3)
    assert np.all(slope.reaction_force_N == 0.0)
    assert np.all(slope.open_circuit_voltage_V == 0.0)


def readout_voltage_V(config):
    return outcome(config)["readout_voltage_V"][-1]


@pytest.mark.evidence
@pytest.mark.usefixtures("registered")
def test_a_diagnosis_names_it(tmp_path, monkeypatch):
    """A recording of an amplifier that does not leak, whose input grows; among the candidates of the amplifier."""
    monkeypatch.setattr(leaky_amplifier, "LEAK_MOHM", 1e12)
    leaky_amplifier.make(tmp_path / "recording")
    for path in (tmp_path / "recording").glob("press-*.csv"):
        head = path.read_text(encoding="utf-8").split("\n")[0]
        samples = np.loadtxt(path, delimiter=",", skiprows=1)
        column = head.split(",").index("voltage_V")
        samples[:, column] = QuadraticInput(K_PER_V2).apply(samples[:, 0], samples[:, column])
        np.savetxt(path, samples, "%.9g", ",", header=head, comments="")
    engine_for = command.engine_for

    def of_the_amplifier(rig, report, executor):
        engine = engine_for(rig, report, executor)
        engine.candidates = tuple(one for one in engine.candidates if one.component == "readout")
        return engine

    monkeypatch.setattr(command, "engine_for", of_the_amplifier)
    verdict = command.run_diagnosis(tmp_path / "recording", tmp_path / "out", command.Options(full_model_s=0.0))
    (missing,) = verdict["missing_physics"]
    assert (missing["mechanism"], missing["component"]) == (NAME, "readout")
    found = missing["parameters"]["k_per_V2"]
    assert found["low"] <= K_PER_V2 <= found["high"]
    assert found["high"] < 1.5 * found["low"]
    assert any("the capacitance of the amplifier grows with the voltage" in said for said in verdict["summary"])


@pytest.mark.process
def test_a_name_stands_in_no_product_module_but_its_own_two_and_the_hidden_worlds():
    """Texts and docstrings may speak of friction; no string is the name."""
    found = {name: set() for name in MECHANISMS}
    for package in ("foundation", "geometry", "mesh", "solve", "export", "diagnose", "softdot"):
        for path in (ROOT / package).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                if isinstance(node, ast.Constant) and node.value in found:
                    found[node.value].add(path.relative_to(ROOT).as_posix())
    for name, places in found.items():
        own = name.replace("-", "_") + ".py"
        users = (
            "softdot/studies/proof/",
            "softdot/verify/problems/",
        )  # the second world, and designs that use it as a user does
        strange = [place for place in places if not place.endswith(own) and not place.startswith(users)]
        assert strange == [], name
