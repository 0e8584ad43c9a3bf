"""Spaces of points that take a second each, and a cluster that is none."""

import copy
from contextlib import contextmanager
from types import SimpleNamespace

from softdot.sweeps.points import TINY, solve_point

DEPTHS = "press.indentation_mm"


def space_of(*axes, **sweep):
    """Tables of a space of tiny points."""
    return {**copy.deepcopy(TINY), "sweep": {"axes": list(axes), **sweep}}


def depths(*values):
    """An axis of indentations."""
    return {"key": DEPTHS, "values": list(values)}


@contextmanager
def no_cluster(_workers):
    """In place of a local cluster: one worker, this process."""
    yield SimpleNamespace(nthreads=lambda: {"here": 1})


def solved_here(_client, configs, solve=solve_point):
    """In place of solve_all: one after the other."""
    for name, config in configs.items():
        yield name, solve(config)
