"""Tensile tests of silicones (github.com/LucMarechal/Soft-Robotics-Materials-Database), one recording per material.

    python examples/recordings/silicones_tensile.py DATA OUT

CSV with ';': a block of parameters, among them the sizes of the strip in mm, then time, true and engineering strain and
stress (MPa), which look averaged over strips. OUT/ecoflex-00-30 and so on are the recordings. Strips were pulled to
failure; above MAX_STRAIN the rows are left out, for no law of this package is meant to go further.
"""

import csv
import sys
from pathlib import Path

import numpy as np

from softdot.convert import run_text, white_noise, write_recording

MAX_STRAIN = 3.0
MODULUS = 1.0  # one sigma, relative: it is what the test is for
COLUMNS = ("Time (s)", "Engineering Strain", "Engineering Stress (MPa)")
HEAD = """# Engineering strain and stress of the source, times the strip's length and cross-section.
format = "softdot-recording/1"

[specimen]
kind = "tension"
material = "silicone"
length_mm = {length}
width_mm = {width}
thickness_mm = {thickness}

[materials.silicone]            # a start; a fit finds its own
model = "neo-hookean"
youngs_modulus_MPa = {modulus:.3g}
poisson_ratio = 0.4999
density_kg_m3 = 1070.0

"""


def convert(data: Path, out: Path) -> None:
    """Write one recording per file."""
    for file in sorted(data.glob("*.csv")):
        name = file.stem.lower().replace(" ", "-")
        write_material(file, out / name, name)


def write_material(file: Path, out: Path, name: str) -> None:
    """One strip as a recording of one run."""
    rows = list(csv.reader(file.read_text("utf-8-sig").splitlines(), delimiter=";"))
    about = {row[0].strip(): row[1].strip() for row in rows if len(row) > 1}
    start = next(n for n, row in enumerate(rows) if row[:1] == ["Time (s)"])
    numbers = [rows[start].index(column) for column in COLUMNS]
    table = np.array([[float(row[n]) for n in numbers] for row in rows[start + 1 :] if row and row[0]])
    table = table[(table[:, 1] < MAX_STRAIN) & np.concatenate([[True], np.diff(table[:, 0]) > 0.0])]
    length, width, thickness = (float(about[f"Specimen {size} (mm)"]) for size in ("Length", "Width", "Thickness"))
    time, strain, stress = table.T
    columns = {"time_s": time, "displacement_mm": length * strain, "force_N": width * thickness * stress}
    text = run_text(
        f"{name}.csv", f"{file.stem}, pulled", "displacement_mm",
        nuisance={"modulus.specimen": MODULUS}, noise={"force_N": white_noise(columns["force_N"])},
    )  # fmt: skip
    modulus = float(stress[1] / strain[1])
    head = HEAD.format(length=length, width=width, thickness=thickness, modulus=modulus)
    write_recording(out, head + text, {f"{name}.csv": columns})


if __name__ == "__main__":
    convert(Path(sys.argv[1]), Path(sys.argv[2]))
