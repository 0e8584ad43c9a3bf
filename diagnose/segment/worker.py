"""A process that presses the 3D model: jobs come in on standard input, answers go out on standard output.

Started with one argument: the process number of its parent.
"""

import os
import pickle
import sys

from diagnose.segment import store
from diagnose.segment.presses import Job
from diagnose.segment.reduction import Reduction
from geometry.processes import end_with_parent
from mesh.types import Floats
from solve.solution.newton import NoEquilibriumError


def answer(job: Job | Reduction) -> Floats | Exception:
    """Outputs, or the error that can be sent."""
    try:
        return job.run() if isinstance(job, Reduction) else _pressed(job)
    except (NoEquilibriumError, ValueError) as error:
        return RuntimeError(str(error))


def _pressed(job: Job) -> Floats:
    """Outputs; equilibria are left where other presses find them."""
    outputs, found = job.run(store.equilibria(job.guided_by) if job.guided_by else None)
    if found is not None:
        store.keep_equilibria(store.key(job), found)
    return outputs


def work() -> None:
    """Answer jobs on standard input until it ends. What libraries print goes to standard error."""
    end_with_parent(int(sys.argv[1]))
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    while True:
        try:
            job = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        pickle.dump(answer(job), answers)
        answers.flush()


if __name__ == "__main__":
    work()
