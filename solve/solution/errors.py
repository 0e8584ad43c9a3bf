"""Why a press ends without an equilibrium: Newton does not converge, or a dot that a force pushes loses contact."""

from foundation.arrays import Floats


class NoEquilibriumError(RuntimeError):
    """Newton did not converge; says why, and at which node the forces are least in balance."""

    def __init__(self, reason: str, x: Floats, worst: int | None) -> None:
        super().__init__(reason)
        self.x, self.worst = x, worst


class LostContactError(NoEquilibriumError):
    """A force pushes the dot, and nothing pushes back."""
