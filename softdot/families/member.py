"""The press of one member of a family: its courses at all load steps, and their derivatives by the place in the space.

It stands on the family's one mesh, moved to its sizes by the map along which the derivatives move it too, so that
neighbours differ by their designs and not by their meshes. Where the moved mesh is poor, it has one of its own.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from foundation.arrays import Floats
from foundation.cache import data_hash
from foundation.errors import InputError
from foundation.source_hash import source_hash
from mesh.jacobian import determinants, jacobians, scaled_jacobians
from mesh.morphing import morphed_mesh
from mesh.types import MeshingError, TetMesh, mesh_hash
from softdot.config.hashes import input_hash
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.families.space import FamilySpace
from softdot.prepared_press import PreparedPress
from softdot.sweeps.points import CRASHED, NOT_CONVERGED, REFUSED, SOLVED, Record, failed_record
from solve.result import PressResult
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolveError
from solve.solution.sensitivity import Slopes, Variation, press_with_sensitivities

RELATIVE_STEP = 1e-4
"""Step of the models beside a design, over the value, or over the range where it passes zero."""
LEAST_QUALITY = 0.25
"""Least scaled Jacobian of a moved mesh, over that of the mesh before it was moved."""


class Beside(NamedTuple):
    """The configurations a little below and above a design along one axis, apart by span in places."""

    below: Config
    above: Config
    span: float


@dataclass(frozen=True)
class Member:
    """A design to press: its place (d,), its configuration, and those beside it along each axis."""

    place: tuple[float, ...]
    config: Config
    beside: tuple[Beside, ...]

    def key(self, tet_mesh: TetMesh) -> str:
        """Hash of all that its record depends on: configurations, mesh and program."""
        beside = [[input_hash(one.below), input_hash(one.above), one.span] for one in self.beside]
        return data_hash([source_hash(__name__), input_hash(self.config), beside, mesh_hash(tet_mesh)])


def member_at(space: FamilySpace, place: Sequence[float] | Floats) -> Member:
    """The member at a place. InputError for a design that cannot be built."""
    beside = []
    for number, one in enumerate(space.ranges):
        value, slope = float(one.values(place[number])), float(one.slopes(place[number]))
        step = RELATIVE_STEP * (abs(value) if one.is_log else one.high - one.low) / slope
        ends = [np.array(place, dtype=float) for _ in range(2)]
        ends[0][number] -= step
        ends[1][number] += step
        beside.append(Beside(space.config_at(ends[0]), space.config_at(ends[1]), 2.0 * step))
    return Member(tuple(float(at) for at in place), space.config_at(place), tuple(beside))


def press_member(member: Member, centre: Config, tet_mesh: TetMesh) -> Record:
    """The record of a member: status, reason, seconds; of one that was solved its courses and slopes. Raises nothing.

    centre : the configuration of the mesh. courses : quantity -> (s,) at the load steps, slopes : quantity -> (d, s),
    remeshed : why it has a mesh of its own, else None.
    """
    start = time.perf_counter()
    try:
        found = _record(member, centre, tet_mesh)
    except InputError as error:
        found = failed_record(REFUSED, str(error))
    except (MeshingError, NoEquilibriumError, LinearSolveError) as error:
        found = failed_record(NOT_CONVERGED, str(error))
    except Exception as error:
        found = failed_record(CRASHED, f"{type(error).__name__}: {error}")
    return {**found, "seconds": time.perf_counter() - start}


def _record(member: Member, centre: Config, tet_mesh: TetMesh) -> Record:
    """The record of a member without its time. InputError, MeshingError, NoEquilibriumError, LinearSolveError."""
    prepared = PreparedPress(member.config)
    _ = prepared.checked_design
    own, poor = moved_mesh(tet_mesh, centre, member.config)
    if poor is not None:
        own = prepared.solved_mesh
    varied = {
        str(number): Variation(model_of(one.below), model_of(one.above), one.span)
        for number, one in enumerate(member.beside)
    }
    try:
        result, slopes = press_with_sensitivities(prepared.model, varied, own)
    except ValueError as error:
        raise InputError(str(error)) from None
    if not result.converged:
        return failed_record(NOT_CONVERGED, str(result.failure))
    return {"status": SOLVED, "reason": None, "remeshed": poor, **_numbers(prepared, result, list(slopes.values()))}


def moved_mesh(tet_mesh: TetMesh, centre: Config, config: Config) -> tuple[TetMesh, str | None]:
    """The mesh of a family moved to a member, and why that is too poor to press on, None where it is not."""
    moved = morphed_mesh(tet_mesh, model_of(centre).segment, model_of(config).segment)
    nodes = moved.points_mm[moved.tets]
    if (determinants(jacobians(nodes)) <= 0.0).any():
        return moved, "the moved mesh has inverted elements"
    bulk = moved.region != moved.region_names.index("film")
    before, after = (
        float(scaled_jacobians(points[moved.tets[bulk]]).min()) for points in (tet_mesh.points_mm, moved.points_mm)
    )
    if after < LEAST_QUALITY * before:
        return moved, f"the worst element of the moved mesh has a scaled Jacobian of {after:.2g}, {before:.2g} before"
    return moved, None


def _numbers(prepared: PreparedPress, result: PressResult, slopes: Sequence[Slopes]) -> dict[str, Any]:
    """Courses and slopes at the load steps, in the units of their names."""
    at = np.searchsorted(result.trace.time_s, [step.time_s for step in result.steps])
    steps, along = result.steps, prepared.course(result)
    read = along.together_V
    courses: dict[str, Floats] = {
        "indentation_mm": np.array([1e3 * step.indentation_m for step in steps]),
        "reaction_force_N": np.array([step.reaction_force_N for step in steps]),
        "film_charge_pC": np.array([1e12 * step.film_charge_C.sum() for step in steps]),
        "open_circuit_voltage_V": np.array([step.film_charge_C.sum() for step in steps]) / result.capacitance_F.sum(),
    }
    sloped: dict[str, list[Floats]] = {
        "indentation_mm": [1e3 * one.trace.indentation_m[at] for one in slopes],
        "reaction_force_N": [one.trace.reaction_force_N[at] for one in slopes],
        "film_charge_pC": [1e12 * one.trace.film_charge_C[at].sum(axis=1) for one in slopes],
        "open_circuit_voltage_V": [one.open_circuit_voltage_V[at] for one in slopes],
    }
    if len(result.electrode_names) > 1:
        for number, name in enumerate(result.electrode_names):
            courses[f"charge_pC_{name}"] = np.array([1e12 * step.film_charge_C[number] for step in steps])
            sloped[f"charge_pC_{name}"] = [1e12 * one.trace.film_charge_C[at, number] for one in slopes]
    if read is not None:
        courses["readout_voltage_V"] = read[along.solved]
        sloped["readout_voltage_V"] = [
            np.zeros(len(at)) if one.readout_voltage_V is None else one.readout_voltage_V[at] for one in slopes
        ]
    return {
        "courses": {name: values.tolist() for name, values in courses.items()},
        "slopes": {name: np.array(values).tolist() for name, values in sloped.items()},
        "unknowns": result.unknowns,
    }
