"""ParaView files: one VTU per load step, PVD collections over the indentation, and a script to open them.

In a shell: paraview --script=show_in_paraview.py, or pvpython show_in_paraview.py.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from export.dot_surface import placed_dot
from export.recovery import FilmPatches, film_patches
from export.skin import MM_PER_M, MPA_PER_PA, PC_PER_MM2_PER_C_PER_M2, split_nodes, spread
from geometry.arrays import Floats, Ints
from geometry.dot import DotShape
from geometry.files import whole_folder
from mesh.types import TetMesh
from solve.result import PressResult, Step

TEMPLATE = Path(__file__).with_name("paraview_script.txt")


def collection(files: Sequence[str], times: Sequence[float]) -> str:
    """The text of a PVD file: one data file for each time."""
    rows = [
        f'    <DataSet timestep="{time:.9g}" group="" part="0" file={quoteattr(file)}/>'
        for time, file in zip(times, files, strict=True)
    ]
    return _index("Collection", "0.1", rows)


def multi_block(files: Mapping[str, str]) -> str:
    """The text of a VTM file: block name -> data file."""
    rows = [
        f'    <DataSet index="{index}" name={quoteattr(name)} file={quoteattr(file)}/>'
        for index, (name, file) in enumerate(files.items())
    ]
    return _index("vtkMultiBlockDataSet", "1.0", rows)


def _index(kind: str, version: str, rows: Sequence[str]) -> str:
    head = f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="{version}" byte_order="LittleEndian">'
    return "\n".join([head, f"  <{kind}>", *rows, f"  </{kind}>", "</VTKFile>", ""])


def paraview_script(tet_mesh: TetMesh, result: PressResult) -> str:
    """The script with the sizes and ranges of these results: the soft parts' stress, the film's charge density."""
    soft = tet_mesh.region != tet_mesh.region_names.index("film")
    stress = float(np.percentile(result.steps[-1].fields.von_mises_Pa[soft], 99)) * MPA_PER_PA
    charge = PC_PER_MM2_PER_C_PER_M2 * max(map(abs, result.film_peak.charge_density_C_per_m2))
    length = float(np.ptp(tet_mesh.points_mm[:, 0]))
    values = {
        "@STRESS@": stress or 1.0, "@CHARGE@": charge or 1.0, "@ASIDE@": 1.25 * length, "@FOCUS@": 0.6 * length,
        "@PARTS@": [name for name in tet_mesh.region_names if name != "film"],
    }  # fmt: skip
    script = TEMPLATE.read_text("utf-8")
    for mark, value in values.items():
        script = script.replace(mark, f"{value:.4g}" if isinstance(value, float) else repr(value))
    return script


QUADRATIC_TRIANGLE = 22
QUADRATIC_TETRA = 24
GLOBAL_AXES = ("XX", "YY", "ZZ", "XY", "YZ", "XZ")
FILM_AXES = ("11", "22", "33", "12", "23", "13")


def write_results(tet_mesh: TetMesh, result: PressResult, dot_shape: DotShape, folder: Path) -> list[Path]:
    """Write segment, parts, film, contact and dot as PVD collections with one file per step; return the PVD paths.

    The time of a collection is the indentation in mm; where that does not rise from step to step (a slide at
    constant depth), it is the number of the step. Points are undeformed (mm) and every file carries
    displacement_mm, so that "Warp By Vector" with factor 1 shows the deformed shape; the dot is written where
    it stands. Cell arrays of segment: cauchy_stress_MPa, von_mises_MPa, pressure_MPa, max_stretch, region;
    the field data "region_<name>" holds each part's number. The collection parts has a named block for each part, with
    stress and strain at nodes; show_in_paraview.py shows it all. The folder appears whole or not at all.
    """
    patches = film_patches(tet_mesh)
    parts: dict[str, Callable[[Step], Any]] = {
        "segment": lambda step: _segment(tet_mesh, step),
        "film": lambda step: _film(tet_mesh, patches, step),
        "contact": lambda step: _contact(tet_mesh, step),
        "dot": lambda step: _dot(tet_mesh, dot_shape, step),
    }
    with whole_folder(folder) as scratch:
        for name, build in parts.items():
            suffix = "vtp" if name == "dot" else "vtu"
            files = [f"{name}_{index:04d}.{suffix}" for index in range(len(result.steps))]
            for file, step in zip(files, result.steps, strict=True):
                _write_xml(build(step), scratch / file)
            (scratch / f"{name}.pvd").write_text(collection(files, step_times(result)), encoding="utf-8")
        blocks = [f"parts_{index:04d}.vtm" for index in range(len(result.steps))]
        for file, step in zip(blocks, result.steps, strict=True):
            _write_blocks(_parts(tet_mesh, step), scratch / file)
        (scratch / "parts.pvd").write_text(collection(blocks, step_times(result)), encoding="utf-8")
        (scratch / "show_in_paraview.py").write_text(paraview_script(tet_mesh, result), encoding="utf-8")
    return [folder / f"{name}.pvd" for name in [*parts, "parts"]]


def step_times(result: PressResult) -> list[float]:
    """Time in s where the press follows its waveform; else the indentation in mm, or the step where that stays."""
    if result.follows_time:
        return [step.time_s for step in result.steps]
    depths = np.array([step.indentation_m for step in result.steps]) * MM_PER_M
    if np.all(np.diff(depths) > 0):
        return [float(depth) for depth in depths]
    return [float(index) for index in range(len(depths))]


def _segment(tet_mesh: TetMesh, step: Step) -> Any:
    """The whole segment as quadratic tetrahedra."""
    fields = step.fields
    grid = _grid(tet_mesh.points_mm, tet_mesh.tets, QUADRATIC_TETRA)
    _add(grid.point_data, "displacement_mm", fields.displacement_m * MM_PER_M)
    _add(grid.cell_data, "cauchy_stress_MPa", fields.cauchy_stress_Pa * MPA_PER_PA, GLOBAL_AXES)
    _add(grid.cell_data, "green_lagrange_strain", fields.green_lagrange_strain, GLOBAL_AXES)
    _add(grid.cell_data, "von_mises_MPa", fields.von_mises_Pa * MPA_PER_PA)
    _add(grid.cell_data, "pressure_MPa", fields.pressure_Pa * MPA_PER_PA)
    _add(grid.cell_data, "max_stretch", fields.max_stretch)
    _add(grid.cell_data, "region", tet_mesh.region.astype(np.int32))
    for number, name in enumerate(tet_mesh.region_names):
        grid.field_data[f"region_{name}"] = np.array([number], np.int32)
    return grid


def _parts(tet_mesh: TetMesh, step: Step) -> dict[str, Any]:
    """Name of each part and its grid, with nodal fields that jump between parts."""
    fields, split = step.fields, split_nodes(tet_mesh)
    stress = spread(split, fields.cauchy_stress_Pa) * MPA_PER_PA
    von_mises = spread(split, fields.von_mises_Pa) * MPA_PER_PA
    strain = spread(split, fields.green_lagrange_strain)
    blocks = {}
    for number, name in enumerate(tet_mesh.region_names):
        nodes, tets = _compact(split.tets[tet_mesh.region == number])
        grid = _grid(tet_mesh.points_mm[split.node[nodes]], tets, QUADRATIC_TETRA)
        _add(grid.point_data, "displacement_mm", fields.displacement_m[split.node[nodes]] * MM_PER_M)
        _add(grid.point_data, "nodal_von_mises_MPa", von_mises[nodes])
        _add(grid.point_data, "nodal_cauchy_stress_MPa", stress[nodes], GLOBAL_AXES)
        _add(grid.point_data, "nodal_green_lagrange_strain", strain[nodes], GLOBAL_AXES)
        blocks[name] = grid
    return blocks


def _film(tet_mesh: TetMesh, patches: FilmPatches, step: Step) -> Any:
    """The film's tetrahedra alone, in the film's own axes."""
    fields = step.fields
    nodes, tets = _compact(tet_mesh.tets[fields.film_tets])
    grid = _grid(tet_mesh.points_mm[nodes], tets, QUADRATIC_TETRA)
    _add(grid.point_data, "displacement_mm", fields.displacement_m[nodes] * MM_PER_M)
    _add(grid.cell_data, "film_strain", fields.film_strain, FILM_AXES)
    _add(grid.cell_data, "film_stress_MPa", fields.film_stress_Pa * MPA_PER_PA, FILM_AXES)
    charge = fields.charge_density_C_per_m2 * PC_PER_MM2_PER_C_PER_M2
    _add(grid.cell_data, "charge_density_pC_per_mm2", charge)
    at_nodes = {
        "nodal_film_strain": (fields.film_strain, FILM_AXES),
        "nodal_film_stress_MPa": (fields.film_stress_Pa * MPA_PER_PA, FILM_AXES),
        "nodal_charge_density_pC_per_mm2": (charge, ()),
    }
    for name, (values, axes) in at_nodes.items():
        _add(grid.point_data, name, patches.at_nodes(values, len(tet_mesh.points_mm))[nodes], axes)
    return grid


def _contact(tet_mesh: TetMesh, step: Step) -> Any:
    """The skin that the dot can touch, as quadratic triangles."""
    fields = step.fields
    nodes, triangles = _compact(tet_mesh.facets["contact"])
    place = np.full(len(tet_mesh.points_mm), -1)
    place[fields.contact_nodes] = np.arange(len(fields.contact_nodes))
    grid = _grid(tet_mesh.points_mm[nodes], triangles, QUADRATIC_TRIANGLE)
    _add(grid.point_data, "displacement_mm", fields.displacement_m[nodes] * MM_PER_M)
    _add(grid.point_data, "gap_mm", fields.gap_m[place[nodes]] * MM_PER_M)
    _add(grid.point_data, "contact_pressure_MPa", fields.contact_pressure_Pa[place[nodes]] * MPA_PER_PA)
    return grid


def _dot(tet_mesh: TetMesh, dot_shape: DotShape, step: Step) -> Any:
    """The rigid dot and its plate where they stand at this step."""
    import pyvista

    surfaces = placed_dot(dot_shape, tet_mesh, step.dot_position_m * MM_PER_M)
    return pyvista.merge(surfaces, merge_points=False)


def _grid(points_mm: Floats, cells: Ints, cell_type: int) -> Any:
    """A VTK unstructured grid of one cell type; points (n, 3) in mm, cells (m, nodes per cell)."""
    import pyvista

    return pyvista.UnstructuredGrid({cell_type: cells}, points_mm)


def _compact(cells: Ints) -> tuple[Ints, Ints]:
    """The nodes that the cells use, and the cells renumbered onto them."""
    nodes, renumbered = np.unique(cells, return_inverse=True)
    return nodes, renumbered.reshape(cells.shape)


def _add(arrays: Any, name: str, values: Any, components: tuple[str, ...] = ()) -> None:
    """Attach one array; ParaView shows the names of its components."""
    arrays[name] = np.ascontiguousarray(values)
    for number, component in enumerate(components):
        arrays.GetArray(name).SetComponentName(number, component)


FASTEST = 1  # a third of the time of zlib's usual level, for files that are a tenth larger


def _write_xml(data: Any, path: Path) -> None:
    """Write VTK XML, binary and zlib-compressed. VTK would crash where a disk is full, so Python writes the file."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

    writer = vtkXMLPolyDataWriter() if path.suffix == ".vtp" else vtkXMLUnstructuredGridWriter()
    writer.SetInputData(data)
    writer.SetDataModeToBinary()
    writer.SetCompressorTypeToZLib()
    writer.SetCompressionLevel(FASTEST)
    writer.WriteToOutputStringOn()
    if not writer.Write():
        raise OSError(f"could not write {path}")
    path.write_text(writer.GetOutputString(), encoding="utf-8")


def _write_blocks(blocks: dict[str, Any], path: Path) -> None:
    """Write named grids as a VTK multi-block file, each in a file of its own in the folder of its name."""
    folder = path.with_suffix("")
    folder.mkdir()
    files = {name: f"{folder.name}/{folder.name}_{index}.vtu" for index, name in enumerate(blocks)}
    for name, grid in blocks.items():
        _write_xml(grid, path.parent / files[name])
    path.write_text(multi_block(files), encoding="utf-8")
