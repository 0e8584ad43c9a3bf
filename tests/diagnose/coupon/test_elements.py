"""The material point is what the 3D elements find for a coupon that deforms uniformly, memory included."""

import numpy as np
import pytest

from diagnose.engines.coupon.kinematics import SimpleShear, Uniaxial
from diagnose.engines.coupon.point import MaterialPoint, earlier_peaks, soften
from diagnose.engines.coupon.relaxation import Relaxation
from solve.materials.inelastic import StressResponse
from solve.materials.laws import InvariantLaw
from solve.materials.mullins import Softening
from solve.materials.multiplicative import MultiplicativeMaxwell
from solve.materials.prony import Prony
from solve.terms.solid import solid_region
from tests.cases import for_each
from tests.solve.box import box
from tests.solve.trial import trial

SIZE = (2.0, 1.0, 1.5)
LAW = InvariantLaw(0.4, 0.0, 0.05, 0.01, 20.0)
SOFTENING, SERIES = Softening(0.3, 0.01, 0.4), Prony((0.3, 0.2), (0.3, 2.0))
FLOWING = MultiplicativeMaxwell((0.3, 0.2), (0.3, 2.0), 0.7)
TIME = np.array([0.0, 0.2, 0.5, 1.0, 1.2, 1.6, 2.5, 2.7, 3.5])
STRAIN = np.array([0.0, 0.2, 0.5, 0.5, 0.3, 0.1, 0.1, 0.4, 0.6])


class Coupon:
    """Four dozen distorted tetrahedra; held : (n, 3) which displacements are prescribed."""

    def __init__(self, held, series):
        self.points, tets = box(2, SIZE, jitter=0.2)
        corners, local = np.unique(tets[:, :4], return_inverse=True)
        nodes = np.arange(3 * len(self.points)).reshape(-1, 3)
        dofs = np.concatenate([nodes[tets].reshape(-1, 30), nodes.size + local.reshape(-1, 4)], axis=1)
        self.free = np.flatnonzero(np.append(~held(self.points).ravel(), np.ones(len(corners), bool)))
        laws = SOFTENING, series.around(LAW, 1.0)
        self.solid = solid_region("coupon", LAW, self.points, tets, dofs, laws)
        self.x = np.zeros(nodes.size + len(corners))
        self.history = self.solid.start()

    def forces(self, displacement, time_step):
        """Nodal forces (n, 3) in balance; displacement (n, 3) is prescribed, or a start where it is free."""
        self.x[: displacement.size] = displacement.ravel()
        for _ in range(20):
            state = trial(self.x[: displacement.size].reshape(-1, 3), self.x, time_step)
            residual, tangent = self._assembled(state)
            if np.abs(residual[self.free]).max() < 1e-12:
                break
            self.x[self.free] -= np.linalg.solve(tangent[np.ix_(self.free, self.free)], residual[self.free])
        self.history = self.solid.advance(state, self.history)
        return residual[: displacement.size].reshape(-1, 3)

    def _assembled(self, state):
        residual, upper = np.zeros(len(self.x)), np.zeros((len(self.x),) * 2)
        for block in self.solid.elements(state, self.history):
            for matrix, vector, dofs in zip(block.matrices, block.residuals, self.solid.dofs[block.part], strict=True):
                residual[dofs] += vector
                full = np.triu(matrix) + np.triu(matrix, 1).T
                upper[np.ix_(dofs, dofs)] += full
        return residual, upper


def grips(points):
    """The ends along x, free to contract; symmetry planes against rigid motion."""
    held = np.zeros((len(points), 3), bool)
    held[:, 0] = (points[:, 0] < 1e-9) | (points[:, 0] > SIZE[0] - 1e-9)
    held[:, 1], held[:, 2] = points[:, 1] < 1e-9, points[:, 2] < 1e-9
    return held


def everywhere(points):
    """The whole surface, as in a layer that goes on beyond it."""
    inner = ((points > 1e-9) & (points < np.array(SIZE) - 1e-9)).all(axis=1)
    return np.tile(~inner[:, None], (1, 3))


@pytest.mark.press
@for_each("series", [SERIES, FLOWING])
def test_a_strip(series):
    coupon, found = Coupon(grips, series), []
    for strain, step in zip(STRAIN, np.diff(TIME, prepend=0.0), strict=True):
        thinner = (1.0 + strain) ** -0.4 - 1.0
        displacement = coupon.points * [strain, thinner, thinner]
        end = coupon.points[:, 0] > SIZE[0] - 1e-9
        found.append(coupon.forces(displacement, step)[end, 0].sum())
    point = MaterialPoint(Uniaxial(1.0, SIZE[0], SIZE[1] * SIZE[2]), LAW, 0.48, SOFTENING, series)
    np.testing.assert_allclose(point.answer(TIME, SIZE[0] * STRAIN, "displacement_mm"), found, rtol=1e-9, atol=1e-11)


@pytest.mark.press
@for_each("series", [SERIES, FLOWING])
def test_a_sheared_layer(series):
    coupon, found = Coupon(everywhere, series), []
    for strain, step in zip(STRAIN, np.diff(TIME, prepend=0.0), strict=True):
        displacement = np.zeros_like(coupon.points)
        displacement[:, 0] = strain * coupon.points[:, 1]
        forces, y = coupon.forces(displacement, step), coupon.points[:, 1]
        found.append((forces[:, 0] * y).sum() / SIZE[1])  # the virtual work of a further shear
    point = MaterialPoint(SimpleShear(SIZE[1], SIZE[0] * SIZE[2]), LAW, 0.48, SOFTENING, series)
    np.testing.assert_allclose(point.answer(TIME, SIZE[1] * STRAIN, "displacement_mm"), found, rtol=1e-9, atol=1e-11)


@for_each("law", [SERIES, SOFTENING])
def test_a_whole_history_is_what_the_law_makes_step_by_step(law):
    rng = np.random.default_rng(0)
    stress, energy = rng.standard_normal((40, 6)), rng.uniform(0.0, 1.0, 40)
    time = np.concatenate([[0.0], np.cumsum(rng.uniform(0.0, 1.0, 39))])
    memory, found = law.start(1), []
    for n, step in enumerate(np.diff(time, prepend=0.0)):
        one = StressResponse(stress[n : n + 1], np.eye(6)[None], energy[n : n + 1])
        response, memory = law.update(one, memory, step)
        found.append(response.stress[0])
    if law is SERIES:
        whole = Relaxation.from_series(law, time).relaxed_stress(stress)
    else:
        elastic = StressResponse(stress, np.tile(np.eye(6), (40, 1, 1)), energy)
        whole = soften(law, elastic, earlier_peaks(energy)).stress
    np.testing.assert_allclose(whole, found, rtol=1e-13, atol=1e-14)
