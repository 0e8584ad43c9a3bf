"""Presses of the 3D model with memories that do not fade: the samples of which the reduced model is made."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from foundation.arrays import Floats
from solve.reduced.frozen_memory import Frozen
from solve.reduced.stress_metric import StressMetric
from solve.setup import Setup
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolver
from solve.solution.march import rest_state
from solve.solution.newton import equilibrate
from solve.solution.schedule import Target
from solve.solution.similar_press import Course, reach
from solve.system import Load, State
from solve.terms.base import History, Term

CROWDING = 1.5  # exponent of the depth nodes: closer together near touch, where the force bends most


def depth_shares(nodes: int) -> Floats:
    """Shares (n + 1,) of the way from touch to full depth at which a sample is taken."""
    return np.asarray(np.linspace(0.0, 1.0, nodes + 1) ** CROWDING)


@dataclass(frozen=True)
class Sample:
    """One press from touch to full depth with a frozen memory.

    touch_mm : depth of the first touch; outputs (n, 2 + e): force in N, contact area in m2, charges in C;
    stress : layer -> coordinates of its elastic stress, (n,) arrays of growing length; memory : layer -> coordinates.
    """

    touch_mm: float
    outputs: Floats
    stress: Mapping[str, list[Floats]]
    memory: Mapping[str, Floats]


Fields = dict[str, Floats]  # layer -> stress at its quadrature points (n, 6), of a bond its jump (n, 4)


@dataclass(frozen=True)
class SampledPress:
    """A sample; at every depth node the elastic stress, and the unknowns."""

    sample: Sample
    fields: list[Fields]
    course: Course


class Sampler:
    """Presses one segment over and over; the elastic press comes first."""

    def __init__(self, setup: Setup, layers: tuple[str, ...], nodes: int) -> None:
        self.setup, self.system, self.recorder = setup, setup.system, setup.recorder
        self.nodes = nodes
        self.linear = LinearSolver(self.system.factorisation_shift)
        self.terms = {layer: _term(setup, layer) for layer in layers}
        start = Target(0.0, Load((0.0, 0.0), 0.0), True)
        self.rest = rest_state(self.system, self.linear, start)
        self.recorder.start(self.rest)
        self.force_scale = self.rest.force_scale
        self.metric: StressMetric | None = None

    def close(self) -> None:
        """Give the solvers' memory back."""
        self.linear.close()
        if self.metric is not None:
            self.metric.close()

    def press(self, memory: Fields, finer: int = 1, near: Course | None = None) -> SampledPress:
        """Press with overstress fields. NoEquilibriumError.

        finer : factor of the number of depth nodes. near : a similar press, to start from.
        """
        state, touch = self._lifted_state(memory)
        full, shares = self.setup.full_drive, depth_shares(finer * self.nodes)
        past, outputs, fields, found = [state], [self._outputs(state)], [self._elastic_fields(state)], [(0.0, state.x)]
        for share in shares[1:]:
            drive = float(touch + share * (full - touch))
            target = Target(past[-1].time + 1.0, Load((0.0, 0.0), drive), False)
            guess = near.guess(found, share) if near is not None else None
            failure = reach(self.system, self.linear, past, target, False, guess)
            if failure is not None:
                raise NoEquilibriumError(f"a press for the reduced model stopped: {failure}", past[-1].x, None)
            outputs.append(self._outputs(past[-1]))
            fields.append(self._elastic_fields(past[-1]))
            found.append((share, past[-1].x))
        if self.metric is None:
            self.metric = StressMetric(self.system, past[-1], self.terms)
        self.force_scale = max(self.force_scale, past[-1].force_scale)
        measure = self.metric.coordinates
        stress = {name: [measure(name, now[name]) for now in fields] for name in self.terms}
        remembered = {name: measure(name, field) for name, field in memory.items()}
        sample = Sample(1e3 * self.system.units.length * touch, np.array(outputs), stress, remembered)
        return SampledPress(sample, fields, Course.of(found))

    def _lifted_state(self, memory: Fields) -> tuple[State, float]:
        """The segment clear of the dot, with these memories, and the approach at which they touch."""
        pairs = zip(self.system.terms, self.rest.histories, strict=True)
        histories = tuple(self._remember(term, history, memory) for term, history in pairs)
        full = self.setup.full_drive
        lifted = Load((0.0, 0.0), -full)
        start = replace(self.rest, load=lifted, histories=histories, force_scale=self.force_scale, time=-1.0)
        state = equilibrate(self.system, self.linear, start.x, lifted, 0.0, start) if memory else start
        touch = float(brentq(lambda drive: self._smallest_gap(state, drive), -full, full, xtol=1e-12))
        return replace(state, load=Load((0.0, 0.0), touch), time=0.0), touch

    def _remember(self, term: Term, history: History, memory: Fields) -> History:
        """The history of a term that holds a memory."""
        name = next((name for name, own in self.terms.items() if own is term), None)
        if name is None:
            return history
        elastic = self._elastic_fields(self.rest)[name]
        return ((elastic, memory.get(name, np.zeros_like(elastic))),)

    def _smallest_gap(self, state: State, drive: float) -> float:
        """Smallest distance, a mean over a node's surroundings, to the dot at an approach."""
        contact = self.system.contact
        gap = contact.weighted_gap(self.system.displacement(state.x), np.array([0.0, 0.0, -drive]))
        return float((gap / contact.nodal_area).min())

    def _outputs(self, state: State) -> Floats:
        """Force in N, contact area in m2 and charges in C of a state, (2 + e,)."""
        self.recorder.record(state, state)
        record = self.recorder.records.pop()
        return np.array([record.contact_force_N[2], record.contact_area_m2, *record.film_charge_C])

    def _elastic_fields(self, state: State) -> Fields:
        """Layer -> elastic stress at its quadrature points in a state."""
        histories = {name: self.system.history_of(term, state) for name, term in self.terms.items()}
        return {name: memories[0][0] for name, memories in histories.items()}


def _term(setup: Setup, layer: str) -> Term:
    """The term whose law remembers. ValueError where the segment has none of that name."""
    for term in setup.system.terms:
        if any(isinstance(law, Frozen) and law.layer == layer for law in term.inelastic):
            return term
    raise ValueError(f"relaxing: '{layer}' is no layer or compliant bond of this segment")
