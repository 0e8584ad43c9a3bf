"""The parameters of each mechanism, with what is allowed."""

from typing import Annotated, Any, Self

from pydantic import Field, field_validator, model_validator
from pydantic_core import PydanticCustomError

from geometry.parameters import BondStiffness, Finite, NonNegative, Positive, Table

Strain = Annotated[float, Field(gt=-0.2, lt=0.2, allow_inf_nan=False)]
Moduli = tuple[Annotated[float, Field(ge=0, lt=1, allow_inf_nan=False)], ...]
Terms = tuple[Finite, ...]


class Parameters(Table):
    """Numbers only: neither texts nor true and false stand for them."""

    @field_validator("*", mode="before")
    @classmethod
    def _plain(cls, value: Any) -> Any:
        if any(isinstance(one, str | bool) for one in (value if isinstance(value, list) else [value])):
            raise PydanticCustomError("plain_number", "must be a plain number; its unit is part of the key")
        return value


class ChargeLeakage(Parameters):
    """A resistance parallel to the read-out's."""

    resistance_MOhm: Positive = Field(description="resistance parallel to the input resistance")


class ParasiticCapacitance(Parameters):
    """A capacitance parallel to the read-out's."""

    capacitance_pF: NonNegative = Field(description="capacitance added to that of the input")


class LowPass(Parameters):
    """A low-pass behind the read-out, Butterworth's where no quality is given."""

    cutoff_Hz: Positive = Field(description="frequency at which half the power remains")
    order: Annotated[int, Field(ge=1, le=8)] = Field(1, description="order")
    quality: Annotated[float, Field(gt=0, le=10, allow_inf_nan=False)] | None = Field(
        None, description="quality for order 2: 0.5 two equal RC stages, 0.577 Bessel, 0.707 and none Butterworth"
    )
    delay_s: NonNegative = Field(0.0, description="dead time after the filter, such as that of a converter")

    @model_validator(mode="after")
    def _second_order(self) -> Self:
        if self.quality is not None and self.order != 2:
            raise ValueError(f"quality is for order = 2 only, order is {self.order}")
        return self


class Saturation(Parameters):
    """The amplifier's limit."""

    limit_V: Positive = Field(description="the voltage stays between plus and minus this")
    sharpness: Annotated[float, Field(ge=1, le=1000, allow_inf_nan=False)] | None = Field(
        None, description="sharpness of the knee: 2.5 is close to tanh; none: a hard limit"
    )


class MainsHum(Parameters):
    """A sine added to the voltage."""

    frequency_Hz: Positive = Field(50.0, description="frequency of the mains")
    amplitude_V: NonNegative = Field(description="amplitude of the sine")


class PyroelectricDrift(Parameters):
    """A temperature step of the film."""

    temperature_step_K: Finite = Field(description="final change of temperature")
    time_constant_s: Positive = Field(1.0, description="time constant of the exponential approach after first touch")


class ContactElectrification(Parameters):
    """Charge that the touch leaves on the electrodes."""

    charge_pC: Finite = Field(description="charge at the largest contact area; proportional to the area before that")


class Viscoelasticity(Parameters):
    """A Prony series."""

    relative_moduli: Moduli = Field(description="share of the instantaneous stress that each term relaxes")
    relaxation_times_s: tuple[Positive, ...] = Field(description="one for each modulus")

    @model_validator(mode="after")
    def _series(self) -> Self:
        if len(self.relative_moduli) != len(self.relaxation_times_s):
            raise ValueError(
                f"relaxation_times_s has {len(self.relaxation_times_s)} values but relative_moduli has "
                f"{len(self.relative_moduli)}: one of each per term"
            )
        if sum(self.relative_moduli) >= 1.0:
            raise ValueError(f"relative_moduli = {list(self.relative_moduli)}: their sum must be below 1")
        return self


class HyperelasticStiffening(Parameters):
    """Another law of the same layer: Yeoh or Mooney-Rivlin (c10 ...), or Ogden (mu, alpha)."""

    c10_MPa: Finite | None = Field(None, description="Yeoh or Mooney-Rivlin; none: half the layer's shear modulus")
    c01_MPa: Finite | None = Field(None, description="Mooney-Rivlin")
    c20_MPa: Finite | None = Field(None, description="Yeoh")
    c30_MPa: Finite | None = Field(None, description="Yeoh")
    mu_MPa: Terms | None = Field(None, description="Ogden, one per term")
    alpha: Terms | None = Field(None, description="Ogden, one per term")

    @model_validator(mode="after")
    def _one_law(self) -> Self:
        polynomial = [self.c01_MPa, self.c20_MPa, self.c30_MPa]
        if (self.mu_MPa is None) != (self.alpha is None):
            raise ValueError("mu_MPa and alpha make an Ogden law together: give both")
        laws = [self.c01_MPa is not None, any(c is not None for c in polynomial[1:]), self.mu_MPa is not None]
        if sum(laws) > 1 or (self.mu_MPa is not None and self.c10_MPa is not None):
            raise ValueError("c01_MPa, or c20_MPa and c30_MPa, or mu_MPa and alpha: give the constants of one law")
        return self


class FoamDensification(Parameters):
    """The layer as a hyperfoam."""

    mu_MPa: Terms = Field(description="modulus of each term")
    alpha: Terms = Field(description="exponent of each term")
    poisson_ratio: Terms = Field(description="Poisson's ratio of each term")


class StressSoftening(Parameters):
    """Ogden-Roxburgh softening."""

    loss_ratio: Annotated[float, Field(ge=0, lt=1, allow_inf_nan=False)] = Field(
        description="largest relative loss of stress, 1/r: second against first cycle well below the deepest press"
    )
    energy_MPa: NonNegative = Field(0.0, description="m: energy below which nothing softens")
    beta: Positive = Field(0.3, description="width of the transition back to the first curve")


class FilmYield(Parameters):
    """Plasticity of the film."""

    yield_stress_MPa: Positive = Field(description="von Mises stress at which the film yields")
    hardening_modulus_MPa: NonNegative = Field(0.0, description="0: perfectly plastic")


class AdhesiveCompliance(Parameters):
    """Stiffness of a bond, directly or as a layer of glue."""

    normal_stiffness_N_per_mm3: BondStiffness | None = Field(None, description="traction per opening")
    shear_stiffness_N_per_mm3: BondStiffness | None = Field(None, description="traction per slip")
    thickness_um: Positive | None = Field(None, description="thickness of the glue, instead of the stiffnesses")
    youngs_modulus_MPa: Positive | None = Field(None, description="modulus of the glue")
    poisson_ratio: Annotated[float, Field(ge=0, lt=0.5)] = Field(0.45, description="Poisson's ratio of the glue")

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        stiffness = (self.normal_stiffness_N_per_mm3, self.shear_stiffness_N_per_mm3)
        glue = (self.thickness_um, self.youngs_modulus_MPa)
        if (None in stiffness) == (None in glue) or (stiffness.count(None) == 1 or glue.count(None) == 1):
            raise ValueError(
                "normal_stiffness_N_per_mm3 and shear_stiffness_N_per_mm3, or thickness_um and youngs_modulus_MPa: "
                "give one pair"
            )
        return self


class DelaminationPatch(Parameters):
    """A region without bond."""

    center_mm: tuple[Finite, Finite] = Field((0.0, 0.0), description="centre, x and y")
    diameter_mm: NonNegative = Field(description="diameter of the disc; plane strain: width of the strip")


class Friction(Parameters):
    """Coulomb friction of the dot."""

    coefficient: Annotated[float, Field(ge=0, le=3, allow_inf_nan=False)] = Field(description="coefficient of friction")


class ElasticSides(Parameters):
    """Springs at the held sides."""

    stiffness_N_per_mm3: NonNegative = Field(description="normal and tangential traction per displacement")


class DotOffset(Parameters):
    """The dot stands elsewhere."""

    offset_mm: tuple[Finite, Finite] = Field(description="added to the dot's position, x and y")


class ContactGap(Parameters):
    """Lost motion before the touch."""

    gap_mm: NonNegative = Field(description="travel of the rig before the dot touches")


class RigCompliance(Parameters):
    """A spring between displacement sensor and dot."""

    compliance_mm_per_N: NonNegative = Field(description="compliance of the rig")


class FilmPrestretch(Parameters):
    """The film was stretched before it was bonded."""

    strain_x: Strain = Field(0.0, description="nominal strain in x")
    strain_y: Strain = Field(0.0, description="nominal strain in y")


class Inertia(Parameters):
    """Mass that moves with the dot."""

    moving_mass_g: NonNegative = Field(description="mass between the force sensor and the dot")


class Crosstalk(Parameters):
    """Other channels leak into this one."""

    coupling: Annotated[float, Field(gt=-1, lt=1, allow_inf_nan=False)] = Field(
        description="share of the other channels' voltage that adds to this one"
    )


class PropertyError(Parameters):
    """A wrong number in the configuration."""

    modulus_factor: Positive = Field(1.0, description="factor on every modulus of the layer")
    thickness_factor: Positive = Field(1.0, description="factor on the thickness of the layer")
    d31_factor: Positive = Field(1.0, description="film: factor on d31, d32 and d33")
    radius_factor: Positive = Field(1.0, description="dot: factor on its radius")
    height_factor: Positive = Field(1.0, description="dot: factor on its height")


class DimensionReduction(Parameters):
    """A ridge for a cap, or the reverse."""
