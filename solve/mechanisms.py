"""The names of physics beyond the baseline: where each mechanism may sit and what it is given."""

from typing import Any, Self

from pydantic import Field, model_validator

from geometry.parameters import Table
from solve.nearest import nearest

MEDIA = ("effector", "medium1", "medium2")
BONDS = ("bond-effector-medium1", "bond-medium1-film", "bond-film-medium2", "bond-base")
CHANNELS = tuple(f"channel-{n}" for n in range(1, 17))

# name -> (components, parameters)
MECHANISMS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "charge-leakage": (("readout", "film"), ("resistance_MOhm",)),
    "parasitic-capacitance": (("readout",), ("capacitance_pF",)),
    "low-pass": (("readout",), ("cutoff_Hz", "order")),
    "saturation": (("readout",), ("limit_V",)),
    "mains-hum": (("readout",), ("frequency_Hz", "amplitude_V")),
    "pyroelectric-drift": (("film",), ("temperature_step_K", "time_constant_s")),
    "contact-electrification": (("film",), ("charge_pC",)),
    "viscoelasticity": ((*MEDIA, "film", *BONDS), ("relative_moduli", "relaxation_times_s")),
    "hyperelastic-stiffening": (
        MEDIA,
        ("force_ratio", "c10_MPa", "c01_MPa", "c20_MPa", "c30_MPa", "mu_MPa", "alpha"),
    ),
    "foam-densification": (MEDIA, ("force_ratio", "mu_MPa", "alpha", "poisson_ratio")),
    "stress-softening": (MEDIA, ("loss_ratio",)),
    "film-yield": (("film",), ("yield_stress_MPa",)),
    "adhesive-compliance": (BONDS, ("normal_stiffness_N_per_mm3", "shear_stiffness_N_per_mm3")),
    "delamination": (BONDS, ("center_mm", "diameter_mm")),
    "friction": (("dot",), ("coefficient",)),
    "elastic-sides": (("sides",), ("stiffness_N_per_mm3",)),
    "dot-offset": (("dot",), ("offset_mm",)),
    "contact-gap": (("dot",), ("gap_mm",)),
    "rig-compliance": (("rig",), ("compliance_mm_per_N",)),
    "film-prestretch": (("film",), ("strain_x", "strain_y")),
    "inertia": (("rig",), ("moving_mass_g",)),
    "crosstalk": (CHANNELS, ("coupling",)),
    "property-error": (
        (*MEDIA, "film", "dot"),
        ("modulus_factor", "thickness_factor", "d31_factor", "radius_factor", "height_factor"),
    ),
    "dimension-reduction": (("dot",), ()),
}


class Mechanism(Table):
    """One piece of physics beyond the baseline, switched on at one component."""

    name: str = Field(
        "viscoelasticity", description="which physics", json_schema_extra={"enum": list(MECHANISMS)}
    )
    component: str = Field(
        "medium2", description="where: a layer, a bond, sides, dot, rig, readout or channel-N"
    )
    parameters: dict[str, Any] = Field({}, description="its numbers, by name with their unit")

    @model_validator(mode="after")
    def _known(self) -> Self:
        if self.name not in MECHANISMS:
            raise ValueError(f"name = '{self.name}': {nearest(self.name, MECHANISMS)}")
        components, parameters = MECHANISMS[self.name]
        if self.component not in components:
            raise ValueError(f"component = '{self.component}': {self.name} acts on {', '.join(components)}")
        for name in self.parameters:
            if name not in parameters:
                allowed = ", ".join(parameters) or "no parameters"
                raise ValueError(f"parameters.{name}: {self.name} takes {allowed}")
        return self
