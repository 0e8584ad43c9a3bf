"""Coupon recordings in memory."""

import numpy as np

from diagnose.engines.coupon.engine import coupon_engine
from diagnose.signals.recording import Recording, Run, Specimen
from solve.materials.parameters import NeoHookean

TIME = np.linspace(0.0, 20.0, 401)
TRAVEL = np.interp(TIME, [0.0, 1.0, 8.0, 9.0, 12.0, 13.0, 20.0], [0.0, 8.0, 8.0, 0.0, 0.0, 8.0, 8.0])
RUBBER = NeoHookean(youngs_modulus_MPa=1.2, poisson_ratio=0.499)


def silent(*_):
    """A report that nobody reads."""


def specimen(kind="tension"):
    """Its travel of 8 mm is a strain of 0.4."""
    thickness_mm = 2.0 if kind == "tension" else 20.0
    return Specimen(kind=kind, material="mine", length_mm=20.0, width_mm=5.0, thickness_mm=thickness_mm)


def run(travel=TRAVEL, force=None, drive="displacement_mm", **others):
    """One run; a force that is not given is made up."""
    force = 0.5 * travel if force is None else force
    channels = {"displacement_mm": travel, "force_N": force}
    there = {name: np.ones(len(travel), dtype=bool) for name in channels}
    none = {name: ~flags for name, flags in there.items()}
    return Run("run", "run.csv", TIME, drive, channels, there, none, **others)


def engine(kind="tension", material=RUBBER, drive="displacement_mm"):
    """Of one run."""
    return coupon_engine(Recording((run(drive=drive),), specimen(kind)), {"mine": material}, silent)


def candidate(of, mechanism):
    """By its mechanism."""
    return next(one for one in of.candidates if one.mechanism == mechanism)
