"""A press from its parts, for tests that have no configuration."""

from geometry.parameters import Dot
from solve import press as pressing
from solve.model import Model
from solve.physics import Physics


def press_segment(segment, materials, dot, press, tet_mesh, on_step=None, physics=None, readout=None, checkpoint=None):
    """Solve it; dot : a DotShape at rest."""
    model = Model(segment, materials, Dot(), press, readout, physics or Physics())
    return pressing.press_segment(model, tet_mesh, on_step, checkpoint, dot)
