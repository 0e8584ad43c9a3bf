"""The one exception of the meshers."""


class MeshingError(RuntimeError):
    """A mesh could not be made: one sentence, what happened and what to change. The command exits with 3."""
