"""Data of the report's 3D view, packed as base64 arrays."""

import base64
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from export.cutaway import is_slice
from export.dot_surface import placed_dot
from export.skin import (
    MM_PER_M,
    NodalSteps,
    Skin,
    cut_section,
    film_top,
    nearby_plane,
    nodal_steps,
    outer_facets,
    outer_skin,
)
from export.view import COLOUR_MAP, DIVERGING
from foundation.arrays import Floats
from geometry.dot import DotShape
from geometry.solids import PART_COLOURS
from mesh.types import TetMesh
from solve.result import FilmPeak, PressResult, Step

MOST_STEPS = 9
"""Steps shown; more would make the page heavy without showing more."""
MOST_TRIANGLES = 30_000
"""Above this the quadratic faces are drawn by their corners only."""


def viewer_data(tet_mesh: TetMesh, result: PressResult, dot_shape: DotShape) -> dict[str, Any]:
    """Data of export/viewer.js: plain numbers and base64 of little-endian arrays.

    base64 float32: points (v, 3), dotPoints and dotCut (loose triangles); int16: displacement (s, v, 3)
    in displacementUnit mm; uint8: region (v,), stress, strain and pressure (s, v), shares of stressTop, strainTop and
    pressureTop, and charge (s, v) between -chargeTop and chargeTop; uint32: outer, section and film triangles into the
    same corners. dotShift (s, 3) moves the dot; plane is the cut's y; colours, names, colourMap and diverging say how
    to paint.
    """
    chosen = [result.steps[k] for k in spread_steps(len(result.steps))]
    nodes = nodal_steps(tet_mesh, chosen)
    plane = nearby_plane(tet_mesh, float(chosen[-1].dot_position_m[1]) * MM_PER_M)
    skins = _skins(nodes, tet_mesh, plane)
    return {
        "steps": [step_caption(step) for step in chosen],
        "names": list(tet_mesh.region_names),
        "colours": [rgb(PART_COLOURS[name]) for name in tet_mesh.region_names],
        **colour_maps(),
        "plane": plane,
        "slice": is_slice(tet_mesh),
        **_geometry_arrays(skins),
        **_field_arrays(skins, tet_mesh, result.film_peak),
        **_dot_arrays(tet_mesh, chosen, dot_shape, plane),
    }


def spread_steps(count: int) -> list[int]:
    """At most MOST_STEPS indices from the first to the last."""
    return sorted({round(k) for k in np.linspace(0, count - 1, min(count, MOST_STEPS))})


def step_caption(step: Step) -> dict[str, float]:
    """Depth in mm and force in N of a step."""
    return {"indentation": step.indentation_m * MM_PER_M, "force": step.reaction_force_N}


def _skins(nodes: NodalSteps, tet_mesh: TetMesh, plane: float) -> list[Skin]:
    """Outer skin, section and film, curved where the page can bear it."""
    level = 1 if 4 * len(outer_facets(nodes.split)) <= MOST_TRIANGLES else 0
    return [outer_skin(nodes, level), cut_section(nodes, plane, level), film_top(nodes, tet_mesh, level)]


def _geometry_arrays(skins: list[Skin]) -> dict[str, Any]:
    """Corners of all skins in one array, and the triangles of each."""
    offsets = np.cumsum([0, *(len(skin.points_mm) for skin in skins[:-1])])
    triangles = {
        name: base64_array(skin.triangles + offset, np.uint32)
        for name, skin, offset in zip(("outer", "section", "film"), skins, offsets, strict=True)
    }
    points = np.concatenate([skin.points_mm for skin in skins])
    displacement = np.concatenate([skin.displacement_mm for skin in skins], axis=1)
    region = np.concatenate([skin.region for skin in skins])
    moved = displacement_steps(displacement)
    return {
        "points": base64_array(points, np.float32),
        **moved,
        "displacement": base64_array(moved["displacement"], np.int16),
        "region": base64_array(region, np.uint8),
        **triangles,
    }


def _field_arrays(skins: list[Skin], tet_mesh: TetMesh, peak: FilmPeak) -> dict[str, Any]:
    """Fields of all skins as shares of their largest shown values.

    Stress up to the 99th percentile of the soft parts (the film is far stiffer), strain and charge up to the stated
    largest.
    """
    stress = np.concatenate([skin.von_mises_MPa for skin in skins], axis=1)
    strain = np.concatenate([skin.film_strain for skin in skins], axis=1)
    charge = np.concatenate([skin.charge_pC_per_mm2 for skin in skins], axis=1)
    pressure = np.concatenate([skin.contact_pressure_MPa for skin in skins], axis=1)
    soft = np.concatenate([skin.region for skin in skins]) != tet_mesh.region_names.index("film")
    tops = field_tops(stress[-1, soft], pressure, peak)
    return {
        "stress": base64_array(byte_shares(stress, tops["stress"]), np.uint8),
        "strain": base64_array(byte_shares(strain, tops["strain"]), np.uint8),
        "charge": base64_array(byte_shares(charge + tops["charge"], 2 * tops["charge"]), np.uint8),
        "pressure": base64_array(byte_shares(pressure, tops["pressure"]), np.uint8),
        **{f"{name}Top": top for name, top in tops.items()},
    }


def field_tops(soft_stress_MPa: Floats, pressure_MPa: Floats, peak: FilmPeak) -> dict[str, float]:
    """The largest value that is shown of each field. soft_stress_MPa : at the last step, without the film."""
    return {
        "stress": float(np.percentile(soft_stress_MPa, 99)) or 1.0,
        "strain": peak.strain or 1.0,
        "charge": 1e6 * float(np.abs(peak.charge_density_C_per_m2).max()) or 1.0,
        "pressure": float(pressure_MPa.max()) or 1.0,
    }


def displacement_steps(displacement_mm: Floats) -> dict[str, Any]:
    """The displacement (s, v, 3) as int16, and the unit of 1 in mm."""
    unit = (float(np.abs(displacement_mm).max()) or 1.0) / 32767
    return {"displacement": np.asarray(np.round(displacement_mm / unit), np.int16), "displacementUnit": unit}


def _dot_arrays(tet_mesh: TetMesh, steps: Sequence[Step], dot_shape: DotShape, plane: float) -> dict[str, Any]:
    """The dot's triangles at its first place, and how far each step moves it."""
    first = steps[0].dot_position_m * MM_PER_M
    whole = placed_dot(dot_shape, tet_mesh, first)
    # Cut where the plane meets the dot at the last step, as the segment is.
    slide = float(steps[-1].dot_position_m[1]) * MM_PER_M - first[1]
    cut = [part.clip_closed_surface("y", origin=(0.0, plane - slide, 0.0)) for part in whole]
    shift = np.stack([step.dot_position_m * MM_PER_M - first for step in steps])
    return {
        "dotPoints": base64_array(triangle_corners(whole), np.float32),
        "dotCut": base64_array(triangle_corners(cut), np.float32),
        "dotShift": shift.tolist(),
        "dotColour": rgb(PART_COLOURS["dot"]),
    }


def triangle_corners(surfaces: Sequence[Any]) -> NDArray[np.float64]:
    """Corners (3 t, 3) of all triangles."""
    return np.concatenate([s.triangulate().points[s.triangulate().regular_faces].reshape(-1, 3) for s in surfaces])


def byte_shares(values: NDArray[np.float64], top: float) -> NDArray[np.float64]:
    """Whole numbers from 0 to 255, of values from 0 to top."""
    return np.asarray(np.round(255 * np.clip(values / top, 0, 1)))


def base64_array(values: NDArray[Any], kind: type[np.generic]) -> str:
    """Base64 of an array of this kind, little-endian."""
    kind_little = np.dtype(kind).newbyteorder("<")
    return base64.b64encode(np.ascontiguousarray(values, kind_little).tobytes()).decode("ascii")


def rgb(colour: str) -> list[float]:
    """Red, green and blue from 0 to 1 of a colour that matplotlib knows."""
    from matplotlib.colors import to_rgb

    return [round(float(c), 4) for c in to_rgb(colour)]


def colour_maps() -> dict[str, str]:
    """256 RGB triples, as base64, of each of the colour maps of the pictures."""
    return {name: base64_array(triples, np.uint8) for name, triples in colour_map_bytes().items()}


@cache
def colour_map_bytes() -> dict[str, NDArray[np.uint8]]:
    """256 RGB triples of each of the colour maps of the pictures."""
    import matplotlib

    maps = {"colourMap": COLOUR_MAP, "diverging": DIVERGING}
    return {
        name: np.asarray(255 * matplotlib.colormaps[found](np.arange(256))[:, :3], np.uint8)
        for name, found in maps.items()
    }
