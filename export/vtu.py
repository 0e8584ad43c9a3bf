"""ParaView files: one VTU per load step, PVD collections over the indentation, and a script to open them.
In a shell: paraview --script=show_in_paraview.py, or pvpython show_in_paraview.py.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from export.dot_surface import placed_dot
from export.nodal_values import nodal_means, split_nodes
from export.recovery import film_patches
from export.skin import MM_PER_M, MPA_PER_PA, PC_PER_MM2_PER_C_PER_M2
from export.vtk_xml import Arrays, VtkGrid
from foundation.arrays import Ints
from foundation.files import whole_folder
from geometry.dot import DotShape
from mesh.types import TetMesh
from solve.result import PressResult, Step

TEMPLATE = Path(__file__).with_name("paraview_script.txt")


def pvd_text(files: Sequence[str], times: Sequence[float]) -> str:
    """Text of a PVD file: one data file for each time."""
    rows = [
        f'    <DataSet timestep="{time:.9g}" group="" part="0" file={quoteattr(file)}/>'
        for time, file in zip(times, files, strict=True)
    ]
    return _index_text("Collection", "0.1", rows)


def vtm_text(files: Mapping[str, str]) -> str:
    """Text of a VTM file. files : name of the block -> data file."""
    rows = [
        f'    <DataSet index="{index}" name={quoteattr(name)} file={quoteattr(file)}/>'
        for index, (name, file) in enumerate(files.items())
    ]
    return _index_text("vtkMultiBlockDataSet", "1.0", rows)


def _index_text(kind: str, version: str, rows: Sequence[str]) -> str:
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

WriteStep = Callable[[Step, Path], None]
"""Writes the file of one step; what all steps share is prepared before."""


def write_results(tet_mesh: TetMesh, result: PressResult, dot_shape: DotShape, folder: Path) -> list[Path]:
    """Write segment, parts, film, contact and dot as PVD collections with one file per step; return the PVD paths.

    The time of a collection is the indentation in mm; where that does not rise from step to step (a slide at
    constant depth), it is the number of the step. Points are undeformed (mm) and every file carries
    displacement_mm, so that "Warp By Vector" with factor 1 shows the deformed shape; the dot is written where
    it stands. Cell arrays of segment: cauchy_stress_MPa, von_mises_MPa, pressure_MPa, max_stretch, region;
    the field data "region_<name>" holds each part's number. The collection parts has a named block for each part, with
    stress and strain at nodes; show_in_paraview.py shows it all. The folder appears whole or not at all.
    """
    grids: dict[str, WriteStep] = {
        "segment": _segment_writer(tet_mesh),
        "film": _film_writer(tet_mesh),
        "contact": _contact_writer(tet_mesh),
        "dot": lambda step, path: _write_dot(tet_mesh, dot_shape, step, path),
        "parts": _parts_writer(tet_mesh),
    }
    suffixes, times = {"dot": "vtp", "parts": "vtm"}, step_times(result)
    with whole_folder(folder) as scratch:
        for name, write in grids.items():
            files = [f"{name}_{index:04d}.{suffixes.get(name, 'vtu')}" for index in range(len(result.steps))]
            for file, step in zip(files, result.steps, strict=True):
                write(step, scratch / file)
            (scratch / f"{name}.pvd").write_text(pvd_text(files, times), encoding="utf-8")
        (scratch / "show_in_paraview.py").write_text(paraview_script(tet_mesh, result), encoding="utf-8")
    return [folder / f"{name}.pvd" for name in grids]


def step_times(result: PressResult) -> list[float]:
    """Time in s where the press follows its waveform; else the indentation in mm, or the step where that stays."""
    if result.follows_time:
        return [step.time_s for step in result.steps]
    depths = np.array([step.indentation_m for step in result.steps]) * MM_PER_M
    if np.all(np.diff(depths) > 0):
        return [float(depth) for depth in depths]
    return [float(index) for index in range(len(depths))]


def _segment_writer(tet_mesh: TetMesh) -> WriteStep:
    """Writer of the whole segment as quadratic tetrahedra."""
    grid, region = VtkGrid(tet_mesh.points_mm, tet_mesh.tets, QUADRATIC_TETRA), tet_mesh.region.astype(np.int32)
    names = {f"region_{name}": (np.array([number], np.int32), ()) for number, name in enumerate(tet_mesh.region_names)}

    def write(step: Step, path: Path) -> None:
        fields = step.fields
        cell_data: Arrays = {
            "cauchy_stress_MPa": (fields.cauchy_stress_Pa * MPA_PER_PA, GLOBAL_AXES),
            "green_lagrange_strain": (fields.green_lagrange_strain, GLOBAL_AXES),
            "von_mises_MPa": (fields.von_mises_Pa * MPA_PER_PA, ()),
            "pressure_MPa": (fields.pressure_Pa * MPA_PER_PA, ()),
            "max_stretch": (fields.max_stretch, ()),
            "region": (region, ()),
        }
        grid.write(path, {"displacement_mm": (fields.displacement_m * MM_PER_M, ())}, cell_data, names)

    return write


def _parts_writer(tet_mesh: TetMesh) -> WriteStep:
    """Writer of a block for each part, in a file of its own in the folder of their name.

    Fields at nodes jump between parts.
    """
    split = split_nodes(tet_mesh)
    own = [_compact_cells(split.tets[tet_mesh.region == number]) for number in range(len(tet_mesh.region_names))]
    grids = [VtkGrid(tet_mesh.points_mm[split.node[nodes]], tets, QUADRATIC_TETRA) for nodes, tets in own]

    def write(step: Step, path: Path) -> None:
        fields, folder = step.fields, path.with_suffix("")
        everywhere: Arrays = {
            "displacement_mm": (fields.displacement_m[split.node] * MM_PER_M, ()),
            "nodal_von_mises_MPa": (nodal_means(split, fields.von_mises_Pa) * MPA_PER_PA, ()),
            "nodal_cauchy_stress_MPa": (nodal_means(split, fields.cauchy_stress_Pa) * MPA_PER_PA, GLOBAL_AXES),
            "nodal_green_lagrange_strain": (nodal_means(split, fields.green_lagrange_strain), GLOBAL_AXES),
        }
        files = [f"{folder.name}/{folder.name}_{index}.vtu" for index in range(len(grids))]
        folder.mkdir()
        for file, grid, (nodes, _) in zip(files, grids, own, strict=True):
            here = {name: (values[nodes], components) for name, (values, components) in everywhere.items()}
            grid.write(path.parent / file, here, {})
        path.write_text(vtm_text(dict(zip(tet_mesh.region_names, files, strict=True))), encoding="utf-8")

    return write


def _film_writer(tet_mesh: TetMesh) -> WriteStep:
    """Writer of the film's tetrahedra alone, in the film's own axes."""
    patches, count = film_patches(tet_mesh), len(tet_mesh.points_mm)
    nodes, tets = _compact_cells(tet_mesh.tets[tet_mesh.region_tets("film")])
    grid = VtkGrid(tet_mesh.points_mm[nodes], tets, QUADRATIC_TETRA)

    def write(step: Step, path: Path) -> None:
        fields = step.fields
        cell_data: Arrays = {
            "film_strain": (fields.film_strain, FILM_AXES),
            "film_stress_MPa": (fields.film_stress_Pa * MPA_PER_PA, FILM_AXES),
            "charge_density_pC_per_mm2": (fields.charge_density_C_per_m2 * PC_PER_MM2_PER_C_PER_M2, ()),
        }
        at_nodes: Arrays = {
            f"nodal_{name}": (patches.at_nodes(values, count)[nodes], axes)
            for name, (values, axes) in cell_data.items()
        }
        moved = (fields.displacement_m[nodes] * MM_PER_M, ())
        grid.write(path, {"displacement_mm": moved, **at_nodes}, cell_data)

    return write


def _contact_writer(tet_mesh: TetMesh) -> WriteStep:
    """Writer of the skin that the dot can touch, as quadratic triangles."""
    nodes, triangles = _compact_cells(tet_mesh.facets["contact"])
    grid = VtkGrid(tet_mesh.points_mm[nodes], triangles, QUADRATIC_TRIANGLE)

    def write(step: Step, path: Path) -> None:
        fields = step.fields
        at = np.searchsorted(fields.contact_nodes, nodes)
        point_data = {
            "displacement_mm": (fields.displacement_m[nodes] * MM_PER_M, ()),
            "gap_mm": (fields.gap_m[at] * MM_PER_M, ()),
            "contact_pressure_MPa": (fields.contact_pressure_Pa[at] * MPA_PER_PA, ()),
            "contact_traction_MPa": (fields.contact_traction_Pa[at] * MPA_PER_PA, ()),
        }
        grid.write(path, point_data, {})

    return write


def _write_dot(tet_mesh: TetMesh, dot_shape: DotShape, step: Step, path: Path) -> None:
    """Write the rigid dot and its plate where they stand at this step."""
    import pyvista
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    surfaces = placed_dot(dot_shape, tet_mesh, step.dot_position_m * MM_PER_M)
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(pyvista.merge(surfaces, merge_points=False))
    writer.SetDataModeToBinary()
    writer.WriteToOutputStringOn()  # VTK would crash where a disk is full, so Python writes the file
    if not writer.Write():
        raise OSError(f"could not write {path}")
    path.write_text(writer.GetOutputString(), encoding="utf-8")


def _compact_cells(cells: Ints) -> tuple[Ints, Ints]:
    """The nodes that the cells use, and the cells renumbered onto them."""
    nodes, renumbered = np.unique(cells, return_inverse=True)
    return nodes, renumbered.reshape(cells.shape)
