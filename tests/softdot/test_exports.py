"""softdot export: the netlist against ngspice, the skin against the kernel, and the robot's scripts as a user calls
them.
"""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from export.netlist import netlist
from foundation.errors import InputError
from softdot.cli import main
from softdot.robot.skin import RobotSkin
from softdot.spice_folder import write_spice
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import amplify
from solve.readout.channel_parts import Coupling, MutualCapacitance
from solve.readout.channels import amplify_channels
from solve.readout.filters import Filter
from solve.readout.stages import Hum, Saturation
from tests.cases import for_each
from tests.softdot.reading.made_kernel import made_kernel

ROOT = Path(__file__).parents[2]
TIME_S = np.linspace(0.0, 1.0, 201)
CHARGE_C = 1e-9 * np.clip(np.sin(3.5 * TIME_S), 0.0, None) ** 2
FILM_F = 24e-12
PART = {"gain": 3.0, "bandwidth_Hz": 100.0, "input_capacitance_pF": 8.0, "adc_bits": 16, "adc_range_V": 1.0}
KNEE = Physics(stages=(Hum(5.0, 0.05), Saturation(1.2, 2.5), Filter(40.0, 2, quality=0.5, delay_s=0.02)))


def simulated(text, folder):
    """Times (t,) and voltages (t, n) that ngspice calculates."""
    (folder / "sensor.cir").write_text(text, "utf-8")
    raw = folder / "out.raw"
    told = subprocess.run(["ngspice", "-b", "-r", raw, folder / "sensor.cir"], capture_output=True, text=True)
    assert raw.exists(), told.stdout + told.stderr
    head, _, body = raw.read_bytes().partition(b"Binary:\n")
    many = int(head.decode().split("No. Variables:")[1].split()[0])
    table = np.frombuffer(body).reshape(-1, many)
    return table[:, 0], table[:, 1:]


@pytest.mark.process
@pytest.mark.skipif(shutil.which("ngspice") is None, reason="ngspice is missing")
@for_each(
    ("readout", "physics"),
    [
        (Readout(input_resistance_MOhm=100.0, input_capacitance_pF=76.0), Physics()),
        (Readout(input_capacitance_pF=76.0, low_pass_Hz=20.0, filter_order=4, amplifier=PART), KNEE),
        (Readout(
            mode="charge", feedback_pF=1000.0, feedback_MOhm=1000.0, low_pass_Hz=30.0, high_pass_Hz=0.5, filter_order=5,
            polarity=-1, amplifier=PART,
        ), KNEE),
    ],
)  # fmt: skip
def test_ngspice_calculates_the_same_voltage(readout, physics, tmp_path):
    time, (voltage,) = (each.T for each in simulated(
        netlist(TIME_S, {"film": CHARGE_C}, {"film": FILM_F}, readout, physics), tmp_path))  # fmt: skip
    fine = np.linspace(0.0, 1.0, 20_001)
    ours = amplify(fine, PchipInterpolator(TIME_S, CHARGE_C)(fine), FILM_F, readout, physics)
    assert np.abs(voltage - np.interp(time, fine, ours)).max() < 1e-3 * np.abs(ours).max()


@pytest.mark.process
@pytest.mark.skipif(shutil.which("ngspice") is None, reason="ngspice is missing")
def test_ngspice_ties_channels_together_as_we_do(tmp_path):
    readout = Readout(input_resistance_MOhm=200.0, input_capacitance_pF=30.0)
    physics = Physics(channels=(MutualCapacitance(1, 2, 12.0),))
    told = {"left": CHARGE_C, "right": 0.0 * CHARGE_C}
    time, voltage = simulated(netlist(TIME_S, told, dict.fromkeys(told, FILM_F), readout, physics), tmp_path)
    fine = np.linspace(0.0, 1.0, 20_001)
    charge = np.column_stack([PchipInterpolator(TIME_S, one)(fine) for one in told.values()])
    ours = amplify_channels(fine, charge, np.full(2, FILM_F), readout, physics)
    for one, other in zip(voltage.T, ours, strict=True):
        assert np.abs(one - np.interp(time, fine, other)).max() < 1e-3 * np.abs(ours).max()


def test_a_netlist_refuses_by_name_what_it_cannot_hold(tmp_path):
    with pytest.raises(InputError, match="crosstalk into 'channel-1' is not written as a netlist"):
        netlist(TIME_S, {"a": CHARGE_C}, {"a": FILM_F}, Readout(), Physics(channels=(Coupling(1, 0.1),)))
    with pytest.raises(InputError, match=r"holds no summary\.json"):
        write_spice(tmp_path, tmp_path / "out")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A kernel that no solver made, in a folder."""
    here = tmp_path_factory.mktemp("kernel")
    made_kernel().save(here)
    return here


def test_a_skin_reads_the_kernel_behind_its_amplifiers_fast_enough(folder, tmp_path, capsys):
    assert main(["export", "robot", str(folder), "-o", str(tmp_path / "out"), "--json"]) == 0
    told, kernel = json.loads(capsys.readouterr().out), made_kernel()
    assert told["readings_per_s"] > 20_000
    skin, random = RobotSkin(tmp_path / "out"), np.random.default_rng(1)
    for x, y, depth in random.uniform([-4.9, -5.4, -0.05], [4.9, 5.4, 0.3], (50, 3)):
        charge, force = kernel.of_one(np.array(x), np.array(y), np.array(depth))
        found, push = skin.press(x, y, depth)
        np.testing.assert_allclose(found, charge, rtol=1e-5, atol=1e-5)
        assert push == pytest.approx(float(force), rel=1e-5, abs=1e-6)
    step, constant = 1e-3, np.array(skin.time_constant_s)
    first = skin.read(np.full(6, 30.0), step)  # a ramp over one step, then nothing new
    later = [skin.read(np.full(6, 30.0), step) for _ in range(5)][-1]
    np.testing.assert_allclose(first, 30.0 / skin.capacitance_pF * constant / step * (1.0 - np.exp(-step / constant)))
    np.testing.assert_allclose(later, first * np.exp(-5.0 * step / constant))


@pytest.mark.process
@for_each("script", ["exported", "example"])
def test_a_finger_slides_over_a_dot_as_documented(script, folder, tmp_path):
    if script == "exported":
        assert main(["export", "robot", str(folder), "-o", str(tmp_path / "out"), "-q"]) == 0
        command = [sys.executable, str(tmp_path / "out" / "slide.py")]
    else:
        command = [sys.executable, str(ROOT / "examples" / "robot" / "finger_mujoco.py"), str(folder)]
    told = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert told.returncode == 0, told.stderr
    assert "deeper than the kernel" not in told.stdout
    most = {
        line.partition(":")[0]: abs(float(line.split()[1])) for line in told.stdout.splitlines() if " V at " in line
    }
    assert len(most) == 6
    assert min(most["segment-r2c1"], most["segment-r2c2"]) > 2.0 * max(most["segment-r1c1"], most["segment-r3c2"])
