"""A sensor skin from a kernel of softdot, with NumPy alone: forces on dots, and the voltages of all segments.

softdot export robot writes this file beside its tables; it needs nothing else of softdot. Places are of a dot's tip in
the frame of the array, in mm; its depth is below the resting top. Dots that press at once add up: that each finds a
surface which the others have pushed down is left out.
"""

import json
from bisect import bisect_right
from collections.abc import Iterable
from math import exp
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Dot = tuple[float, float, float]


class RobotSkin:
    """Tables of a kernel and the state of its amplifiers.

    too_deep : how often a dot was deeper than the tables go; it then reads as at their end.
    """

    def __init__(self, folder: Path | str) -> None:
        about = json.loads((Path(folder) / "robot.json").read_text("utf-8"))
        with np.load(Path(folder) / "kernel.npz") as tables:
            self.axes = [tables[name].astype(float).tolist() for name in ("x_mm", "y_mm", "depth_mm")]
            # charges of the n segments and the force, side by side, a row for each node
            both = np.concatenate([tables["charge_pC"], tables["force_N"][..., None]], axis=-1).astype(float)
        self.rows = np.ascontiguousarray(both.reshape(-1, both.shape[-1]))
        across, below = len(self.axes[1]) * len(self.axes[2]), len(self.axes[2])
        self._corners = np.array([i * across + j * below + k for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        self._apart = across, below
        self.labels: list[str] = about["labels"]
        self.gain: float = about["gain"]
        self.capacitance_pF = np.array(about["capacitance_pF"])
        self.time_constant_s: list[float] = [one if one is not None else np.inf for one in about["time_constant_s"]]
        self.too_deep = 0
        self.reset()

    def reset(self) -> None:
        """Let all amplifiers rest."""
        self._charge = np.zeros(len(self.labels))
        self._voltage = np.zeros(len(self.labels))

    def press(self, x_mm: float, y_mm: float, depth_mm: float) -> tuple[Floats, float]:
        """Charges (n,) in pC and force in N of one dot; nothing beside the tables and above the top."""
        xs, ys, depths = self.axes
        if depth_mm <= 0.0 or not (xs[0] <= x_mm <= xs[-1] and ys[0] <= y_mm <= ys[-1]):
            return np.zeros(len(self.labels)), 0.0
        if depth_mm > depths[-1]:
            self.too_deep += 1
            depth_mm = depths[-1]
        (i, u), (j, v), (k, w) = _bracket(xs, x_mm), _bracket(ys, y_mm), _bracket(depths, depth_mm)
        sides = (1.0 - u) * (1.0 - v), (1.0 - u) * v, u * (1.0 - v), u * v
        weights = np.array([side * share for side in sides for share in (1.0 - w, w)])
        across, below = self._apart
        found = weights @ self.rows[self._corners + (i * across + j * below + k)]
        return found[:-1], float(found[-1])

    def press_all(self, dots: Iterable[Dot]) -> tuple[Floats, list[float]]:
        """Charges (n,) in pC of all dots together, and the force in N on each; dots : x, y and depth of each."""
        charge, forces = np.zeros(len(self.labels)), []
        for dot in dots:
            own, force = self.press(*dot)
            charge += own
            forces.append(force)
        return charge, forces

    def read(self, charge_pC: Floats, step_s: float) -> Floats:
        """Voltages (n,) behind the amplifiers, a step after the last reading; the charge is linear in between."""
        change = (charge_pC - self._charge) / self.capacitance_pF
        for number, constant in enumerate(self.time_constant_s):
            gone = step_s / constant
            mean = 1.0 if gone < 1e-9 else (1.0 - exp(-gone)) / gone
            self._voltage[number] = exp(-gone) * self._voltage[number] + mean * change[number]
        self._charge = charge_pC
        return self.gain * self._voltage

    def attach(self, mujoco: Any, model: Any, site: str = "skin", prefix: str = "dot") -> None:
        """Let MuJoCo ask this skin for its forces, and for its voltages by the user sensor of the site's name.

        mujoco : the module. site : in the middle of the resting top, its z axis out of it. prefix : of the sites that
        are tips of dots. The callbacks are those of the process: one skin at a time.
        """
        here, body = model.site(site).id, model.site_bodyid[model.site(site).id]
        tips = [n for n in range(model.nsite) if model.site(n).name.startswith(prefix)]
        address = int(model.sensor_adr[model.sensor(site).id])
        state: dict[str, Any] = {"time": 0.0, "charge": np.zeros(len(self.labels))}

        def passive(_: Any, data: Any) -> None:
            turn, middle = data.site_xmat[here].reshape(3, 3), data.site_xpos[here]
            dots = [tuple((1e3 * ((data.site_xpos[tip] - middle) @ turn) * (1.0, 1.0, -1.0)).tolist()) for tip in tips]
            state["charge"], forces = self.press_all(dots)
            for tip, force in zip(tips, forces, strict=True):
                if force:
                    push, point = -force * turn[:, 2], data.site_xpos[tip]
                    mujoco.mj_applyFT(model, data, push, np.zeros(3), point, body, data.qfrc_passive)

        def sensor(_: Any, data: Any, stage: int) -> None:
            if stage != mujoco.mjtStage.mjSTAGE_ACC.value:
                return
            if data.time < state["time"]:
                self.reset()
            voltage = self.read(state["charge"], max(data.time - state["time"], 0.0))
            state["time"] = data.time
            data.sensordata[address : address + len(voltage)] = voltage

        mujoco.set_mjcb_passive(passive)
        mujoco.set_mjcb_sensor(sensor)


def _bracket(axis: list[float], place: float) -> tuple[int, float]:
    """Number of the node below and the share of the way to the next one."""
    number = min(bisect_right(axis, place) - 1, len(axis) - 2)
    return number, (place - axis[number]) / (axis[number + 1] - axis[number])
