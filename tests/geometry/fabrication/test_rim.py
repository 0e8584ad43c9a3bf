"""The rim that a kit builds for an elastic design: glue between the held layers and the walls."""

import pytest

from foundation.errors import InputError
from geometry.fabrication.device import held_layer_names, lone_device, rim_gap_mm
from geometry.fabrication.frame_layout import frame_layout
from geometry.fabrication.parameters import Fabrication


def test_the_glue_line_of_an_elastic_rim_has_its_stiffness(make_segment):
    """t = G / k, beside the layers it holds; the film is not clamped."""
    elastic = make_segment(boundary="elastic", side_stiffness_N_per_mm3=4.0)
    made = Fabrication(rim_glue_modulus_MPa=0.5)
    assert rim_gap_mm(elastic, made) == pytest.approx(0.125)
    layout = frame_layout(lone_device(elastic), made)
    assert layout.ring[-1].gap == pytest.approx(0.125)
    assert "film" not in held_layer_names(elastic)
    assert rim_gap_mm(make_segment(), Fabrication(glue_gap_mm=0.2)) == 0.2


@pytest.mark.parametrize(
    ("boundary", "stated"), [("elastic", {"glue_gap_mm": 0.2}), ("clamped", {"rim_glue_modulus_MPa": 0.5})]
)
def test_a_number_of_the_glue_that_its_boundary_does_not_use_is_refused(make_segment, boundary, stated):
    stiffness = {"side_stiffness_N_per_mm3": 4.0} if boundary == "elastic" else {}
    with pytest.raises(InputError, match=f"{next(iter(stated))} = .* not used .* '{boundary}'"):
        rim_gap_mm(make_segment(boundary=boundary, **stiffness), Fabrication(**stated))


def test_a_rim_too_stiff_or_too_soft_to_fill_is_refused(make_segment):
    with pytest.raises(InputError, match=r"rim_glue_modulus_MPa = 0.5: .* 0.005 mm, .* between 5 and 150"):
        rim_gap_mm(
            make_segment(boundary="elastic", side_stiffness_N_per_mm3=100.0), Fabrication(rim_glue_modulus_MPa=0.5)
        )
