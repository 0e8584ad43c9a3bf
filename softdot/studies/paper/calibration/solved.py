"""The presses behind p: the assumed rig and one change at a time, in cross-section and in three dimensions."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from foundation.executor import Executor
from softdot.config.schema import Config
from softdot.progress import Progress
from softdot.studies.paper.calibration.inputs import INPUTS, Values, assumed_inputs
from softdot.studies.paper.calibration.press_curve import PressCurve
from softdot.studies.paper.calibration.response import RigResponse
from softdot.studies.paper.calibration.rig import (
    CASES,
    TABLE_SPONGE_MPA,
    RigCase,
    Section,
    constant_sponge,
    foam,
    rig_config,
)
from softdot.studies.paper.presses import NotSolvedError
from solve.mechanisms.boundaries.adhesive_compliance import ADHESIVE_COMPLIANCE

SIMULATED, ROUND, FOAM = "cross-section", "round dot", "round dot on foam"
MODELS = (SIMULATED, ROUND, FOAM)
"""From what the paper simulated to what it built."""
VARIED = {
    SIMULATED: {"dot_radius_mm": (1.2,), "poisson_ratio": (0.0, 0.45, 0.495)},
    ROUND: {"dot_radius_mm": (1.2,), "poisson_ratio": (0.0, 0.495)},
    FOAM: {"dot_radius_mm": (1.2,), "foam_exponent": (8.0, 20.0), "foam_poisson_ratio": (0.3,)},
}
"""Model -> input -> values at which it is pressed too, beside the assumed one."""
GLUE = tuple(
    {
        "name": ADHESIVE_COMPLIANCE.name,
        "component": bond,
        "parameters": {"thickness_um": 30.0, "youngs_modulus_MPa": 0.3},
    }
    for bond in ("bond-medium1-film", "bond-film-medium2")
)
"""Spray glue on both faces of the film."""


class Name(NamedTuple):
    """Which press: case of Table 1, model, what is changed and to what."""

    case: str
    model: str
    change: str = "nothing"
    value: float = 0.0


@dataclass(frozen=True)
class Solved:
    """Presses of one case."""

    case: RigCase
    curves: Mapping[str, PressCurve]
    """Model -> press with the assumed inputs."""
    responses: Mapping[str, Mapping[str, RigResponse]]
    """Model -> input -> how it changes force and voltage."""
    finer: Mapping[str, PressCurve]
    """SIMULATED and ROUND on finer meshes."""
    glued: PressCurve
    """SIMULATED with glue on both faces of the film."""
    soft: PressCurve
    """SIMULATED with the sponge of Table 1, ten times softer than that of the text."""
    unknowns: Mapping[str, int]
    stopped_mm: Mapping[str, float]
    """Presses that ended before full depth: name -> the last depth that converged."""

    def curve(self, model: str, values: Values) -> PressCurve:
        """The press of a model at given inputs: each changes the assumed one by a factor of its own."""
        factors = np.array([response.at(values[name]) for name, response in self.responses[model].items()])
        force, voltage = factors.prod(axis=0)
        return self.curves[model].scale(force, voltage)


Rig = Mapping[str, Solved]
"""Case of Table 1 -> its presses."""


def solve_rig(progress: Progress, executor: Executor) -> dict[str, Solved]:
    """Case -> its presses, as far as they are not remembered. NotSolvedError."""
    from softdot.sweeps.points import solve_points

    configs = dict(_configs())
    records = dict(zip(configs, solve_points(list(configs.values()), progress, executor=executor), strict=True))
    return {name: _solved_case(case, records) for name, case in CASES.items()}


def _configs() -> Iterator[tuple[Name, Config]]:
    """Configurations of every press, the long ones first, so that no core waits at the end."""
    for model in (ROUND, FOAM, SIMULATED):
        for name, case in CASES.items():
            if model != FOAM:
                yield Name(name, model, "finer"), _config(case, model, assumed_inputs(), finer=True)
            yield Name(name, model), _config(case, model, assumed_inputs())
            for entry, changed in VARIED[model].items():
                for value in changed:
                    yield Name(name, model, entry, value), _config(case, model, assumed_inputs(**{entry: value}))
    for name, case in CASES.items():
        values = assumed_inputs()
        yield Name(name, SIMULATED, "glue"), _config(case, SIMULATED, values, mechanisms=GLUE)
        sponge, radius = constant_sponge(values["poisson_ratio"], TABLE_SPONGE_MPA), values["dot_radius_mm"]
        yield Name(name, SIMULATED, "soft"), rig_config(case, "plane-strain", sponge, radius)


def _config(case: RigCase, model: str, values: Values, **changes: Any) -> Config:
    section: Section = "plane-strain" if model == SIMULATED else "solid"
    constant = constant_sponge(values["poisson_ratio"])
    sponge = foam(values["foam_exponent"], values["foam_poisson_ratio"]) if model == FOAM else constant
    return rig_config(case, section, sponge, values["dot_radius_mm"], **changes)


def _solved_case(case: RigCase, records: Mapping[Name, Mapping[str, Any]]) -> Solved:
    own = {name: record for name, record in records.items() if name.case == case.name}
    curves = {name: _curve(name, record) for name, record in own.items()}

    def of(model: str, change: str = "nothing") -> PressCurve:
        return curves[Name(case.name, model, change)]

    return Solved(
        case,
        {model: of(model) for model in MODELS},
        {model: _responses(case, model, curves) for model in MODELS},
        {model: of(model, "finer") for model in (SIMULATED, ROUND)},
        of(SIMULATED, "glue"),
        of(SIMULATED, "soft"),
        {model: own[Name(case.name, model)]["mesh"]["unknowns"] for model in MODELS},
        {_text(name): float(curves[name].depth_mm[-1]) for name in own if own[name]["status"] != "solved"},
    )


def _responses(case: RigCase, model: str, curves: Mapping[Name, PressCurve]) -> dict[str, RigResponse]:
    found = {}
    for entry, values in VARIED[model].items():
        at = {INPUTS[entry].assumed: curves[Name(case.name, model)]}
        at |= {value: curves[Name(case.name, model, entry, value)] for value in values}
        found[entry] = _response(case.depth_mm, at, INPUTS[entry].assumed)
    return found


def _response(depth_mm: float, at: Mapping[float, PressCurve], reference: float) -> RigResponse:
    """Response from the presses at the values of one input, relative to those at the reference value."""
    order = sorted(at)
    reached = np.array([[at[value].force_at(depth_mm), at[value].voltage_at(depth_mm)] for value in order])
    return RigResponse(np.array(order), reached / reached[order.index(reference)])


def _curve(name: Name, record: Mapping[str, Any]) -> PressCurve:
    """The press of a record; one that stopped early may do, if it got half-way. NotSolvedError."""
    depth = record.get("indentation_mm") or [0.0]
    if record["status"] != "solved" and depth[-1] < 0.5 * CASES[name.case].depth_mm:
        raise NotSolvedError(f"calibration rig, {_text(name)}: {record['status']}, {record['reason']}")
    return PressCurve(
        np.array(depth),
        np.array(record["reaction_force_N"]),
        np.array(record["open_circuit_voltage_V"]),
        record["film"]["capacitance_pF"],
    )


def _text(name: Name) -> str:
    change = "" if name.change == "nothing" else f", {name.change} {name.value:g}"
    return f"case {name.case}, {name.model}{change}"
