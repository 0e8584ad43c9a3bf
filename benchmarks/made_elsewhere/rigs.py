"""The two rigs, as they are stated and as they truly are, and the text of rig.toml."""

from dataclasses import dataclass, field, replace

VACUUM_PERMITTIVITY = 8.8541878128e-12  # F/m


@dataclass(frozen=True)
class Sheet:
    """One medium: thickness in mm, Young's modulus in MPa, Poisson's ratio."""

    thickness: float
    modulus: float
    poisson: float
    density: float = 1000.0
    gent_limit: float | None = None  # largest I1 - 3 of Gent's law (Rubber Chem. Technol. 69, 1996)
    relative_moduli: tuple[float, ...] = ()  # of what relaxes of its shear modulus
    relaxation_times: tuple[float, ...] = ()  # s

    @property
    def shear(self) -> float:
        """Shear modulus in MPa."""
        return self.modulus / (2 * (1 + self.poisson))

    @property
    def bulk(self) -> float:
        """Bulk modulus in MPa."""
        return self.modulus / (3 * (1 - 2 * self.poisson))


@dataclass(frozen=True)
class PolarFilm:
    """PVDF as its vendor states it: MPa, pC/N."""

    thickness: float = 0.028  # mm
    modulus: float = 2000.0
    poisson: float = 0.29
    d: tuple[float, float, float] = (23.0, 2.3, -33.0)
    permittivity: float = 12.0


@dataclass(frozen=True)
class Bench:
    """A slice in plane strain under a ridge, and its amplifier; mm, N, s, MOhm, pF."""

    length: float
    width: float
    effector: Sheet
    medium1: Sheet
    medium2: Sheet
    radius: float
    depth: float
    resistance: float
    capacitance: float
    side_stiffness: float | None  # N/mm3 on effector, medium 1 and film; None: free
    film: PolarFilm = field(default_factory=PolarFilm)
    glue: Sheet | None = None  # between medium 2 and film
    aside: float = 0.0  # of the dot
    leak: float | None = None  # MOhm beside the input
    cable: float | None = None  # Hz, corner of the RC of a cable behind the amplifier

    @property
    def film_capacitance(self) -> float:
        """In pF."""
        area = self.length * self.width * 1e-6
        return self.film.permittivity * VACUUM_PERMITTIVITY * area / (self.film.thickness * 1e-3) * 1e12


RIGS = {
    # A segment wider than a cell, in a frame of soft rubber, and an electrometer.
    "C": Bench(
        length=4.0,
        width=10.0,
        effector=Sheet(0.6, 1.5, 0.495, 1050.0),
        medium1=Sheet(0.5, 3.0, 0.495, 1000.0),
        medium2=Sheet(1.6, 0.6, 0.49, 980.0),
        radius=0.8,
        depth=0.30,
        resistance=100000.0,
        capacitance=60.0,
        side_stiffness=6.0,
    ),
    # A long free strip under a blunt ridge, with 4.7 nF beside the film.
    "D": Bench(
        length=6.0,
        width=12.0,
        effector=Sheet(0.5, 0.8, 0.495, 1070.0),
        medium1=Sheet(1.0, 2.0, 0.49, 1020.0),
        medium2=Sheet(2.5, 0.35, 0.48, 900.0),
        radius=1.6,
        depth=0.40,
        resistance=5000.0,
        capacitance=4700.0,
        side_stiffness=None,
    ),
}

HEAD = """format = "softdot-recording/1"

[segment]
length_mm = {length}
width_mm = {width}
section = "plane-strain"
{sides}

[segment.effector]
shape = "layer"
height_mm = {effector}
material = "cover"

[segment.medium1]
thickness_mm = {medium1}
material = "plate"

[segment.film]
thickness_um = {film}
material = "pvdf"
draw_angle_deg = 0.0

[segment.medium2]
thickness_mm = {medium2}
material = "cushion"
{materials}
[dot]
shape = "ridge"
radius_mm = {radius}
offset_mm = [0.0, 0.0]

[press]
indentation_mm = {depth}

[readout]
input_resistance_MOhm = {resistance}
input_capacitance_pF = {capacitance}
"""

MATERIAL = """
[materials.{name}]
model = "neo-hookean"
youngs_modulus_MPa = {modulus}
poisson_ratio = {poisson}
density_kg_m3 = {density}
"""

RUN = """
[[runs]]
file = "{file}"
label = "{label}"
drive = "displacement_mm"
dot_offset_mm = [0.0, 0.0]
temperature_C = 23.0
[runs.nuisance]
{widths}
"""

FREE = 'boundary = "free"'
ELASTIC = 'boundary = "elastic"\nheld_layers = ["effector", "medium1", "film"]\nside_stiffness_N_per_mm3 = {}'


def head(bench: Bench) -> str:
    """rig.toml without its runs."""
    sheets = {"cover": bench.effector, "plate": bench.medium1, "cushion": bench.medium2}
    return HEAD.format(
        length=bench.length,
        width=bench.width,
        sides=FREE if bench.side_stiffness is None else ELASTIC.format(bench.side_stiffness),
        effector=bench.effector.thickness,
        medium1=bench.medium1.thickness,
        film=1000 * bench.film.thickness,
        medium2=bench.medium2.thickness,
        materials="".join(
            MATERIAL.format(name=name, modulus=one.modulus, poisson=one.poisson, density=one.density)
            for name, one in sheets.items()
        ),
        radius=bench.radius,
        depth=bench.depth,
        resistance=bench.resistance,
        capacitance=bench.capacitance,
    )


def run_table(file: str, label: str, widths: dict[str, float]) -> str:
    """One table [[runs]]."""
    return RUN.format(
        file=file, label=label, widths="\n".join(f"{name} = {value:.4g}" for name, value in widths.items())
    )


def changed(bench: Bench, layer: str, **values: object) -> Bench:
    """The rig with other values of one of its sheets."""
    return replace(bench, **{layer: replace(getattr(bench, layer), **values)})
