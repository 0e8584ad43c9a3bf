"""Presses of the 3D model with memories that do not fade: the samples of which the reduced model is made."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from mesh.types import Floats
from solve.bond import Bond
from solve.film import FilmRegion
from solve.linear import LinearSolver
from solve.march import march, rest_state
from solve.newton import NoEquilibriumError, equilibrate
from solve.reduced.frozen import Frozen
from solve.reduced.modes import Basis
from solve.schedule import Target
from solve.setup import Setup
from solve.solid import SolidRegion
from solve.system import Load, State
from solve.term import Term

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


class Sampler:
    """Presses one segment over and over."""

    def __init__(self, setup: Setup, layers: tuple[str, ...], nodes: int) -> None:
        self.setup, self.system, self.recorder = setup, setup.system, setup.recorder
        self.layers, self.shares = layers, depth_shares(nodes)
        self.linear = LinearSolver(self.system.factorisation_shift)
        self.terms = {layer: _term(setup, layer) for layer in layers}
        self.bases = {layer: Basis(_weights(term)) for layer, term in self.terms.items()}
        rest = Target(0.0, Load((0.0, 0.0), 0.0), True)
        self.rest = rest_state(self.system, self.linear, rest)
        self.recorder.start(self.rest)
        self.force_scale = self.rest.force_scale

    def press(self, memory: Mapping[str, Floats], keep: bool = False) -> tuple[Sample, list[dict[str, Floats]]]:
        """Press with overstress fields (n, 6); keep : also give back the elastic stress fields at every node.

        NoEquilibriumError.
        """
        state, touch = self._free(memory)
        full = self.setup.full_drive
        outputs, stress, fields, past = [], {name: [] for name in self.layers}, [], [state]
        for number, share in enumerate(self.shares):
            if number > 0:
                drive = touch + share * (full - touch)
                target = Target(past[-1].time + 1.0, Load((0.0, 0.0), float(drive)), False)
                failure = march(self.system, self.linear, past, target, False, lambda *_: None)
                if failure is not None:
                    raise NoEquilibriumError(f"a press for the reduced model stopped: {failure}", past[-1].x, None)
            now = self._elastic(past[-1])
            outputs.append(self._outputs(past[-1]))
            for name, field in now.items():
                stress[name].append(self.bases[name].add(field.ravel()))
            fields += [now] if keep else []
        self.force_scale = max(self.force_scale, past[-1].force_scale)
        remembered = {name: self.bases[name].add(field.ravel()) for name, field in memory.items()}
        touch_mm = 1e3 * self.system.units.length * touch
        return Sample(touch_mm, np.array(outputs), stress, remembered), fields

    def _free(self, memory: Mapping[str, Floats]) -> tuple[State, float]:
        """The segment clear of the dot, and the approach at which they touch."""
        histories = [
            self._remember(term, history, memory)
            for term, history in zip(self.system.terms, self.rest.histories, strict=True)
        ]
        lifted = Load((0.0, 0.0), -self.setup.full_drive)
        start = replace(self.rest, load=lifted, histories=tuple(histories), force_scale=self.force_scale, time=-1.0)
        state = equilibrate(self.system, self.linear, start.x, lifted, 0.0, start) if memory else start
        touch = float(brentq(lambda drive: self._gap(state, drive), lifted.drive, self.setup.full_drive, xtol=1e-12))
        return replace(state, load=Load((0.0, 0.0), touch), time=0.0), touch

    def _remember(self, term: Term, history: object, memory: Mapping[str, Floats]) -> object:
        for name, own in self.terms.items():
            if own is term:
                field = self._elastic(self.rest)[name]
                held = (field, memory.get(name, np.zeros_like(field)))
                return held if isinstance(term, Bond) else (held,)
        return history

    def _gap(self, state: State, drive: float) -> float:
        """Smallest distance, a mean over a node's surroundings, with the dot at an approach."""
        contact = self.system.contact
        gap = contact.weighted_gap(self.system.displacement(state.x), np.array([0.0, 0.0, -drive]))
        return float((gap / contact.nodal_area).min())

    def _outputs(self, state: State) -> Floats:
        self.recorder.record(state, state)
        record = self.recorder.records.pop()
        return np.array([record.contact_force_N[2], record.contact_area_m2, *record.film_charge_C])

    def _elastic(self, state: State) -> dict[str, Floats]:
        """Elastic stress of every layer; of a bond its jump."""
        found = {}
        for name, term in self.terms.items():
            history = self.system.history_of(term, state)
            found[name] = history[0] if isinstance(term, Bond) else history[0][0]
        return found


def _term(setup: Setup, layer: str) -> Term:
    """The term whose law remembers. ValueError where the segment has none of that name."""
    for term in setup.system.terms:
        laws = term.inelastic if isinstance(term, SolidRegion | FilmRegion) else (getattr(term, "prony", None),)
        if any(isinstance(law, Frozen) and law.layer == layer for law in laws):
            return term
    raise ValueError(f"relaxing: '{layer}' is no layer or compliant bond of this segment")


def _weights(term: Term) -> Floats:
    """One weight to each number of the field."""
    if isinstance(term, Bond):
        return np.repeat(term.facets.area.ravel(), 4)
    assert isinstance(term, SolidRegion | FilmRegion)
    return np.repeat(term.weight.ravel(), 6)
