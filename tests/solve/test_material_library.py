"""The built-in materials against the sources that they name."""

import pytest

from solve.materials.parameters import PiezoelectricFilm, Yeoh, library
from tests.cases import for_each

# stress at 100 % strain in kPa of the tensile data that the silicones were fitted to
STRESS_AT_100_PERCENT_KPA = {
    "ecoflex-00-10": 15,
    "ecoflex-00-30": 30,
    "ecoflex-00-50": 41,
    "dragon-skin-10": 113,
    "dragon-skin-20": 318,
    "dragon-skin-30": 437,
    "rtv615": 801,
    "sortaclear-40": 564,
}


@for_each(("name", "stress_kPa"), STRESS_AT_100_PERCENT_KPA.items())
def test_a_silicone_pulled_to_twice_its_length_has_the_measured_stress(name, stress_kPa):
    material = library()[name]
    assert isinstance(material, Yeoh)
    stretch = 2.0
    invariant = stretch**2 + 2.0 / stretch - 3.0
    slope = material.c10_MPa + 2 * material.c20_MPa * invariant + 3 * material.c30_MPa * invariant**2
    nominal_kPa = 1e3 * 2.0 * (stretch - stretch**-2) * slope
    assert nominal_kPa == pytest.approx(stress_kPa, rel=0.05)


def test_every_material_states_its_source_and_confidence():
    assert [name for name, material in library().items() if not (material.source and material.confidence)] == []


@for_each(("name", "g31"), [("pvdf", 0.216), ("pvdf-trfe", 0.162)])
def test_charge_and_voltage_constants_of_a_film_agree(name, g31):
    film = library()[name]
    assert isinstance(film, PiezoelectricFilm)
    permittivity = 8.854e-12 * film.relative_permittivity
    assert 1e-12 * film.d31_pC_per_N / permittivity == pytest.approx(g31, rel=0.03)
