"""What p depends on and the paper does not say: every input with its range."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, log

Values = Mapping[str, float]
"""Name of an input -> its value, in the unit of the name."""


@dataclass(frozen=True)
class Input:
    """One unknown of the rig. assumed : the value taken where a single one is needed."""

    name: str
    title: str
    unit: str
    low: float
    assumed: float
    high: float
    why: str
    logarithmic: bool = False

    def at(self, share: float) -> float:
        """The value a share, 0 to 1, of the way from low to high."""
        if self.logarithmic:
            return exp(log(self.low) + share * (log(self.high) - log(self.low)))
        return self.low + share * (self.high - self.low)


INPUTS = {
    entry.name: entry
    for entry in (
        Input(
            "resistance_MOhm",
            "input resistance R",
            "MΩ",
            0.5,
            1.0,
            10.0,
            "1 MΩ is usual for filters and oscilloscopes, half of it if both load the film, 10 MΩ for a probe",
            logarithmic=True,
        ),
        Input(
            "capacitance_pF",
            "capacitance C of input and cable",
            "pF",
            50.0,
            150.0,
            400.0,
            "1 to 3 m of coaxial cable, about 100 pF/m, and the input",
        ),
        Input(
            "press_time_s",
            "press time T, from touch to full depth",
            "s",
            0.1,
            1.0 / 3.0,
            0.5,
            "ten presses in ten seconds: press and release last at most one second together",
        ),
        Input("dot_radius_mm", "radius of the copper dot", "mm", 0.75, 0.8, 1.2, "Braille dots have 0.75 to 0.85 mm"),
        Input(
            "poisson_ratio",
            "Poisson's ratio of the simulated sponge",
            "",
            0.0,
            0.3,
            0.495,
            "from an open foam to the rubbers of the paper's Table 2",
        ),
        Input(
            "foam_poisson_ratio",
            "Poisson's ratio of the real sponge",
            "",
            0.05,
            0.05,
            0.3,
            "open cells near 0, closed cells about 0.3",
        ),
        Input("foam_exponent", "exponent α of the foam law", "", 8.0, 12.0, 20.0, "early or late softening of a foam"),
        Input("beam_length_mm", "free length of the beam", "mm", 50.0, 100.0, 150.0, "bar of 2 × 9 mm under a finger"),
        Input(
            "push_offset_mm",
            "hand nearer to the clamp than the dot",
            "mm",
            -2.0,
            0.0,
            2.0,
            "a fingertip is about 10 mm wide; negative: beyond the dot",
        ),
    )
}


def assumed_inputs(**changes: float) -> dict[str, float]:
    """Assumed value of every input, but for the changed ones."""
    return {name: entry.assumed for name, entry in INPUTS.items()} | changes
