"""Memory is estimated and refused before the work."""

import numpy as np
import pytest

from foundation.errors import InputError
from softdot import memory
from softdot.cli import main
from tests.cases import for_each


def test_the_estimate_agrees_with_the_measured_peaks():
    """docs/speed.md: presses of cubes; solver alone, so that a run may need half a GB more."""
    for elements, measured_GB in [(13_182, 0.93), (34_992, 2.49), (63_888, 4.82)]:
        assert measured_GB < memory.needed_GB(elements, sliced=False) < measured_GB + 1.0


def test_more_than_the_limit_is_refused_by_name(monkeypatch):
    monkeypatch.setattr(memory, "_limits", lambda: iter([("this job", 4.0, 0.0)]))
    memory.refuse_too_little_memory(30_000, False, "element_size_mm", 0.2)
    with pytest.raises(InputError, match=r"mesh\.element_size_mm = 0\.1: .* GB of memory, and this job leaves 4 GB"):
        memory.refuse_too_little_memory(100_000, False, "element_size_mm", 0.1)


@for_each("factor", [100, 1000])
def test_a_segment_of_metres_is_meshed_or_refused_but_never_fills_the_memory(factor):
    """All lengths times a factor, element sizes too: as many points as the segment of millimetres."""
    from geometry.dot_at_rest import resolve_dot
    from mesh.outline import stack_outline
    from mesh.sizing import background_mesh, sizing_field
    from softdot.config.loading import config_from

    tables = {
        "segment": {
            "length_mm": 2.5 * factor, "width_mm": 2.5 * factor, "medium1": {"thickness_mm": 0.5 * factor},
            "film": {"thickness_um": 28.0 * factor}, "medium2": {"thickness_mm": 2.0 * factor},
        },
        "dot": {"base_diameter_mm": 1.5 * factor, "height_mm": 0.5 * factor},
        "mesh": {"element_size_mm": 0.3 * factor, "contact_element_size_mm": 0.1 * factor},
    }  # fmt: skip
    config = config_from(tables)
    stack = stack_outline(config.segment, film_thickness_mm=0.0)
    points, _, _ = background_mesh(stack, sizing_field(stack, resolve_dot(config.dot, config.segment), config.mesh))
    assert len(points) < 400_000
    assert np.ptp(points, axis=0) == pytest.approx([2.5 * factor, 2.5 * factor, 2.5 * factor], rel=0.2)


def test_metres_in_elements_of_a_tenth_of_a_millimetre_are_refused(tmp_path, capfd):
    config = tmp_path / "metres.toml"
    config.write_text(
        "[segment]\nlength_mm = 2500.0\nwidth_mm = 2500.0\n[segment.medium1]\nthickness_mm = 500.0\n"
        "[segment.film]\nthickness_um = 28.0\n[segment.medium2]\nthickness_mm = 2000.0\n",
        "utf-8",
    )
    assert main(["run", str(config), "-o", str(tmp_path / "out")]) == 2
    assert capfd.readouterr().err.count("\n") == 1
