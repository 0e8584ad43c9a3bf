"""One set of samples, written as instruments write them in any unit, sign and encoding, is read as the same columns.

Factors of units are those of the SI brochure and of the pound and the standard weight; none is taken from the readers.
"""

import re
import sys

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from foundation.errors import InputError
from softdot.config.rig import load_rig
from softdot.convert import apart, files, read_log, read_mat, read_oscilloscope, run_text, write_recording
from tests.cases import for_each
from tests.diagnose.rigs import HEAD, SEGMENT, samples

ON_DISK = settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
COUNT = 6
TIME_S = 3600.0 * np.array([0.0, 1.0, 2.0, 3.0, 5.0, 8.0])
GRAVITY, POUND = 9.80665, 0.45359237
TIMES = {
    **dict.fromkeys(["s", "sec", "sec.", "S", "seconds"], 1.0),
    **dict.fromkeys(["ms", "msec", "milliseconds"], 1e3),
    **dict.fromkeys(["us", "µs", "μs", "microseconds"], 1e6),
    **dict.fromkeys(["ns", "nanosecond"], 1e9),
    **dict.fromkeys(["min", "minutes"], 1 / 60),
    **dict.fromkeys(["h", "hr", "Hours"], 1 / 3600),
}
VOLTS = {
    **dict.fromkeys(["nV", "nanovolts"], 1e9),
    **dict.fromkeys(["uV", "µV", "μV", "microvolt"], 1e6),
    **dict.fromkeys(["mV", "Millivolts"], 1e3),
    **dict.fromkeys(["V", "Volt", "volts"], 1.0),
    **dict.fromkeys(["kV", "kilovolts"], 1e-3),
}
FORCES = {
    **dict.fromkeys(["mN", "millinewtons"], 1e3), **dict.fromkeys(["N", "newton"], 1.0), "kN": 1e-3,
    **dict.fromkeys(["mgf", "mg"], 1e6 / GRAVITY), **dict.fromkeys(["gf", "g", "gram-force"], 1e3 / GRAVITY),
    **dict.fromkeys(["kgf", "kg", "kp", "kilogram-force"], 1 / GRAVITY),
    **dict.fromkeys(["ozf", "oz"], 16 / (POUND * GRAVITY)),
    **dict.fromkeys(["lbf", "lb", "lbs", "pound-force"], 1 / (POUND * GRAVITY)),
}  # fmt: skip
LENGTHS = {
    **dict.fromkeys(["mm", "millimeters"], 1.0), **dict.fromkeys(["um", "µm", "microns", "micrometre"], 1e3),
    "nm": 1e6, "cm": 0.1, **dict.fromkeys(["m", "metres"], 1e-3), **dict.fromkeys(["in", "inch", "inches"], 1 / 25.4),
}  # fmt: skip
QUANTITIES = {"CH2": VOLTS, "Load cell": FORCES, "Position": LENGTHS, "CH1": VOLTS, "Kraft": FORCES}
VALUES = {name: np.round(np.sin(np.arange(COUNT) + 2.0 * n), 6) for n, name in enumerate(QUANTITIES)}
BESIDE = {
    "brackets": "{} ({})", "tight": "{}({})", "square": "{} [{}]", "comma": "{}, {}", "slash": "{} / {}",
    "underscore": "{}_{}",
}  # fmt: skip


def shown(value, decimal):
    return f"{value:.12e}".replace(".", decimal)


@st.composite
def tables(draw):
    """Text, encoding and the names of the columns in a file of any instrument with a header."""
    names = draw(st.lists(st.sampled_from(list(QUANTITIES)), min_size=1, max_size=4, unique=True))
    units = {name: draw(st.sampled_from(list(QUANTITIES[name]))) for name in names}
    time = draw(st.sampled_from(list(TIMES)))
    separator, decimal = draw(st.sampled_from([(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ",")]))
    style = draw(st.sampled_from([*BESIDE, "row", "row of brackets"]))
    cells = [(draw(st.sampled_from(["Time", "time", "Elapsed Time", "t"])), time), *units.items()]
    if style.startswith("row"):
        rows = [[name for name, _ in cells], [f"({unit})" if style != "row" else unit for _, unit in cells]]
    else:
        rows = [[BESIDE[style].format(name, unit) for name, unit in cells]]
    if style == "comma" and separator == ",":
        rows = [[f'"{cell}"' for cell in row] for row in rows]
    columns = [TIMES[time] * TIME_S, *(QUANTITIES[name][unit] * VALUES[name] for name, unit in units.items())]
    rows += [[shown(value, decimal) for value in row] for row in zip(*columns, strict=True)]
    if draw(st.booleans()):
        rows.insert(0, ["Model", "X1"])
    text = "\n".join(separator.join(row) for row in rows) + draw(st.sampled_from(["", "\n", "\n\n"]))
    encodings = ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"]
    encodings += ["latin-1"] if "μ" not in text else []
    return text.replace("\n", draw(st.sampled_from(["\n", "\r\n"]))), draw(st.sampled_from(encodings)), names


@ON_DISK
@given(table=tables())
def test_units_signs_and_encodings_change_no_column(table, tmp_path):
    text, encoding, names = table
    (tmp_path / "log.csv").write_bytes(text.encode(encoding))
    found = read_oscilloscope(tmp_path / "log.csv")
    assert list(found) == ["time_s", *names]
    assert found["time_s"] == pytest.approx(TIME_S, rel=1e-9)
    for name in names:
        assert found[name] == pytest.approx(VALUES[name], rel=1e-9)


@for_each("quantity", ["Time", *QUANTITIES])
def test_every_unit_has_its_factor(quantity, tmp_path):
    for unit, factor in (TIMES if quantity == "Time" else QUANTITIES[quantity]).items():
        values = factor * np.array([1.0, 2.0, 4.0])
        rows = "".join(f"{value:.12e},{n}\n" for n, value in enumerate(values, 1))
        head = f"Time ({unit}),CH2 (V)" if quantity == "Time" else f"{quantity} ({unit}),Time (s)"
        (tmp_path / "log.csv").write_text(f"{head}\n{rows}", "utf-8")
        log = read_log(tmp_path / "log.csv")
        found = log.time_s if quantity == "Time" else log.channels[quantity].values
        assert found == pytest.approx([1.0, 2.0, 4.0], rel=1e-9), unit
        assert quantity == "Time" or log.channels[quantity].unit == {"P": "mm", "C": "V"}.get(quantity[0], "N")


def test_a_letter_is_a_time_only_by_its_unit(tmp_path):
    """And an inch by its sign."""
    head = 'Time (s);Temp (C);T_room (°C);x (mm);Position (")'
    (tmp_path / "log.csv").write_text(f"{head}\n0;21;22;3;1\n1;21;22;4;2\n", "utf-8")
    channels = read_log(tmp_path / "log.csv").channels
    assert {name: (one.unit, one.values[1]) for name, one in channels.items()} == {
        "Temp": ("C", 21.0), "T_room": ("C", 22.0), "x": ("mm", 4.0), "Position": ("mm", 50.8)
    }  # fmt: skip


@for_each("time", ["t (ms)", "x [ms]", "T, ms", "t_ms", "s/ms", "Elapsed time ms", "t msec"])
def test_times_by_a_letter(time, tmp_path):
    (tmp_path / "log.csv").write_text(f"{time};y (mV);x_mm\n0;1;5\n2;3;6\n", "utf-8")
    found = read_oscilloscope(tmp_path / "log.csv")
    assert {name: values[1] for name, values in found.items()} == {"time_s": 2e-3, "y": 3e-3, "x": 6.0}


def keysight(time, unit, rows):
    return f"x-axis,1,2\n{time},{unit},{unit}\n" + rows


def rigol(time, unit, rows):
    return f"X,CH1,CH2,\n{time},{unit},{unit},\n" + rows.replace("\n", ",\n")


def rigol_with_steps(time, unit, rows):
    return f"X,CH1,CH2,Start,Increment\n{time},{unit},{unit},-7.0,3.0\n" + rows


def tektronix(time, unit, rows):
    return f"Model,MSO24\nHorizontal Units,{time}\nVertical Units,{unit},{unit}\nLabel,,\n\nTIME,CH1,CH2\n" + rows


def siglent(time, unit, rows):
    settings_ = (
        f"Record Length,Analog:6\nVertical Units,CH1:{unit},CH2:{unit},\nHorizontal Units,{time}\nSource,CH1,CH2\n"
    )
    return settings_ + "Time,Value,Value\n" + rows


def lecroy(time, unit, rows):
    return f"# Source,CH1,CH2\n# Vertical Units,{unit},{unit}\n# Horizontal Units,{time}\nTime,Ampl,Ampl\n" + rows


def picoscope(time, unit, rows):
    return f"Time,CH1,CH2\n({time}),({unit}),({unit})\n\n" + rows


MADE_BY = (keysight, rigol, rigol_with_steps, tektronix, siglent, lecroy, picoscope)


@ON_DISK
@given(make=st.sampled_from(MADE_BY), time=st.sampled_from(list(TIMES)), unit=st.sampled_from(list(VOLTS)))
def test_units_of_an_oscilloscope_change_no_column(make, time, unit, tmp_path):
    columns = (TIMES[time] * TIME_S, VOLTS[unit] * VALUES["CH1"], VOLTS[unit] * VALUES["CH2"])
    rows = "".join(f"{a:.12e},{b:.12e},{c:.12e}\n" for a, b, c in zip(*columns, strict=True))
    (tmp_path / "scope.csv").write_text(make(time, unit, rows), "utf-8")
    found = read_oscilloscope(tmp_path / "scope.csv")
    assert list(found) == ["time_s", "CH1", "CH2"]
    for name, values in (("time_s", TIME_S), ("CH1", VALUES["CH1"]), ("CH2", VALUES["CH2"])):
        assert found[name] == pytest.approx(values, rel=1e-9)


def test_channels_side_by_side_are_not_lost(tmp_path):
    rows = [f"{word},,{n},{n}" for n, word in enumerate(("Record Length,3", "Source,CH1", "Vertical Units,V"))]
    for beside in ("", ","):  # a trailing comma is none
        (tmp_path / "tek.csv").write_text("".join(f"{row}{beside}\n" for row in rows), "utf-8")
        assert list(read_oscilloscope(tmp_path / "tek.csv")) == ["time_s", "CH1"]
    (tmp_path / "tek.csv").write_text("".join(f"{row},,{row}\n" for row in rows), "utf-8")
    with pytest.raises(InputError, match="row 1, column 6 and beyond: several channels side by side"):
        read_oscilloscope(tmp_path / "tek.csv")


@ON_DISK
@given(time=st.sampled_from(list(TIMES)), unit=st.sampled_from(list(VOLTS)))
def test_units_beside_samples_change_no_column(time, unit, tmp_path):
    """Tektronix TDS: settings in the first two columns, samples in the fourth and fifth."""
    words = ["Record Length,6", "Source,CH2", f"Horizontal Units,{time}", f"Vertical Units,{unit}", ",", ","]
    pairs = zip(words, TIMES[time] * TIME_S, VOLTS[unit] * VALUES["CH2"], strict=True)
    (tmp_path / "tek.csv").write_text("".join(f"{w},,{t:.12e},{v:.12e}\n" for w, t, v in pairs), "utf-8")
    found = read_oscilloscope(tmp_path / "tek.csv")
    assert found["time_s"] == pytest.approx(TIME_S, rel=1e-9)
    assert found["CH2"] == pytest.approx(VALUES["CH2"], rel=1e-9)


@pytest.mark.parametrize(
    "head",
    [
        "Time Unit,ms\nVertical Units,mV\nTime,CH1",
        "# HUnit: ms\n# VUnit: mV\nTime,CH1",
        "Units,ms,mV\nTime,CH1",
        "(ms),(mV)\nTime,CH1",
        "Horizontal Units,ms\nSample Interval,0.001\nVertical Units,CH2:V,CH1:mV\nTIME,CH1",
        "t / ms,U / mV",
        "Zeit;Spannung\nms;mV",
        "Messzeit_ms,Voltage_mV",
        "Elapsed ms,CH1 mV",
        "Index,Time (ms),CH1 (mV)",
    ],
)  # fmt: skip
def test_units_wherever_they_stand(head, tmp_path):
    sign = ";" if ";" in head else ","
    rows = "".join(sign.join(["7"] * head.startswith("Index") + [f"{n}", f"{n}.5"]) + "\n" for n in range(3))
    (tmp_path / "log.csv").write_text(f"{head}\n{rows}", "utf-8")
    found = read_oscilloscope(tmp_path / "log.csv")
    assert found.pop("time_s") == pytest.approx([0.0, 1e-3, 2e-3])
    (values,) = found.values()
    assert values == pytest.approx([0.5e-3, 1.5e-3, 2.5e-3])


def test_what_an_instrument_writes_beyond_its_range_is_missing(tmp_path):
    (tmp_path / "log.csv").write_text("Time(s),CH1(V)\n0,9.9E+37\n1,9.91E+37\n2,-9.9e37\n3,∞\n4,1\n", "utf-8")
    assert np.isnan(read_oscilloscope(tmp_path / "log.csv")["CH1"]).tolist() == [True, True, True, True, False]


@given(start=st.floats(-1.0, 1.0), step=st.floats(1e-6, 1.0), skipped=st.integers(0, 3))
@ON_DISK
def test_sequence_numbers_count_from_the_start(start, step, skipped, tmp_path):
    """Rows that are left out take their time with them."""
    head = f"X,CH1,Start,Increment\nSequence,Volt,{start:.9e},{step:.9e}\n"
    (tmp_path / "scope.csv").write_text(head + f"0,1\n1,2\n{2 + skipped},3\n", "utf-8")
    found = read_oscilloscope(tmp_path / "scope.csv")
    assert found["time_s"] == pytest.approx(start + step * np.array([0, 1, 2 + skipped]), rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a,b\n1,2\n", "row 1: no header of an oscilloscope or another instrument"),
        ("Time(s),CH1(A)\n0,1\n", "column 'CH1' is in 'A', a current"),
        ("Time(s),Acceleration (g)\n0,1\n", "column 'Acceleration' is in 'g', a mass or an acceleration"),
        ("Time(MS),CH1(V)\n0,1\n", "column 'Time' is in 'MS', which is not a known unit; known are ns, us"),
        ("Time(V),CH1(V)\n0,1\n", "column 'Time' is a time and must be in a unit of time"),
        ("Time(s),Force\n0,1\n", "column 'Force' has no unit; write it behind the name"),
        ("Time(s),CH1(V),CH1(mV)\n0,1,1\n", "two columns are called 'CH1'"),
        ("Time(s),CH1(V),Time(s)\n0,1,1\n", "two columns are times"),
        ("Time(s),CH1(V)\n(ms),(V)\n0,1\n", "column 'Time' has two units"),
        ("Time(s);CH1(V)\n0,5;1.5\n", "numbers have points (row 2: '1.5') and commas (row 2: '0,5')"),
        ("Time(s),CH1(V)\n0,001,0,5\n", "row 2: has 4 cells, the header has 2 columns"),
        ("Time(s),CH1(V)\n0,1\n1,over\n", "row 3, column 2 = 'over': must be a number"),
        ("Time(s),CH1(V)\n0,1\n0,2\n", "row 3, column 1 = '0': every sample needs its time, which rises"),
        ("X,CH1,Start,Increment\nSequence,Volt\n0,1\n", "row 2: start and increment of the time are missing"),
        ("Segments,2\nTime,Ampl\n0,1\n", "holds 2 segments one after the other"),
        ("Time(s),CH1 [V] (mV)\n0,1\n", "column 'CH1 [V] (mV)' has two units"),
        ("Time (s) ms,CH1(V)\n0,1\n", "column 'Time (s) ms' has two units"),
        ("Time(s),V_in\n0,1\n", "column 'V_in' has no unit"),
        ("Time(s),Force_min\n0,1\n", "column 'Force_min' has no unit"),
        ("Time(s),Duration (ms)\n0,1\n", "column 'Duration' is a second time"),
        ('Time(s),CH1(mV)\n0,"1,234"\n1,"2,345"\n', "may be of thousands, or have decimals (row 2: '1,234')"),
        ("Time(s);Load (g)\n0;998\n1;1.001\n", "may be of thousands, or have decimals (row 3: '1.001')"),
        ("Time(s),CH1(V)\n0,1e400\n", "row 2, column 2 = '1e400': is too large for a number"),
        ("Time(s),CH1(V)\nnan,1\n1,2\n", "row 2, column 1 = 'nan': every sample needs its time"),
        ("Time(s),CH1(V),\n0,1,7\n", "row 2, column 3 = '7': the header has no name for it"),
        ("Time,CH1\n(),(mV)\n0,1\n", "column 'Time' has no unit, and others have one in the row below"),
        ("Time,CH1\ns,foo\n0,1\n", "column 'CH1' is in 'foo', which is not a known unit"),
        ("timestamp,CH1\n1700000000000,1\n1700000000001,2\n", "1.7e+12 can be no seconds"),
        ("XINCREMENT,1e-3\nX,CH1\n0,1\n1,2\n", "its samples are 1 apart, and 'xincrement' above is 0.001 s"),
        ("# Sampling rate: 2 kHz\nTime,CH1\n0,1\n1,2\n", "and 'sampling rate' above is 0.0005 s"),
        ("Time,CH1 (V)\n45990.5,1\n45990.500001,2\n", "45990.5 may count days"),
        ("Time,CH1 (V)\n2026-10-25T02:59:59.1+02:00,1\n", "column 'Time' is a date or a clock, such as '2026-10-25T02"),
        ("Time;CH1\nhh:mm:ss;V\n23:59:59;1\n0:00:00;2\n", "column 'Time' is a date or a clock, such as '23:59:59'"),
        ("Time,CH1 (V)\n101558,1\n101559,2\n101600,3\n", "reads as a clock"),
        ("Time (s),CH1 (mV),CH2\n0,1,2\n", "column 'CH2' has no unit, and another voltage is not in V"),
        ("Length unit,mm\nTime,Load\n0,1\n", "column 'Load' has no unit"),
        ("XUnit,Hz\nYUnit,V\nX,CH1\n0,1\n", "column 'X' is in 'Hz', which is not a known unit"),
        ("Units,s,counts\nTime,CH1\n0,1\n", "column 'CH1' is in 'counts', which is not a known unit"),
        ("Unit,A\nTime,CH1\n0,1\n", "column 'CH1' is in 'A', a current"),
        ("Y Units,counts\nTime,CH1\n0,1\n", "column 'CH1' is in 'counts', which is not a known unit"),
        ("Horizontal Units,s\nTime unit,ms\nTime,CH1\n0,1\n", "column 'Time' has two units"),
        ("Sampling rate (Hz),1000\nTime,CH1\n0,1\n1,2\n", "and 'sampling rate' above is 0.001 s"),
        ("Vertical Units,V,mV\nTime,A,B,C\n0,1,2,3\n", "tell 2 units, V, mV, and not which of them is that of 'A'"),
    ],
)
def test_what_is_not_understood_is_refused_by_name(text, said, tmp_path):
    (tmp_path / "scope.csv").write_text(text, "utf-8")
    with pytest.raises(InputError, match=r"scope.csv'") as caught:
        read_oscilloscope(tmp_path / "scope.csv")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


@for_each("by", ["x10", "x1e-3", "*10", "/1000", "× 0.1", "per mm", "/ s", "²", "1e-3", "10:1"])
@for_each("name", ["Force (N) {}", "Force {} (N)", "Time [ms] {}"])
def test_a_factor_beside_a_unit_is_refused(name, by, tmp_path):
    if by in ("/ s", "per mm") and name.endswith("(N)"):
        return  # Force/s (N) is a name
    cells = [name.format(by), "Time (s)" if name.startswith("F") else "CH1"]
    (tmp_path / "log.csv").write_text(f"{','.join(cells)}\n1,2\n2,3\n", "utf-8")
    with pytest.raises(InputError, match="has a factor or a quotient in its name"):
        read_log(tmp_path / "log.csv")


@for_each("head", ["Stiffness N/mm", "Field V/mm", "Sensitivity_mV/N", "Speed mm/min", "N/mm", "Rate V/s"])
def test_a_quotient_of_units_is_not_the_unit_behind_its_slash(head, tmp_path):
    (tmp_path / "log.csv").write_text(f"Time (s),{head}\n0,1\n1,2\n", "utf-8")
    with pytest.raises(InputError, match=f"column '{head}' has (no unit|a factor or a quotient)"):
        read_log(tmp_path / "log.csv")


@for_each("unit", ["ticks", "samples", "days", "ps", "0.1ms", "counts", "HH:MM:SS", "centiseconds"])
@for_each("mark", ["_", " ", "/"])
def test_a_time_in_what_is_not_known_is_not_in_seconds(mark, unit, tmp_path):
    (tmp_path / "log.csv").write_text(f"Time{mark}{unit},CH1 (V)\n0,1\n1,2\n", "utf-8")
    with pytest.raises(InputError, match=r"what is behind its name is not a known unit|has a factor"):
        read_log(tmp_path / "log.csv")


@pytest.mark.parametrize(
    ("head", "unit", "first", "second"),
    [
        ("in ms,C1 in mV,C2 in V", "V", 1e-3, 2.0),
        ("millis,CH1 (mV),CH2 (V)", "V", 1e-3, 2.0),
        ("Time (ms),in (mV),out (V)", "V", 1e-3, 2.0),
        ("Time unit,ms\nCH1 unit,mV\nCH2 unit,V\nTime,CH2,CH1", "V", 1.0, 2e-3),
        ("Time(ms),CH1(mV),CH2(V),t0 =-1e-2, tInc = 1e-3,", "V", 1e-3, 2.0),
        ("Time unit,ms\nLength unit,um\nForce unit,kN\nTime,Force,Position", "N", 1e3, 2e-3),
        ("Time unit,ms\nTemperature unit,degC\nTrigger voltage unit,mV\nTime,CH1,CH2", "V", 1.0, 2.0),
        ("Time unit,ms\nTemperature unit,degC\nTime,A,B", "V", 1.0, 2.0),
        ("Delay unit,us\nTime unit,ms\nUnit under test,m\nTime,CH1,CH2", "V", 1.0, 2.0),
        ("Units,SI\nUnit,MSO24\nTime (ms),CH1 (V),CH2 (V)", "V", 1.0, 2.0),
        ("Time unit,ms\nSource,CH2,CH1\nVertical Units,mV,V\nTime,CH1,CH2", "V", 1.0, 2e-3),
    ],
)
def test_a_setting_is_of_what_it_names(head, unit, first, second, tmp_path):
    (tmp_path / "log.csv").write_text(f"{head}\n0,1,2\n1,1,2\n2,1,2\n", "utf-8")
    log = read_log(tmp_path / "log.csv")
    one, two = log.channels.values()
    assert log.time_s == pytest.approx([0.0, 1e-3, 2e-3])
    assert (one.unit, one.values[0], two.values[0]) == (unit, pytest.approx(first), pytest.approx(second))


VALID = (
    "Time(ms),CH1(V),Load cell (g)\n0,1,2\n1,2,3\n2,3,5\n",
    "Sample Interval,1e-3,s\nVertical Units,CH1:mV\nSource,CH1\nTime Unit,ms\nSecond,Value\n0,1\n1e-3,2\n",
    "# Rate: 1 kHz\nms;mV\nZeit;Kanal 1\n0,5;1,25\n1,5;-2,5\n",
    "X,CH1,Start,Increment\nSequence,Volt,-1,0.5\n0,1\n1,9.9E+37\n",
    "Record Length,3,,0,1\nHorizontal Units,s,,1,2\nVertical Units,V,,2,3\n",
)


@ON_DISK
@given(data=st.data())
def test_nothing_but_an_input_error_leaves_the_reader_of_text(data, tmp_path):
    kind = data.draw(st.sampled_from(["bytes", "text", "mutated"]))
    content = data.draw(st.sampled_from(VALID)).encode()
    if kind == "bytes":
        content = data.draw(st.binary(max_size=200))
    elif kind == "text":
        content = data.draw(st.text("0123456789.,;\t\n\"'()[]-+eEµμsVXTimeCH∞²٣ ", max_size=120)).encode()
    for _ in range(data.draw(st.integers(0, 4)) if kind == "mutated" else 0):
        place = data.draw(st.integers(0, len(content)))
        content = content[:place] + data.draw(st.binary(max_size=3)) + content[place + data.draw(st.integers(0, 3)) :]
    (tmp_path / "log.csv").write_bytes(content)
    try:
        found = read_log(tmp_path / "log.csv")
    except InputError:
        return
    assert np.isfinite(found.time_s).all()
    assert all(len(channel.values) == len(found.time_s) for channel in found.channels.values())


@pytest.mark.parametrize("name", ["a.mat", "a.tdms", "a.wfm", "a.xlsx", "a.doc"])
def test_nothing_but_an_input_error_leaves_readers_of_binary_files(name, tmp_path):
    (tmp_path / name).write_bytes(bytes(range(256)) * 3)
    with pytest.raises(InputError, match=rf"'.*{name}'"):
        read_mat(tmp_path / name, {"time_s": "t"}) if name == "a.mat" else read_log(tmp_path / name)


def test_every_ending_that_is_offered_has_a_reader(tmp_path, monkeypatch):
    """All binary files go to a process of their own."""
    asked = []
    monkeypatch.setattr(files, "read_in_own_process", lambda kind, file: asked.append((kind, file.suffix)) or {})
    with pytest.raises(InputError, match="must end with one of") as caught:
        read_log(tmp_path / "a.doc")
    endings = re.findall(r"\.\w+", str(caught.value).partition("must end with one of")[2].partition(";")[0])
    assert {".csv", ".txt", ".xlsx", ".tdms", ".lvm", ".wfm", ".isf", ".trc", ".bin", ".wvf"} <= set(endings)
    for ending in endings:
        (tmp_path / f"a{ending}").write_text("", "utf-8")
        with pytest.raises((InputError, KeyError)) as caught:
            read_log(tmp_path / f"a{ending}")
        assert "must end with one of" not in str(caught.value)
    assert {kind for kind, _ in asked} < set(apart.READERS)


def test_numbers_without_time_or_with_one_beside_the_samples(tmp_path):
    """A column of counts before the time is none of the channels; a cell that is empty or overflows is not measured."""
    text = "Index,Time(s),CH1(V),D0-D7\n1,0,1,00\n2,1,,01\n3,2,-∞,11\n4,3,\u22122e-1,00\n"
    (tmp_path / "log.csv").write_text(text, "utf-8")
    found = read_oscilloscope(tmp_path / "log.csv")
    assert list(found) == ["time_s", "CH1"]
    np.testing.assert_array_equal(found["CH1"], [1.0, np.nan, np.nan, -0.2])


def test_the_table_of_a_run_is_read_as_it_was_told(tmp_path):
    """With a name of a file and a label that TOML has to quote."""
    told = {"gain": 0.05, "modulus.medium1": 0.1}
    text = run_text("a.csv", 'the "first"', "force_N", temperature_C=21.5, nuisance=told, noise={"voltage_V": 0.002})
    columns = samples()
    columns["force_N"] = np.clip(columns["displacement_mm"], 0.0, None)
    write_recording(tmp_path / "out", HEAD + SEGMENT + text, {"a.csv": columns})
    (run,) = load_rig(tmp_path / "out").recording.runs
    assert (run.label, run.drive, run.temperature_C) == ('the "first"', "force_N", 21.5)
    assert (run.nuisance, run.noise) == (told, {"voltage_V": 0.002})
    assert run_text("a.csv", "b", "force_N").count("[") == 2


def test_a_reader_that_takes_its_interpreter_with_it_is_told(tmp_path, monkeypatch):
    (tmp_path / "a.mat").write_bytes(b"")
    monkeypatch.setattr(apart, "python_command", lambda *_: [sys.executable, "-c", "import os; os.abort()"])
    with pytest.raises(InputError, match="its reader broke down; is it damaged"):
        read_mat(tmp_path / "a.mat", {"time_s": "t"})


def test_labview_files(tmp_path):
    nptdms = pytest.importorskip("nptdms")
    pytest.importorskip("lvm_read")
    steps = {"wf_increment": 0.5, "wf_start_offset": 1.0, "wf_samples": 3}
    with nptdms.TdmsWriter(tmp_path / "a.tdms") as file:
        for name, unit in (("film", "mV"), ("Load cell", "g")):
            channel = nptdms.ChannelObject("daq", name, np.array([1.0, 2.0, 4.0]), {**steps, "unit_string": unit})
            file.write_segment([channel])
    lines = ["LabVIEW Measurement", "Separator\tTab", "Decimal_Separator\t,", "X_Columns\tOne", "Time_Pref\tRelative"]
    lines += ["***End_of_Header***\t", "\t", "Channels\t2\t\t", "Y_Unit_Label\tmV\tg\t", "***End_of_Header***\t\t\t"]
    lines += ["X_Value\tfilm\tLoad cell\tComment", "1,0\t1,0\t1", "1,5\t2,0\t2", "2,0\t4,0\t4"]
    (tmp_path / "a.lvm").write_text("\n".join(lines) + "\n", "utf-8")
    for name in ("a.tdms", "a.lvm"):
        found = read_log(tmp_path / name)
        assert found.time_s == pytest.approx([1.0, 1.5, 2.0])
        assert found.channels["film"].values == pytest.approx([1e-3, 2e-3, 4e-3])
        assert found.channels["Load cell"].values == pytest.approx([0.00980665, 0.0196133, 0.0392266])


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ({"wf_increment": 1e-9}, {"wf_increment": 2e-9}),
        ({"wf_start_offset": 1e6}, {"wf_start_offset": 1e6 + 5.0}),
        (
            {"wf_start_time": np.datetime64("2026-01-01T10:00:00")},
            {"wf_start_time": np.datetime64("2026-01-01T10:00:01")},
        ),
        ({"wf_xunit_string": "Hz"}, {"wf_xunit_string": "Hz"}),
    ],
)
def test_channels_of_labview_that_share_no_time_are_refused(first, second, tmp_path):
    nptdms = pytest.importorskip("nptdms")
    base = {"wf_increment": 0.5, "wf_start_offset": 0.0, "wf_samples": 3, "unit_string": "V"}
    with nptdms.TdmsWriter(tmp_path / "a.tdms") as file:
        for name, own in (("a", first), ("b", second)):
            file.write_segment([nptdms.ChannelObject("daq", name, np.array([1.0, 2.0, 4.0]), base | own)])
    with pytest.raises(InputError, match=r"sampled at other times|no unit of time"):
        read_log(tmp_path / "a.tdms")


def test_a_spreadsheet_is_read_as_its_text(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (["Time (ms)", "Force (mN)"], [0.0, 1.5], [1, 2]):
        book.active.append(row)
    book.save(tmp_path / "a.xlsx")
    found = read_log(tmp_path / "a.xlsx")
    assert found.time_s == pytest.approx([0.0, 1e-3])
    assert found.channels["Force"].values == pytest.approx([1.5e-3, 2e-3])
    assert found.channels["Force"].unit == "N"


def test_a_factor_of_a_column_that_is_not_read_is_refused(tmp_path):
    with pytest.raises(InputError, match="factors: 'voltage' is none of the columns voltage_V"):
        read_mat(tmp_path / "a.mat", {"voltage_V": "v"}, {"voltage": 1e-3})
