"""Make a reduced model from presses of the 3D model with memories that do not fade.

One elastic press in ELASTIC_NODES_FACTOR times as many steps; for each layer that may relax, presses with the memory of
a hold at full depth, as it begins and as it ends, with half of that, and with the memory of a hold midway; for each
pair of layers a press with the memories of both: 1 + 4 k + k (k - 1) / 2 presses for k layers.
Prony series, rig and circuit come in only when the model is asked, so that they can be changed freely.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations

import numpy as np

from foundation.arrays import Floats
from geometry.dot import DotShape
from geometry.parameters import Dot, Segment
from mesh.types import TetMesh
from solve.materials.parameters import Material, PiezoelectricFilm
from solve.model import Model, Press
from solve.physics import Physics
from solve.reduced.accuracy import measure_accuracy
from solve.reduced.cache import model_key, recall_or_make
from solve.reduced.fit import ELASTIC_NODES_FACTOR, fit
from solve.reduced.frozen_memory import Frozen
from solve.reduced.model import ReducedModel, structure_key
from solve.reduced.response import Accuracy
from solve.reduced.rig import unknown_of_segment
from solve.reduced.sampling import Sample, SampledPress, Sampler
from solve.reduced.task import ReductionTask
from solve.setup import discretise
from solve.solution.similar_press import weighted_sum

DEPTH_NODES = 16
UNKNOWN = Accuracy(np.inf, np.inf, np.inf)


def build_reduced(
    segment: Segment,
    materials: Mapping[str, Material],
    dot: DotShape,
    tet_mesh: TetMesh,
    depth_mm: float,
    relaxing: Mapping[str, float] | None = None,
    physics: Physics | None = None,
    depth_nodes: int = DEPTH_NODES,
    check: bool = True,
    cache: bool = True,
) -> ReducedModel:
    """A reduced model down to depth_mm. materials : layer -> material.

    relaxing : layer or compliant bond -> largest sum of its relative moduli, between 0 and 1. physics : its bonds,
    delaminations, prestretch and elastic terms are built in, the rest is given when the model is asked.
    depth_nodes : states sampled on the way down. check : measure the error on 3D presses kept out of the fit; without
    it the bound is infinite. cache : keep the model on disk by what it depends on. ValueError with one sentence for
    what it cannot describe; NoEquilibriumError where the 3D model has no answer.
    """
    asked = ReductionTask(
        segment, materials, dot, tet_mesh, depth_mm, dict(relaxing or {}), physics or Physics(), depth_nodes
    )
    if cache:
        return recall_or_build(asked, check)
    _refuse_unsupported(asked)
    return _build(asked, check)


def recall_or_build(asked: ReductionTask, check: bool = True) -> ReducedModel:
    """The reduced model of a task from the disk, else as build_reduced makes it, which is then kept."""
    _refuse_unsupported(asked)
    return recall_or_make(model_key(asked, check), lambda: _build(asked, check))


def keep_model(asked: ReductionTask, check: bool, made: ReducedModel) -> None:
    """Keep on disk a model that was made elsewhere."""
    recall_or_make(model_key(asked, check), lambda: made)


def _refuse_unsupported(case: ReductionTask) -> None:
    """ValueError for what the reduction does not describe."""
    film = case.materials["film"]
    if isinstance(film, PiezoelectricFilm) and film.coupling == "two-way":
        raise ValueError("coupling = 'two-way': the reduced model needs a film whose voltage does not act back")
    if unknown := unknown_of_segment(case.physics):
        raise ValueError(f"{', '.join(unknown)}: what depends on the path needs the full solver")
    if case.relaxing and case.physics.prestretch != (0.0, 0.0):
        raise ValueError("a prestretched film with relaxing layers needs the full solver")
    for layer, share in case.relaxing.items():
        if not 0.0 < share < 1.0:
            raise ValueError(f"relaxing: {layer} = {share:g}, must lie between 0 and 1")
    if not case.depth_mm > 0.0:
        raise ValueError(f"depth_mm = {case.depth_mm:g}: must be above 0")


def _build(case: ReductionTask, check: bool) -> ReducedModel:
    layers = tuple(case.relaxing)
    sampler = _sampler(case, layers)
    samples = list(_samples(sampler, case.relaxing))
    sampler.close()
    film = case.materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    recorder = sampler.recorder
    area = recorder.electrode_area_m2
    electrodes = np.column_stack([recorder.capacitance_F, area])
    model = ReducedModel(
        fit(samples, layers), case.depth_mm, case.relaxing, electrodes, film.pyroelectric_uC_per_m2_K,
        structure_key(case.physics), UNKNOWN,
    )  # fmt: skip
    if not check:
        return model
    told = (case.segment, case.materials, case.dot, case.tet_mesh, case.physics)
    return replace(model, accuracy=measure_accuracy(model, *told))


def _sampler(case: ReductionTask, layers: tuple[str, ...]) -> Sampler:
    physics = replace(case.physics.structure, inelastic={layer: (Frozen(layer=layer),) for layer in layers})
    press = Press(indentation_mm=case.depth_mm)
    model = Model(case.segment, case.materials, Dot(), press, None, physics)
    return Sampler(discretise(model, case.tet_mesh, case.dot), layers, case.depth_nodes)


def _samples(sampler: Sampler, relaxing: Mapping[str, float]) -> Iterator[Sample]:
    """Press the samples of a reduced model, the elastic press first.

    The memory of a long hold is the share times the elastic stress that goes with that memory: one step of the fixed
    point is taken.
    """
    elastic = sampler.press({}, ELASTIC_NODES_FACTOR)
    yield elastic.sample
    fields, plain = elastic.fields, elastic.course
    middle = round(len(fields) * 0.6)
    held: dict[str, SampledPress] = {}
    memories: dict[str, Floats] = {}
    for layer, share in relaxing.items():
        first = sampler.press({layer: share * fields[-1][layer]}, near=plain)
        memories[layer] = share * first.fields[-1][layer]
        held[layer] = sampler.press({layer: memories[layer]}, near=first.course)
        halfway = weighted_sum((0.5, held[layer].course), (0.5, plain))
        yield from (first.sample, held[layer].sample)
        for memory in (0.5 * memories[layer], share * fields[middle][layer]):
            yield sampler.press({layer: memory}, near=halfway).sample
    for one, other in combinations(relaxing, 2):  # to first order their answers add up
        near = weighted_sum((1.0, held[one].course), (1.0, held[other].course), (-1.0, plain))
        yield sampler.press({one: memories[one], other: memories[other]}, near=near).sample
