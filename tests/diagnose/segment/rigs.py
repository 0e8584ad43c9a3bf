"""A coarse plane-strain rig and recordings of it, made up, for the tests of its engine."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from diagnose.engines.segment import prepared
from diagnose.engines.segment.engine import segment_engine
from diagnose.signals.recording import Recording, Run
from mesh.options import MeshOptions
from softdot.config.loading import config_from
from softdot.config.model import model_of
from solve.model import Model, Readout

TABLES = {
    "segment": {
        "section": "plane-strain", "effector": {"height_mm": 1.0}, "medium1": {"thickness_mm": 0.5},
        "film": {"thickness_um": 28.0}, "medium2": {"thickness_mm": 2.0},
    },
    "dot": {"shape": "ridge"},
    "materials": {"vnr": {"model": "neo-hookean", "youngs_modulus_MPa": 5.0}},
}  # fmt: skip
COARSE = MeshOptions(element_size_mm=0.9, contact_element_size_mm=0.35)
LEAKY = Readout(input_resistance_MOhm=1000.0, input_capacitance_pF=100.0)
DEPTH_MM = 0.25


def model(**tables) -> Model:
    """The paper's segment as a slice, with changes to the tables of its configuration."""
    return model_of(config_from({**TABLES, **tables}))


def press(time_s, depth_mm=DEPTH_MM, touch_s=0.3, rise_s=0.2, hold_s=0.4, clear_mm=-0.05):
    """Down, hold, up: mm from the first touch."""
    reach = rise_s * -clear_mm / depth_mm
    ends = np.cumsum([touch_s, rise_s, hold_s, rise_s])
    return np.interp(time_s, [ends[0] - reach, *ends[1:3], ends[3] + reach], [clear_mm, depth_mm, depth_mm, clear_mm])


def run(drive="displacement_mm", values=None, label="one", **changes) -> Run:
    """A run whose answers are all zero; values : of the drive, a press by default."""
    time = np.arange(0.0, 1.6, 0.002)
    values = press(time) if values is None else values
    other = "force_N" if drive == "displacement_mm" else "displacement_mm"
    channels = {drive: values, other: np.zeros(len(time)), "voltage_V": np.zeros(len(time))}
    there = {name: np.ones(len(time), bool) for name in channels}
    nowhere = {name: np.zeros(len(time), bool) for name in channels}
    return Run(label, f"{label}.csv", time, drive, channels, there, nowhere, **{"readout": LEAKY, **changes})


def silent(*_):
    """No progress."""


@contextmanager
def without_memory() -> Iterator[None]:
    """Rigs of which no layer may relax: their baseline takes one press, not the 23 of what four layers remember."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(prepared, "relaxable", lambda _: ())
        yield


def engine(*runs, **tables):
    """The engine of a recording of these runs."""
    return segment_engine(model(**tables), COARSE, Recording(runs or (run(),)), silent)


def candidate(of, mechanism, component):
    """One of an engine's candidates."""
    return next(c for c in of.candidates if c.name == (mechanism, component))
