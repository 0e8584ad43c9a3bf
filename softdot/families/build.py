"""The making of a family: presses where they tell most, until those that took no part are answered well enough."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import qmc

from foundation.arrays import Floats
from foundation.cache import check_cache_folder
from foundation.executor import Executor
from mesh.types import TetMesh
from softdot.executors import executor_for
from softdot.families.family import Family, Region
from softdot.families.fit import FORCE, JUDGED, VOLTAGE, expected_error, fit_quantities, held_out_row, next_places
from softdot.families.folder import FAMILY, PAGE, write_family
from softdot.families.presses import FamilyPresses, common_mesh, region, remeshed_warnings
from softdot.families.quantity import FamilyQuantity
from softdot.families.report import write_page
from softdot.families.space import FamilySpace
from softdot.hardware import hardware
from softdot.output import staged_folder
from softdot.progress import Logged, Progress
from softdot.sweeps.points import Record
from softdot.tolerances.accuracy import with_sizes_for_accuracy
from softdot.tolerances.discretisation import (
    SIZE_RATIOS,
    Answers,
    answers_on_larger_elements,
    discretisation_error,
)
from softdot.tolerances.uncertainty import PRESS_ERRORS

CHECKS, BATCH = 4, 2
"""Presses that take no part, each time the accuracy seems to be reached, and presses between two fits."""
LOOKED_AT, CHECKED_DESIGNS = 256, 128
"""Designs among which the next press is chosen, and designs that are looked at for those that cannot be built."""
LEAST_PRESSES = 4
"""Fewest presses of a family."""


class FamilyFailedError(RuntimeError):
    """Too few designs of a family could be pressed; one sentence. The command exits with 3."""


@dataclass(frozen=True)
class Asked:
    """What is asked of a family. accuracy : quantity -> relative error at full load that 95 % of designs stay below.

    most : presses after which it stops. seed : of the designs that are chosen by chance.
    """

    accuracy: Mapping[str, float]
    most: int = 80
    seed: int = 0


def build_family(
    space: FamilySpace, out: Path, asked: Asked, scheduler: str | None = None, progress: Progress | None = None
) -> dict[str, Any]:
    """Press a family into the folder out and return family.json.

    On one process per core, or on the Dask cluster of a scheduler (tcp://HOST:PORT). Presses are kept in the cache, so
    that a stopped command goes on. InputError, MeshingError, FamilyFailedError.
    """
    check_cache_folder()
    told = progress or Logged()
    with staged_folder(out, FAMILY) as folder:
        told.stage("mesh")
        _state_sizes(space)
        tet_mesh = common_mesh(space)
        begun = time.perf_counter()
        with executor_for(scheduler, space.sweep.workers) as executor:
            family = make_family(space, tet_mesh, asked, executor, told)
            family.facts["workers"] = executor.places
        family.facts |= {"scheduler": scheduler, "seconds": time.perf_counter() - begun, "hardware": hardware()}
        told.stage("report")
        summary = write_family(family, folder)
        write_page(folder / PAGE, family, summary)
    return summary


def _state_sizes(space: FamilySpace) -> None:
    """Replace an asked accuracy of the mesh by the element sizes that it means in the middle. InputError."""
    if space.centre.mesh.accuracy_percent is None:
        return
    sized = with_sizes_for_accuracy(space.centre).mesh
    table = {**space.base.get("mesh", {}), **sized.sizes_mm}
    space.base["mesh"] = {key: value for key, value in table.items() if key != "accuracy_percent"}
    space.tables["mesh"] = space.base["mesh"]
    del space.__dict__["centre"]


def make_family(space: FamilySpace, tet_mesh: TetMesh, asked: Asked, executor: Executor, progress: Progress) -> Family:
    """The family itself, without files. FamilyFailedError."""
    presses = FamilyPresses(space, tet_mesh, executor, progress, asked.most)
    progress.stage("press")
    presses.refuse_unbuildable(space.drawn_places(CHECKED_DESIGNS, asked.seed + 1))
    presses.press(_start(space, presses, asked))
    if len(presses.records) < LEAST_PRESSES:
        reason = presses.reasons[-1] if presses.reasons else "there were too few"
        raise FamilyFailedError(f"{len(presses.records)} of {presses.count} designs could be pressed: {reason}")
    quantities, held_out, reached = _refine(space, presses, asked)
    facts = {
        "asked_percent": {name: 100.0 * asked.accuracy[name] for name in JUDGED},
        "reached": reached,
        "expected_error_percent": _expected_percent(space, quantities),
        "presses": {"solved": len(presses.records), "now": presses.pressed, "from_cache": presses.recalled},
        "held_out": held_out,
        "left_out": region(space, presses.refused, presses.reasons),
        "discretisation_error_percent": _mesh_error(space, presses.records[0]),
        "unknowns": presses.records[0]["unknowns"],
        "warnings": _warnings(space, presses, reached),
    }
    region_of = Region(presses.good, np.array(presses.refused).reshape(-1, space.count), tuple(presses.reasons))
    return Family(space, quantities, region_of, facts)


def _start(space: FamilySpace, presses: FamilyPresses, asked: Asked) -> list[Floats]:
    """The first places: the middle, and designs that fill the space, without those near one that cannot be built."""
    count = space.count + 3
    sampler = qmc.LatinHypercube(space.count, seed=np.random.default_rng(asked.seed), optimization="random-cd")
    return [np.zeros(space.count), *presses.possible(2.0 * sampler.random(count) - 1.0)]


def _refine(
    space: FamilySpace, presses: FamilyPresses, asked: Asked
) -> tuple[dict[str, FamilyQuantity], list[dict[str, Any]], bool]:
    """Press on until presses that took no part are answered as asked, or most are done.

    The quantities of all presses, the rows of the last ones that took no part, and whether the accuracy is reached.
    """
    drawn = space.drawn_places(LOOKED_AT, asked.seed + 2)
    random = np.random.default_rng(asked.seed + 3)
    quantities = fit_quantities(np.array(presses.places), presses.records, names=JUDGED)
    rows: list[dict[str, Any]] = []
    good = confirmed = False
    while True:
        candidates = presses.possible(drawn)
        room = asked.most - presses.count
        good = all(expected_error(quantities[name], candidates) <= asked.accuracy[name] for name in JUDGED)
        if (good and confirmed) or room <= 0 or not len(candidates):
            break
        if not confirmed and (good or room <= CHECKS):
            checks = candidates[random.choice(len(candidates), min(CHECKS, room, len(candidates)), replace=False)]
            solved = presses.press(list(checks), joins=False)
            rows = [_row(space, quantities, place, record) for place, record in solved]
            confirmed = bool(rows) and all(_is_met(row, asked) for row in rows)
            presses.join(solved)
        else:
            presses.press(list(next_places(quantities, asked.accuracy, candidates, min(BATCH, room))))
        quantities = fit_quantities(np.array(presses.places), presses.records, quantities, JUDGED)
    return fit_quantities(np.array(presses.places), presses.records, quantities), rows, good and confirmed


def _is_met(row: Mapping[str, Any], asked: Asked) -> bool:
    """Whether a press that took no part is answered as accurately as asked."""
    return all(row[name]["error_percent"] <= 100.0 * asked.accuracy[name] for name in JUDGED)


def _row(space: FamilySpace, quantities: Mapping[str, FamilyQuantity], place: Floats, record: Record) -> dict[str, Any]:
    """The row of a press that took no part, with the values of its keys."""
    values = {one.keys[0]: float(one.values(at)) for one, at in zip(space.ranges, place, strict=True)}
    return {"values": values, **held_out_row(quantities, place, record)}


def _expected_percent(space: FamilySpace, quantities: Mapping[str, FamilyQuantity]) -> dict[str, float]:
    """Error in percent that 95 % of the designs are expected to stay below."""
    places = space.drawn_places(LOOKED_AT, 0)
    return {name: 100.0 * expected_error(quantities[name], places) for name in JUDGED}


def _mesh_error(space: FamilySpace, middle: Record) -> dict[str, float] | None:
    """The discretisation error of the first press, that of the middle, in percent; None where it was not to be had."""
    courses = {name: np.array(middle["courses"][name])[1:] for name in JUDGED}
    fine = Answers(courses[FORCE], courses[VOLTAGE], courses[VOLTAGE][:, None])
    if not fine.force_N.all() or not fine.voltage_V.all():
        return None
    try:
        larger = {ratio: answers_on_larger_elements(space.centre, ratio) for ratio in SIZE_RATIOS}
    except PRESS_ERRORS:
        return None
    error = discretisation_error(fine, larger)
    return {FORCE: error.force_percent, VOLTAGE: error.voltage_percent}


def _warnings(space: FamilySpace, presses: FamilyPresses, reached: bool) -> list[str]:
    """What a user has to know: an accuracy that was not reached, regions left out, meshes of their own."""
    told = [] if reached else [f"the asked accuracy is not shown to be reached after {presses.count} presses"]
    for one in region(space, presses.refused, presses.reasons):
        ends = ", ".join(f"{key} {low:.4g} to {high:.4g}" for key, (low, high) in one["between"].items())
        told.append(f"left out, {one['designs']} designs with {ends}: {one['reason']}")
    return [*told, *remeshed_warnings(space, presses)]
