"""How the calculation of a kit's tolerance budgets ended: complete, unfinished or failed, and why."""

from dataclasses import dataclass
from typing import Any, Literal

from mesh.types import MeshingError
from solve.solution.full_load import StoppedShortError
from solve.solution.linear import LinearSolveError


@dataclass(frozen=True)
class BudgetOutcome:
    """Outcome of the calculation of a tolerance budget.

    state : "unfinished" while it runs and after an interrupt. budget : as in kit.json. crosstalk : that of an array's
    crosstalk, None for one segment. note : for the build sheet, where one of them is missing. failure : for kit.json
    and the command line, in the solver's own words.
    """

    state: Literal["unfinished", "complete", "failed"]
    budget: dict[str, Any] | None = None
    crosstalk: dict[str, Any] | None = None
    note: str = ""
    failure: str | None = None


UNFINISHED = BudgetOutcome(
    "unfinished",
    note="The tolerance budget comes later: softdot kit is still pressing the simulated segment, which takes some "
    "minutes, and then writes the budget into this page. If the command has ended, it was interrupted; run it again. "
    "Everything else on this page is complete.",
)


def failed_budget(error: Exception) -> BudgetOutcome:
    """The outcome of a budget whose calculation ended in an error."""
    return BudgetOutcome(
        "failed",
        note=f"There is no tolerance budget, because {_reason(error)}. Everything else on this page is complete and "
        "does not depend on it. Try a smaller depth or force of the press or a finer mesh first; 'softdot run' with "
        "the same file tells more.",
        failure=f"tolerance budget: {error}",
    )


def _reason(error: Exception) -> str:
    """The cause of an error in words for the build sheet."""
    if isinstance(error, StoppedShortError):
        return "the simulated press did not reach its full load"
    if isinstance(error, MeshingError):
        return "no mesh could be made of elements as large as the budget uses"
    if isinstance(error, LinearSolveError):
        return "the simulated press could not be differentiated accurately enough"
    return "the simulation refuses the segment at one end of its tolerances"
