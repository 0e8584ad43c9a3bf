"""A rigid cylinder pressed into a block and dragged along it, by CalculiX (http://www.calculix.de, ccx 2.20).

Only the block's mesh is shared. Theirs: quadratic displacement elements without a pressure (C3D10), contact surface to
surface with a penalty on the overlap and on the slip, and a meshed cylinder whose nodes are all prescribed. The
hyperelastic law is the same, C10 (I1 - 3) + (J - 1)^2 / D1. Units: mm, N, MPa.
"""

import os
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from foundation.arrays import Floats, Ints
from softdot.verify.lattice import FACE_NODES, Grid, disc

CCX = shutil.which("ccx")
FACE_NUMBER = (1, 2, 3, 4)  # CalculiX numbers the faces 123, 142, 243, 341: the order of FACES


@dataclass(frozen=True)
class Slide:
    """mu = 0 leaves friction out; penalties in MPa / mm.

    CalculiX keeps the normals of an increment's start: a slide of s in n increments lags by s / (n radius) in angle.
    """

    radius_mm: float
    depth_mm: float
    slide_mm: float
    youngs_modulus_MPa: float
    poisson_ratio: float
    friction: float
    normal_penalty: float
    slip_penalty: float
    press_increments: int
    slide_increments: int


def cylinder(case: Slide, half_width: float, top: float, cells: int = 32) -> Grid:
    """A curved strip of the cylinder, along y, that touches the plane z = top at x = 0."""
    angles = np.deg2rad(np.linspace(-140.0, -40.0, cells + 1))
    strip = disc([0.8 * case.radius_mm, case.radius_mm], angles, [-half_width, half_width])
    x, z, y = strip.points.T
    points = np.column_stack([x, -y, z + case.radius_mm + top])  # a rotation: the tetrahedra keep their orientation
    return Grid(points, strip.tets, strip.skin)


def forces(block: Grid, case: Slide, folder: Path) -> Floats:
    """Force (increments, 3) of the cylinder on the block after every increment. RuntimeError with ccx's last words."""
    assert CCX is not None
    deck = folder / "slide.inp"
    deck.write_text("\n".join(_deck(block, case)) + "\n", "utf-8")
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "CCX_NPROC_EQUATION_SOLVER": "1"}
    done = subprocess.run(
        [CCX, "slide"], cwd=folder, env=environment, capture_output=True, encoding="utf-8", check=False, timeout=900
    )
    text = (folder / "slide.dat").read_text(encoding="utf-8") if (folder / "slide.dat").exists() else ""
    found = np.array(re.findall(r"total force.*set DIE and time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", text), float)
    times = _end_times(case)
    if len(found) == 0 or not np.isclose(found[-1, 0], times[-1]):
        raise RuntimeError(f"ccx ended at time {found[-1, 0] if len(found) else 0}:\n{done.stdout[-1500:]}")
    return np.column_stack([np.interp(times, found[:, 0], f) for f in found[:, 1:].T])  # cut increments leave more


def _end_times(case: Slide) -> Floats:
    """Ends of the increments; each step lasts 1."""
    press = np.arange(1, case.press_increments + 1) / case.press_increments
    slide = 1.0 + np.arange(1, case.slide_increments + 1) / max(case.slide_increments, 1)
    return np.concatenate([press, slide])


def _deck(block: Grid, case: Slide) -> list[str]:
    height, half_width = block.points[:, 2].max(), block.points[:, 1].max()
    die = cylinder(case, 1.5 * half_width, height)
    count = len(block.points)
    shear = case.youngs_modulus_MPa / (2 * (1 + case.poisson_ratio))
    bulk = case.youngs_modulus_MPa / (3 * (1 - 2 * case.poisson_ratio))
    lines = [*_nodes(np.vstack([block.points, die.points]))]
    lines += _elements("BLOCK", block.tets, 0) + _elements("TOOL", die.tets + count, len(block.tets))
    lines += _surface("TOP", block, np.isclose(block.points[:, 2], height), 0)
    outer = np.isclose(np.hypot(die.points[:, 0], die.points[:, 2] - height - case.radius_mm), case.radius_mm)
    lines += _surface("FACE", die, outer, len(block.tets))
    lines += _set("BASE", np.flatnonzero(block.points[:, 2] == 0.0)) + _set("ALL", np.arange(count))
    lines += _set("DIE", count + np.arange(len(die.points)))
    lines += ["*MATERIAL, NAME=RUBBER", "*HYPERELASTIC, NEO HOOKE", f"{shear / 2:.12g}, {2 / bulk:.12g}"]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "1e5, 0.3"]
    lines += ["*SOLID SECTION, ELSET=BLOCK, MATERIAL=RUBBER", "*SOLID SECTION, ELSET=TOOL, MATERIAL=STEEL"]
    lines += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"]
    lines += [f"{case.normal_penalty:g}"]
    if case.friction:
        lines += ["*FRICTION", f"{case.friction:g}, {case.slip_penalty:g}"]
    lines += ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "TOP, FACE"]
    lines += ["*BOUNDARY", "BASE, 1, 3", "ALL, 2", "DIE, 2"]
    lines += _step(case.press_increments, 0.0, case.depth_mm)
    return lines + _step(case.slide_increments, case.slide_mm, case.depth_mm) if case.slide_increments else lines


def _nodes(points: Floats) -> list[str]:
    return ["*NODE, NSET=NODES", *(f"{n}, {x:.15g}, {y:.15g}, {z:.15g}" for n, (x, y, z) in enumerate(points, 1))]


def _elements(name: str, tets: Ints, first: int) -> list[str]:
    """The ten nodes come in the same order in both codes."""
    rows = [f"{first + n}, {', '.join(map(str, nodes + 1))}" for n, nodes in enumerate(tets, 1)]
    return [f"*ELEMENT, TYPE=C3D10, ELSET={name}", *rows]


def _surface(name: str, body: Grid, on: Floats, first: int) -> list[str]:
    """Faces whose nodes all lie on a surface."""
    element, face = np.nonzero(on[body.tets[:, FACE_NODES]].all(axis=2))
    rows = [f"{first + e + 1}, S{FACE_NUMBER[f]}" for e, f in zip(element, face, strict=True)]
    return [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *rows]


def _set(name: str, nodes: Ints) -> list[str]:
    return [f"*NSET, NSET={name}", *(f"{n + 1}," for n in nodes)]


def _step(increments: int, slide: float, depth: float) -> list[str]:
    increment = 1.0 / increments
    return [
        "*STEP, NLGEOM, INC=10000",
        "*STATIC",
        f"{increment:.12g}, 1.0, 1e-6, {increment:.12g}",
        "*BOUNDARY",
        f"DIE, 1, 1, {slide:.12g}",
        f"DIE, 3, 3, {-depth:.12g}",
        "*NODE PRINT, NSET=DIE, TOTALS=ONLY, FREQUENCY=1",
        "RF",
        "*END STEP",
    ]
