"""The work that friction loses, which the solver itself does not need."""

import numpy as np


def slip_work(term, trial, friction_before):
    """-sum_i int tau_i . dd_i over a converged step by the trapezoidal rule, in solver units.

    Of second order in the step, as the work of the dot is. friction_before : (c, 3) at its beginning.
    """
    mean = 0.5 * (friction_before + trial.x[term.friction_dofs])
    return -float(np.vdot(mean, term._nodal(trial).moved))
