"""The material models that a configuration can name, with their constants, and the library of built-in materials."""

import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import AfterValidator, Field, TypeAdapter, model_validator

from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.nearest_name import nearest_name_hint
from geometry.parameters import Finite, Positive, Table, require_one_of_each
from solve.materials import laws
from solve.materials.hyperfoam import HyperfoamLaw

VACUUM_PERMITTIVITY = 8.8541878128e-12  # F/m, CODATA 2018


def _poisson_ratio(value: float) -> float:
    if not -1.0 < value < 0.5:
        raise ValueError("must be above -1 and below 0.5")
    return value


PoissonRatio = Annotated[
    float,
    AfterValidator(_poisson_ratio),
    Field(json_schema_extra={"exclusiveMinimum": -1, "exclusiveMaximum": 0.5}),
]
Terms = Annotated[tuple[Finite, ...], Field(min_length=1)]
Exponent = Annotated[float, Field(ge=-100, le=100)]  # stretches to a higher power overflow
StiffeningRate = Annotated[float, Field(gt=0, le=100)]
Power = Annotated[float, Field(ge=0.5, le=100)]  # below 1/2 the law loses ellipticity in shear (Knowles 1977)
Exponents = Annotated[tuple[Exponent, ...], Field(min_length=1)]


class MaterialTable(Table):
    """What every material may state."""

    density_kg_m3: Positive = Field(1000.0, description="density in the undeformed state")
    max_fitted_strain: Positive | None = Field(
        None, description="largest nominal strain of the data behind the constants; a run warns beyond it"
    )
    source: str | None = Field(None, description="source of the constants")
    confidence: Literal["high", "medium", "low"] | None = Field(
        None, description="high: read in the source; medium: fitted, or a secondary source; low: only a starting value"
    )


class NeoHookean(MaterialTable):
    """Nearly incompressible rubber: W = G/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2."""

    model: Literal["neo-hookean"] = Field("neo-hookean", description="neo-Hookean rubber")
    youngs_modulus_MPa: Positive = Field(description="small-strain Young's modulus")
    poisson_ratio: PoissonRatio = Field(0.495, description="small-strain Poisson's ratio")

    @property
    def shear_modulus_MPa(self) -> float:
        """Small-strain shear modulus G = E / (2 (1 + nu))."""
        return self.youngs_modulus_MPa / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def law(self) -> laws.MediumLaw:
        """Its law, in MPa.

        >>> rubber = NeoHookean(youngs_modulus_MPa=1.0, poisson_ratio=0.25)
        >>> rubber.shear_modulus_MPa, round(rubber.law.bulk_modulus, 6)
        (0.4, 0.666667)
        """
        return laws.InvariantLaw(
            0.5 * self.shear_modulus_MPa, 0.0, 0.0, 0.0, laws.bulk_modulus(self.shear_modulus_MPa, self.poisson_ratio)
        )


class Linear(MaterialTable):
    """Hooke's law between Green-Lagrange strain and second Piola-Kirchhoff stress."""

    model: Literal["linear"] = Field("linear", description="linear elastic solid")
    youngs_modulus_MPa: Positive = Field(description="Young's modulus")
    poisson_ratio: PoissonRatio = Field(0.495, description="Poisson's ratio")

    @property
    def shear_modulus_MPa(self) -> float:
        """Small-strain shear modulus G = E / (2 (1 + nu))."""
        return self.youngs_modulus_MPa / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def law(self) -> laws.MediumLaw:
        """Law of the material, in MPa."""
        bulk = laws.bulk_modulus(self.shear_modulus_MPa, self.poisson_ratio)
        return laws.LinearLaw(self.shear_modulus_MPa, bulk)


class MooneyRivlin(MaterialTable):
    """W = c10 (I1 - 3) + c01 (I2 - 3) in the isochoric invariants, + K/2 (J - 1)^2; G = 2 (c10 + c01)."""

    model: Literal["mooney-rivlin"] = Field("mooney-rivlin", description="two-constant Mooney-Rivlin rubber")
    c10_MPa: Finite = Field(description="constant of the first invariant")
    c01_MPa: Finite = Field(0.0, description="constant of the second invariant")
    poisson_ratio: PoissonRatio = Field(0.495, description="small-strain Poisson's ratio")

    @model_validator(mode="after")
    def _stiff(self) -> Self:
        _require_shear_modulus(self.shear_modulus_MPa, "2 (c10_MPa + c01_MPa)")
        return self

    @property
    def shear_modulus_MPa(self) -> float:
        """Small-strain shear modulus G = 2 (c10 + c01)."""
        return 2.0 * (self.c10_MPa + self.c01_MPa)

    @property
    def law(self) -> laws.MediumLaw:
        """Law of the material, in MPa."""
        return laws.InvariantLaw(
            self.c10_MPa, self.c01_MPa, 0.0, 0.0, laws.bulk_modulus(self.shear_modulus_MPa, self.poisson_ratio)
        )


class Yeoh(MaterialTable):
    """W = c10 (I1 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3, isochoric, + K/2 (J - 1)^2; G = 2 c10."""

    model: Literal["yeoh"] = Field("yeoh", description="Yeoh rubber: stiffens at large strain")
    c10_MPa: Positive = Field(description="linear constant")
    c20_MPa: Finite = Field(0.0, description="quadratic constant")
    c30_MPa: Finite = Field(0.0, description="cubic constant")
    poisson_ratio: PoissonRatio = Field(0.495, description="small-strain Poisson's ratio")

    @property
    def shear_modulus_MPa(self) -> float:
        """Small-strain shear modulus G = 2 c10."""
        return 2.0 * self.c10_MPa

    @property
    def law(self) -> laws.MediumLaw:
        """Law of the material, in MPa."""
        return laws.InvariantLaw(
            self.c10_MPa, 0.0, self.c20_MPa, self.c30_MPa, laws.bulk_modulus(self.shear_modulus_MPa, self.poisson_ratio)
        )


class Knowles(MaterialTable):
    """W = c10 / b [(1 + b / n (I1 - 3))^n - 1], isochoric, + K/2 (J - 1)^2; G = 2 c10; without n, exponential."""

    model: Literal["knowles"] = Field("knowles", description="Knowles' power law of rubber; without n that of Fung")
    c10_MPa: Positive = Field(description="linear constant")
    b: StiffeningRate = Field(description="how soon it stiffens with I1 - 3")
    n: Power | None = Field(None, description="exponent; none: infinite, the exponential law of Fung and Demiray")
    poisson_ratio: PoissonRatio = Field(0.495, description="small-strain Poisson's ratio")

    @property
    def shear_modulus_MPa(self) -> float:
        """Small-strain shear modulus G = 2 c10."""
        return 2.0 * self.c10_MPa

    @property
    def law(self) -> laws.MediumLaw:
        """Law of the material, in MPa."""
        power = self.b, np.inf if self.n is None else self.n
        return laws.KnowlesLaw(self.c10_MPa, power, laws.bulk_modulus(self.shear_modulus_MPa, self.poisson_ratio))


class Ogden(MaterialTable):
    """W = sum mu/alpha (l1^alpha + l2^alpha + l3^alpha - 3), isochoric stretches; G = 1/2 sum mu alpha."""

    model: Literal["ogden"] = Field("ogden", description="Ogden rubber, any number of terms")
    mu_MPa: Terms = Field(description="modulus of each term")
    alpha: Exponents = Field(description="exponent of each term")
    poisson_ratio: PoissonRatio = Field(0.495, description="small-strain Poisson's ratio")

    @model_validator(mode="after")
    def _stiff(self) -> Self:
        require_one_of_each("term", mu_MPa=self.mu_MPa, alpha=self.alpha)
        _require_shear_modulus(self.shear_modulus_MPa, "half the sum of mu_MPa times alpha")
        return self

    @property
    def shear_modulus_MPa(self) -> float:
        """Small-strain shear modulus G = half the sum of mu alpha."""
        return 0.5 * sum(m * a for m, a in zip(self.mu_MPa, self.alpha, strict=True))

    @property
    def law(self) -> laws.MediumLaw:
        """Law of the material, in MPa."""
        bulk = laws.bulk_modulus(self.shear_modulus_MPa, self.poisson_ratio)
        return laws.OgdenLaw(self.mu_MPa, self.alpha, bulk)


class Hyperfoam(MaterialTable):
    """W = sum 2 mu/alpha^2 [l1^alpha + l2^alpha + l3^alpha - 3 + (J^(-alpha beta) - 1)/beta].

    beta = nu / (1 - 2 nu) for each term; G = sum mu.
    """

    model: Literal["hyperfoam"] = Field("hyperfoam", description="Ogden-Hill compressible foam")
    mu_MPa: Terms = Field(description="modulus of each term")
    alpha: Exponents = Field(description="exponent of each term, not zero")
    poisson_ratio: Annotated[tuple[PoissonRatio, ...], Field(min_length=1)] = Field(
        description="Poisson's ratio of each term"
    )

    @model_validator(mode="after")
    def _stiff(self) -> Self:
        require_one_of_each("term", mu_MPa=self.mu_MPa, alpha=self.alpha)
        require_one_of_each("term", mu_MPa=self.mu_MPa, poisson_ratio=self.poisson_ratio)
        if 0.0 in self.alpha:
            raise ValueError("alpha = 0: every exponent must differ from zero")
        # K = sum 2 mu (beta + 1/3) = sum 2/3 mu (1 + nu) / (1 - 2 nu)
        ratios = ((1.0 + nu) / (1.0 - 2.0 * nu) for nu in self.poisson_ratio)
        bulk_MPa = 2.0 / 3.0 * sum(m * r for m, r in zip(self.mu_MPa, ratios, strict=True))
        if not bulk_MPa > 0.0:
            raise ValueError(f"small-strain bulk modulus = {bulk_MPa:g} MPa: must be above 0")
        _require_shear_modulus(self.shear_modulus_MPa, "the sum of mu_MPa")
        return self

    @property
    def shear_modulus_MPa(self) -> float:
        """Small-strain shear modulus G = the sum of mu."""
        return sum(self.mu_MPa)

    @property
    def law(self) -> laws.MediumLaw:
        """Law of the material, in MPa."""
        beta = tuple(nu / (1.0 - 2.0 * nu) for nu in self.poisson_ratio)
        return HyperfoamLaw(self.mu_MPa, self.alpha, beta)


class PiezoelectricFilm(MaterialTable):
    """A poled polymer film. Axis 1 is the draw direction, 2 lies across, 3 is the normal."""

    model: Literal["piezoelectric-film"] = Field("piezoelectric-film", description="linear piezoelectric film")
    youngs_modulus_MPa: Positive = Field(2000.0, description="Young's modulus along the draw direction")
    youngs_modulus_2_MPa: Positive | None = Field(
        None, description="Young's modulus across the draw direction; none: the same as along it"
    )
    poisson_ratio: PoissonRatio = Field(0.29, description="Poisson's ratio")
    d31_pC_per_N: Finite = Field(23.0, description="charge per force along the draw direction")
    d32_pC_per_N: Finite = Field(2.3, description="charge per force across the draw direction")
    d33_pC_per_N: Finite = Field(-33.0, description="charge per force along the normal")
    relative_permittivity: Annotated[float, Field(ge=1, allow_inf_nan=False)] = Field(
        12.0, description="at constant stress, along the normal"
    )
    pyroelectric_uC_per_m2_K: Finite = Field(30.0, description="charge per area and temperature")
    yield_stress_MPa: Positive | None = Field(50.0, description="a run warns if the stress of the film exceeds it")
    density_kg_m3: Positive = Field(1780.0, description="density in the undeformed state")
    coupling: Literal["one-way", "two-way"] = Field(
        "one-way",
        description="one-way: charge follows from stress; two-way: the voltage also strains the film",
    )

    @model_validator(mode="after")
    def _stable(self) -> Self:
        """Positive strain energy of the transversely isotropic compliance: E2 / E1 < (1 - nu) / (2 nu^2)."""
        e1, e2, nu = self.youngs_modulus_MPa, self.youngs_modulus_2_MPa, self.poisson_ratio
        if e2 is not None and 2.0 * nu**2 * e2 >= (1.0 - nu) * e1:
            limit = (1.0 - nu) * e1 / (2.0 * nu**2)
            raise ValueError(f"youngs_modulus_2_MPa = {e2:g}: must be below {limit:.4g} for this poisson_ratio")
        square = self.coupling_squared
        if square >= 1.0:
            name = max(("d31", "d32", "d33"), key=lambda one: abs(getattr(self, f"{one}_pC_per_N")))
            raise ValueError(
                f"{name}_pC_per_N = {getattr(self, f'{name}_pC_per_N'):g}: with relative_permittivity = "
                f"{self.relative_permittivity:g} and these moduli the film would give more energy than it takes "
                f"(d.C.d / eps = {square:.3g}, must be below 1)"
            )
        return self

    @property
    def stiffness_MPa(self) -> Floats:
        """Stiffness (6, 6) in the film's own axes: isotropic, or with another modulus across the draw direction."""
        e1, nu = self.youngs_modulus_MPa, self.poisson_ratio
        e2 = self.youngs_modulus_2_MPa or e1
        compliance = np.zeros((6, 6))
        compliance[:3, :3] = [
            [1 / e1, -nu / e1, -nu / e1],
            [-nu / e1, 1 / e2, -nu / e2],
            [-nu / e1, -nu / e2, 1 / e2],
        ]
        in_plane_shear = np.sqrt(e1 * e2) / (2.0 * (1.0 + nu))
        transverse_shear = e2 / (2.0 * (1.0 + nu))
        compliance[range(3, 6), range(3, 6)] = 1 / in_plane_shear, 1 / transverse_shear, 1 / in_plane_shear
        return np.asarray(np.linalg.inv(compliance), dtype=np.float64)

    @property
    def coupling_C_per_N(self) -> Floats:
        """Piezoelectric constants (6,) d31, d32, d33 and no shear, in the film's own axes."""
        return 1e-12 * np.array([self.d31_pC_per_N, self.d32_pC_per_N, self.d33_pC_per_N, 0.0, 0.0, 0.0])

    @property
    def coupling_squared(self) -> float:
        """d.C.d / eps: the share of energy that the film turns into the other kind; from 1 on the clamped permittivity
        eps - d.C.d, and with it the energy, is no longer positive.

        >>> round(PiezoelectricFilm().coupling_squared, 3)
        0.024
        """
        d = self.coupling_C_per_N
        return float(d @ (1e6 * self.stiffness_MPa) @ d / (self.relative_permittivity * VACUUM_PERMITTIVITY))

    @property
    def shear_modulus_MPa(self) -> float:
        """A film is no medium: ValueError."""
        raise ValueError(f"{self.model} is not a medium")

    @property
    def law(self) -> laws.MediumLaw:
        """A film is no medium: ValueError."""
        raise ValueError(f"{self.model} is not a medium")


def _require_shear_modulus(shear_MPa: float, formula: str) -> None:
    if not shear_MPa > 0.0:
        raise ValueError(f"small-strain shear modulus = {shear_MPa:g} MPa: {formula} must be above 0")


Material = NeoHookean | Linear | MooneyRivlin | Yeoh | Knowles | Ogden | Hyperfoam | PiezoelectricFilm
AnyMaterial = Annotated[Material, Field(discriminator="model")]


@cache
def library_tables() -> dict[str, dict[str, Any]]:
    """The built-in materials as they stand in library.toml."""
    return tomllib.loads(files(__package__).joinpath("library.toml").read_text("utf-8"))


@cache
def library() -> dict[str, Material]:
    """The built-in materials by name."""
    adapter: TypeAdapter[Material] = TypeAdapter(AnyMaterial)
    return {name: adapter.validate_python(table) for name, table in library_tables().items()}


def find_material(name: str, own: Mapping[str, Material], key: str) -> Material:
    """A material by name, the user's own before the built-in ones.

    key : the configuration key that names it. InputError with the nearest name for an unknown one.
    """
    known = {**library(), **own}
    if name in known:
        return known[name]
    raise InputError(f"{key} = '{name}': no such material; {nearest_name_hint(name, known)}")
