"""A finger that carries the array over one Braille dot in MuJoCo; the kernel is its skin: it pushes back and it reads.

    pip install mujoco
    softdot array examples/array-cell.toml --kernel -o out
    python examples/robot/finger_mujoco.py out

MuJoCo moves the finger: a slide along x with a set speed, and one along z on which its weight rests, down to a stop
where the dot is as deep as the kernel goes. At each step the
kernel gives the force of the dot on the finger and the charge of every segment; at open circuit the voltage is Q / C.
The array faces down, so that its own y axis is the page's turned round.
"""

import sys

import mujoco
import numpy as np
from kernel_numpy import Kernel

MODEL = """
<mujoco>
  <option timestep="0.0005" gravity="0 0 -9.81"/>
  <worldbody>
    <body name="finger">
      <joint name="x" type="slide" axis="1 0 0"/>
      <joint name="z" type="slide" axis="0 0 1" damping="{damping}" limited="true" range="{lowest_m} 1"/>
      <geom type="box" size="0.003 0.004 0.002" mass="{mass}" contype="0" conaffinity="0"/>
    </body>
  </worldbody>
  <actuator><velocity joint="x" kv="1000"/></actuator>
</mujoco>
"""
STOP_SHARE = 0.95
"""Of the kernel's depth, at which the stop is."""


def slide(kernel, speed_mm_per_s, mass_kg=0.02, seconds=1.0, start_mm=(-4.0, 0.6), dot_mm=(0.0, 0.0, 0.5), damping=4.0):
    """Time (t,), place of the array's face x and z (t, 2) in mm, force (t,) in N, voltages (t, n).

    start_mm : x of the array's middle and height of its face above the page. dot_mm : x, y and height of the dot's tip.
    """
    deepest_mm = kernel.axes[2][-1]
    lowest_m = 1e-3 * (dot_mm[2] - STOP_SHARE * deepest_mm)
    model = mujoco.MjModel.from_xml_string(MODEL.format(mass=mass_kg, damping=damping, lowest_m=lowest_m))
    data = mujoco.MjData(model)
    data.qpos[:] = 1e-3 * np.array(start_mm)
    data.qvel[0] = data.ctrl[0] = 1e-3 * speed_mm_per_s
    rows = []
    while data.time < seconds:
        x, z = 1e3 * data.qpos
        depth = min(dot_mm[2] - z, deepest_mm)  # the stop gives a little
        charge, force = kernel.press(dot_mm[0] - x, -dot_mm[1], depth)
        data.qfrc_applied[1] = force
        mujoco.mj_step(model, data)
        rows.append((data.time, x, z, force, *(charge / kernel.capacitance_pF)))
    table = np.array(rows)
    return table[:, 0], table[:, 1:3], table[:, 3], table[:, 4:]


def main(folder):
    """Print what the segments read."""
    kernel = Kernel(folder)
    time_s, place_mm, force_N, voltage_V = slide(kernel, speed_mm_per_s=10.0)
    for number, label in enumerate(kernel.about["labels"]):
        first = int(np.abs(voltage_V[:, number]).argmax())
        print(f"{label}: {voltage_V[first, number]:+.2f} V at {time_s[first]:.3f} s, x = {place_mm[first, 0]:+.2f} mm")
    print(f"largest force {force_N.max():.3f} N")


if __name__ == "__main__":
    main(sys.argv[1])
