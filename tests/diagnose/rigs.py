"""Small recordings on disk for the tests."""

import numpy as np

from tests.softdot.conftest import MINIMAL

HEAD = 'format = "softdot-recording/1"\n'
SEGMENT = MINIMAL
RUN = '[[runs]]\nfile = "press.csv"\n'
COUPON = "[specimen]\nkind = 'tension'\nmaterial = 'rubber'\nlength_mm = 20.0\nwidth_mm = 5.0\nthickness_mm = 2.0\n"


def trapezoid(time_s, depth, touch_s=1.0, rise_s=0.2, hold_s=0.5, clear=-0.2):
    """A press from clear of the dot to a depth and back."""
    corners = np.array([touch_s, touch_s + rise_s, touch_s + rise_s + hold_s, touch_s + 2 * rise_s + hold_s])
    reach = rise_s * -clear / depth  # the travel before the touch has the speed of the loading
    times = [corners[0] - reach, *corners[1:3], corners[3] + reach]
    return np.interp(time_s, times, [clear, depth, depth, clear])


def samples(rows=400, rate_Hz=100.0, seed=0):
    """A press at 100 Hz and a voltage with noise."""
    rng = np.random.default_rng(seed)
    time = np.arange(rows) / rate_Hz
    depth = trapezoid(time, 0.3)
    voltage = np.clip(depth, 0.0, None) + 0.001 * rng.standard_normal(rows)
    return {"time_s": time, "displacement_mm": depth, "voltage_V": voltage}


def csv_text(columns):
    """The text of a CSV file."""
    rows = zip(*columns.values(), strict=True)
    return "\n".join([",".join(columns), *(",".join(f"{value:.9g}" for value in row) for row in rows)]) + "\n"


def write_rig(folder, rig=HEAD + SEGMENT + RUN, **files):
    """A recording folder; files : name without ending -> text or columns."""
    folder.mkdir(exist_ok=True)
    (folder / "rig.toml").write_text(rig, "utf-8")
    for name, content in (files or {"press": samples()}).items():
        text = content if isinstance(content, str) else csv_text(content)
        (folder / f"{name}.csv").write_text(text, "utf-8")
    return folder
