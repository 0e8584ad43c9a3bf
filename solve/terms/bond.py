"""A compliant adhesive of no thickness between two matched faces, elastic or viscous.

Energy per undeformed area, with the jump d and its opening d . n along the deformed normal (solve.terms.jump):
    psi = ks |d|^2 / 2 + (kn - ks) (d . n)^2 / 2
the elastic interface to which a thin soft layer tends (Klarbring, Int. J. Eng. Sci. 29, 1991; Geymonat, Krasucki
and Lenci, Math. Mech. Solids 4, 1999). It is blind to a rigid motion of both faces.

A viscous bond puts the Prony series of solve.materials.prony on d and on d . n. The memory of d keeps fixed axes:
it is objective as long as the bond turns little within its relaxation times, as it does in a clamped stack.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from solve.fem.quadrature import triangle
from solve.materials.inelastic import Inelastic, StressResponse, respond, rest_memories, time_error
from solve.terms.base import Block, History, Term, Trial
from solve.terms.jump import Jump, MatchedFacets, matched_facets


@dataclass(frozen=True)
class BondSprings(Term):
    """Springs without thickness between two matched faces. normal, shear : traction per jump in the solver's units;
    inelastic : laws with memory, none if elastic.
    """

    facets: MatchedFacets
    normal: float
    shear: float
    inelastic: tuple[Inelastic, ...] = ()

    @property
    def groups(self) -> tuple[Ints, ...]:
        """Unknowns of the facets, (k, 36), or (k, 18) on the ground."""
        return (self.facets.dofs,)

    def start(self) -> History:
        """Memory of every inelastic law, of d and d . n at the quadrature points."""
        return rest_memories(self.inelastic, self.facets.area.size, 4)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Matrices (k, w, w) and residuals (k, w) of the facets."""
        jump = self.facets.jump(trial.displacement)
        relaxed, instant, _ = self._relax(jump, history, trial.time_step)
        normal = self.normal - self.shear
        force = normal * relaxed[..., 3]
        gradient = force[..., None] * jump.slope
        gradient[..., :3] += self.shear * relaxed[..., :3]
        hessian = normal * instant * jump.slope[..., :, None] * jump.slope[..., None, :]
        hessian += force[..., None, None] * jump.curvature
        hessian[..., :3, :3] += self.shear * instant * np.eye(3)
        matrices, residuals = self.facets.tangent(hessian), self.facets.residual(gradient)
        yield Block(0, slice(0, len(residuals)), matrices, residuals)

    def advance(self, trial: Trial, history: History) -> History:
        """Memory at the converged jump."""
        return self._relax(self.facets.jump(trial.displacement), history, trial.time_step)[2]

    def time_error(self, history: History, new: History, time_step: float, after_kink: bool) -> float:
        """Error of the time integration in this step, relative to the largest jump."""
        return time_error(self.inelastic, history, new, time_step, after_kink)

    def _relax(self, jump: Jump, history: History, time_step: float) -> tuple[Floats, float, History]:
        """Relaxed (d, d . n) (k, q, 4), its derivative by the jump, and the new memory."""
        jumps = np.concatenate([jump.d, jump.opening[..., None]], axis=-1)
        instant = StressResponse(jumps.reshape(-1, 4), np.ones(1))
        response, memory = respond(self.inelastic, instant, history, time_step)
        return response.stress.reshape(jumps.shape), float(response.tangent[0]), memory


def bond(
    points: Floats,
    lower: Ints,
    upper: Ints,
    displacement_dofs: Ints,
    normal: float,
    shear: float,
    inelastic: tuple[Inelastic, ...] = (),
) -> BondSprings:
    """Bond the facets lower and upper (k, 6) of mesh.interfaces.split_interface; lower -1 is the rigid ground.

    points (n, 3) and the stiffnesses per area, normal and shear, in the solver's units. The rule of degree 4 is
    exact for the elastic bond of straight facets.
    """
    facets = matched_facets(points, lower, upper, displacement_dofs, triangle())
    return BondSprings(facets, normal, shear, inelastic)


def layer_stiffness(thickness_um: float, youngs_modulus_MPa: float, poisson_ratio: float) -> tuple[float, float]:
    """Normal and shear stiffness in N/mm3 of an adhesive layer: M / t and G / t.

    The faces keep a layer that is thin against its width from contracting sideways, so that the confined modulus
    M = E (1 - nu) / ((1 + nu) (1 - 2 nu)) counts and not E (the limit of Geymonat, Krasucki and Lenci, 1999).

    >>> normal, shear = layer_stiffness(50.0, 1.0, 0.25)  # M = 1.2 MPa and G = 0.4 MPa over 0.05 mm
    >>> round(normal, 6), round(shear, 6)
    (24.0, 8.0)
    """
    shear = youngs_modulus_MPa / (2.0 * (1.0 + poisson_ratio))
    confined = 2.0 * shear * (1.0 - poisson_ratio) / (1.0 - 2.0 * poisson_ratio)
    return confined / (1e-3 * thickness_um), shear / (1e-3 * thickness_um)
