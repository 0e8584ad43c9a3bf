"""Spaces of points that take a second each, and an executor of no processes."""

import copy
from contextlib import contextmanager

from foundation.executor import HERE
from softdot.sweeps.points import solve_point
from softdot.warm_up import TINY_CONFIG

DEPTHS = "press.indentation_mm"


def space_of(*axes, **sweep):
    """Tables of a space of tiny points."""
    return {**copy.deepcopy(TINY_CONFIG), "sweep": {"axes": list(axes), **sweep}}


def depths(*values):
    """An axis of indentations."""
    return {"key": DEPTHS, "values": list(values)}


@contextmanager
def no_processes(_scheduler=None, _workers=None):
    """In place of softdot.executors.executor_for: this process."""
    yield HERE


def solved_here(_executor, configs, solve=solve_point):
    """In place of solve_all: one after the other."""
    for name, config in configs.items():
        yield name, solve(config)
