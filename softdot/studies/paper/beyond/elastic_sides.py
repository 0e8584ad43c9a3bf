"""Between free and clamped: sides held by springs, from none to rigid, with the paper's cases as end points."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from foundation.executor import Executor
from softdot.config.schema import Config
from softdot.progress import Progress
from softdot.studies.paper.beyond.trials import DesignPress, press_of
from softdot.studies.paper.presses import solve_named
from softdot.studies.paper.segment import segment_config

STIFFNESS_N_PER_MM3 = tuple(float(f"{k:.2g}") for k in np.geomspace(0.1, 1e4, 11))
"""Two a decade. A wall of modulus E and thickness t gives about E / t."""


PAIRS = {"final design": (0.5, 1.0), "C1 and F4": (0.8, 0.05), "C2 and F1": (0.8, 5.0)}
"""Segments of which the paper gives both ends: h1 in mm, E2 in MPa."""
WALLS = {
    "silicone shared with the neighbours, 0.5 mm of 1 MPa": 1.0 / 0.5,
    "thermoplastic polyurethane frame, 0.4 mm of 30 MPa": 30.0 / 0.4,
    "printed resin frame, 0.4 mm of 2 GPa": 2000.0 / 0.4,
}


@dataclass(frozen=True)
class Curve:
    """One segment from free to clamped; between[i] belongs to STIFFNESS_N_PER_MM3[i]."""

    free: DesignPress
    between: Sequence[DesignPress]
    clamped: DesignPress

    @property
    def presses(self) -> list[DesignPress]:
        """Presses from stiffness 0 to infinity."""
        return [self.free, *self.between, self.clamped]

    def voltage_at_V(self, stiffness: float) -> float:
        """Voltage at a stiffness in N/mm³ within the range, linear in its logarithm."""
        voltages = [press.voltage_V for press in self.between]
        return float(np.interp(np.log(stiffness), np.log(STIFFNESS_N_PER_MM3), voltages))

    def half_way_N_per_mm3(self) -> float:
        """Stiffness at which half of the voltage between free and clamped is first reached; nan when never."""
        half = (self.free.voltage_V + self.clamped.voltage_V) / 2.0
        gains = np.array([press.voltage_V for press in self.between]) - half
        k = int(np.argmax(gains >= 0))
        if k == 0:
            return float("nan")
        share = gains[k - 1] / (gains[k - 1] - gains[k])
        low, high = np.log(STIFFNESS_N_PER_MM3[k - 1]), np.log(STIFFNESS_N_PER_MM3[k])
        return float(np.exp(low + share * (high - low)))


def solve_curves(progress: Progress, executor: Executor) -> Mapping[str, Curve]:
    """The curves of PAIRS in cross-section. NotSolvedError."""
    configs = {(name, side): config for name in PAIRS for side, config in _sides(name).items()}
    found = {key: press_of(outcome) for key, outcome in solve_named(configs, progress, executor).items()}
    return {
        name: Curve(found[name, "free"], [found[name, str(k)] for k in STIFFNESS_N_PER_MM3], found[name, "clamped"])
        for name in PAIRS
    }


def _sides(name: str) -> dict[str, Config]:
    """Name of the sides -> configuration, of one segment."""
    ends = {"free": segment_config("free", *PAIRS[name]), "clamped": segment_config("clamped", *PAIRS[name])}
    return {**ends, **{str(k): elastic(ends["clamped"], k) for k in STIFFNESS_N_PER_MM3}}


def elastic(config: Config, stiffness: float) -> Config:
    """The segment with the sides of its held layers on springs, in N/mm³."""
    changes = {"boundary": "elastic", "side_stiffness_N_per_mm3": stiffness}
    return config.model_copy(update={"segment": config.segment.model_copy(update=changes)})
