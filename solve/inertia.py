"""The mass that moves with the dot where its path is prescribed: the force sensor reads F_contact + m a''."""

import numpy as np

from mesh.types import Floats
from solve.parameters import Press, Waveform
from solve.result import Trace
from solve.waveform import fraction


def prescribed_acceleration(press: Press, trace: Trace) -> Floats:
    """Second derivative (t,) of the prescribed path in m/s2, by central differences of the waveform.

    The interval is the smallest of the recorded ones: at a kink a finite sensor sees a finite pulse.
    """
    waveform, time = press.waveform or Waveform(), trace.time_s
    if len(time) < 2:
        return np.zeros_like(time)
    h = float(np.diff(time).min())
    depth = 1e-3 * press.depth_mm
    before, now, after = (fraction(waveform, time + shift) for shift in (-h, 0.0, h))
    return np.asarray(depth * (after - 2.0 * now + before) / h**2)
