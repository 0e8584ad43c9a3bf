"""The paper's analytical model, and the composite beam that it left out. Plain functions of SI numbers."""

from softdot.paper.analytical.beam import (
    Ends,
    beam_deflection_m,
    bending_softness,
    second_moment_m4,
    shear_deflection_m,
)
from softdot.paper.analytical.composite import (
    Lamina,
    bending_stiffness_Nm,
    middle_curvature_per_m,
    neutral_axis_m,
    plane_strain_modulus_Pa,
    stretch_of_deflected_strip,
)
from softdot.paper.analytical.softness import (
    Regime,
    deflections_m,
    index_of_modulus,
    index_of_thickness,
    output_m,
    regime,
    shares,
    softness,
    softness_of_jiang,
)

__all__ = [
    "Ends",
    "Lamina",
    "Regime",
    "beam_deflection_m",
    "bending_softness",
    "bending_stiffness_Nm",
    "deflections_m",
    "index_of_modulus",
    "index_of_thickness",
    "middle_curvature_per_m",
    "neutral_axis_m",
    "output_m",
    "plane_strain_modulus_Pa",
    "regime",
    "second_moment_m4",
    "shares",
    "shear_deflection_m",
    "softness",
    "softness_of_jiang",
    "stretch_of_deflected_strip",
]
