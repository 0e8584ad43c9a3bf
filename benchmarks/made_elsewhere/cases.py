"""The ten rigs as they truly are: what each hides, by which law and how much of it."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from benchmarks.made_elsewhere.rigs import RIGS, Bench, Sheet, changed

# Fung's box spectrum (Biomechanics, 1981, section 7.6): as much in each decade.
TIMES = (0.03, 0.1, 0.3, 1.0, 3.0)
SHARE = 0.01  # of each branch


@dataclass(frozen=True)
class Hidden:
    """One recording: the stated rig, what is done to it, and the loudness of its noise (1: 0.6 % of the largest)."""

    rig: str
    loudness: float
    mechanism: str | None = None
    component: str = ""
    parameters: dict[str, Any] = field(default_factory=dict)
    done: Callable[[Bench], Bench] = lambda bench: bench
    below: bool = False  # meant to be below the visible size
    notes: str = ""

    @property
    def stated(self) -> Bench:
        """What rig.toml says."""
        return RIGS[self.rig]

    @property
    def true(self) -> Bench:
        """What it is."""
        return self.done(self.stated)


def glued(bench: Bench) -> Bench:
    """A tape between medium 2 and film."""
    return replace(bench, glue=Sheet(0.06, 0.15, 0.49))


CASES = {
    "e01": Hidden(
        "D",
        1.0,
        "low-pass",
        "readout",
        {"low_pass_Hz": 12.0, "order": 1},
        lambda bench: replace(bench, cable=12.0),
        notes="the RC of a cable behind the amplifier",
    ),
    "e02": Hidden(
        "C",
        0.6,
        "adhesive-compliance",
        "bond-film-medium2",
        {"thickness_um": 60.0, "youngs_modulus_MPa": 0.15, "poisson_ratio": 0.49},
        glued,
        notes="a layer of finite thickness, added to the stack",
    ),
    "e03": Hidden("D", 1.0),
    "e04": Hidden(
        "D",
        1.0,
        "charge-leakage",
        "readout",
        {"leak_MOhm": 8000.0},
        lambda bench: replace(bench, leak=8000.0),
        notes="a resistor beside the input",
    ),
    "e05": Hidden(
        "C",
        0.5,
        "viscoelasticity",
        "medium2",
        {
            "relaxation_times_s": list(TIMES),
            "relative_moduli": [SHARE] * len(TIMES),
            "believed_modulus": "instantaneous",
        },
        lambda bench: changed(bench, "medium2", relative_moduli=(SHARE,) * len(TIMES), relaxation_times=TIMES),
        notes="quasi-linear, on the shear modulus; the believed modulus is the instantaneous one",
    ),
    "e06": Hidden(
        "C",
        1.0,
        "property-error",
        "medium1",
        {"modulus_factor": 1.045},
        lambda bench: changed(bench, "medium1", modulus=1.045 * bench.medium1.modulus),
        below=True,
    ),
    "e07": Hidden(
        "D",
        0.6,
        "hyperelastic-stiffening",
        "medium2",
        {"gent_Jm": 1.5},
        lambda bench: changed(bench, "medium2", gent_limit=1.5),
        notes="Gent's law of limited extensibility, the same modulus at small strain",
    ),
    "e08": Hidden("C", 1.0),
    "e09": Hidden(
        "C",
        0.8,
        "dot-offset",
        "dot",
        {"offset_mm": 0.8},
        lambda bench: replace(bench, aside=0.8),
    ),
    "e10": Hidden(
        "D",
        1.0,
        "property-error",
        "medium2",
        {"thickness_factor": 0.9},
        lambda bench: changed(bench, "medium2", thickness=0.9 * bench.medium2.thickness),
    ),
}
