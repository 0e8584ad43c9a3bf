"""Other codes read the mesh that softdot writes, and softdot its own: scikit-fem measures it, CalculiX presses it."""

import os
import re
import subprocess

import meshio
import numpy as np
import pytest
from scipy.spatial import cKDTree
from skfem import Basis, ElementTetP2, FacetBasis, Functional, Mesh

from geometry.parameters import Effector, Film
from mesh.files.formats import write_mesh
from mesh.jacobian import volumes
from mesh.options import MeshOptions
from softdot.case import Case
from softdot.config.default_design import with_default_design
from softdot.config.loading import config_from
from softdot.outcome import solve_outcome
from softdot.verify.body import ElasticBody
from solve.materials.laws import LinearLaw, bulk_modulus
from tests.solve.segments import cap, coarse_mesh, segment
from tests.verification.ccx_slide import CCX
from tests.verification.row import agrees

ONE = Functional(lambda w: np.ones_like(w.x[0]))
STACK = segment(film=Film(thickness_um=100.0), effector=Effector(shape="cylinder", height_mm=1.0, diameter_mm=1.6))
MESH = MeshOptions(mesher="layered", element_size_mm=0.5, contact_element_size_mm=0.25)


def test_scikit_fem_finds_the_volumes_of_the_parts_and_the_areas_of_the_surfaces(tmp_path):
    ours = coarse_mesh(STACK, cap(STACK), MESH)
    (path,) = write_mesh(ours, ["msh"], tmp_path)
    theirs = Mesh.load(path)
    exact = volumes(ours.points_mm[ours.tets])
    for name in ours.region_names:
        found = ONE.assemble(Basis(theirs, ElementTetP2(), elements=theirs.subdomains[name], intorder=4))
        agrees(
            f"scikit-fem reads segment.msh, volume of {name} (mm3)", found, exact[ours.region_tets(name)].sum(), 1e-9
        )
    file = meshio.gmsh.read(path)
    place = cKDTree(theirs.p[:, theirs.facets].mean(axis=1).T)  # it takes names of facets from straight meshes only
    for name, facets in ours.facets.items():
        corners = file.points[file.cells_dict["triangle6"][file.cell_sets_dict[name]["triangle6"], :3]]
        away, number = place.query(corners.mean(axis=1))
        assert away.max() < 1e-12
        found = ONE.assemble(FacetBasis(theirs, ElementTetP2(), facets=np.unique(number), intorder=14))
        agrees(f"scikit-fem reads segment.msh, area of {name} (mm2)", found, area(ours.points_mm[facets]), 1e-9)


def area(corner):
    """Area of curved quadratic triangles (k, 6, 3), by Gauss' rule on the square with one side collapsed."""
    x, w = np.polynomial.legendre.leggauss(12)
    s, t = (a.ravel() for a in np.meshgrid((x + 1) / 2, (x + 1) / 2, indexing="ij"))
    weight, s = np.outer(w, w).ravel() / 4 * (1 - t), s * (1 - t)
    r, zero = 1 - s - t, np.zeros_like(s)
    along_s = np.array([1 - 4 * r, 4 * s - 1, zero, 4 * (r - s), 4 * t, -4 * t])
    along_t = np.array([1 - 4 * r, zero, 4 * t - 1, -4 * s, 4 * s, 4 * (r - t)])
    one, other = (np.einsum("kni,nq->kqi", corner, shape) for shape in (along_s, along_t))
    return float((np.linalg.norm(np.cross(one, other), axis=2) @ weight).sum())


YOUNG = {"medium2": 1.0, "film": 50.0, "medium1": 5.0, "effector": 2.0}
POISSON_RATIO, DEPTH_MM, PRESSURE = 0.3, 1e-4, 1e-3
NEEDS_CALCULIX = pytest.mark.skipif(CCX is None, reason="CalculiX (ccx) is not installed")


@NEEDS_CALCULIX
@pytest.mark.press
def test_calculix_presses_the_exported_mesh_with_the_same_force(tmp_path):
    """The contact surface goes down by 0.1 um, free to move sideways, over a base that is held.

    CalculiX has no pressure unknown: with nu = 0.45 its elements are 1 % stiffer than ours on this mesh.
    """
    ours = coarse_mesh(STACK, cap(STACK), MESH)
    write_mesh(ours, ["inp"], tmp_path)
    found = base_force(tmp_path, ["*BOUNDARY", f"contact, 3, 3, {-DEPTH_MM}"])
    agrees("CalculiX presses segment.inp, force (N)", pressed(ours), found[2], 0.005)


@NEEDS_CALCULIX
@pytest.mark.press
def test_calculix_loads_the_faces_of_the_exported_surface(tmp_path):
    """A pressure on the surface contact: the base carries its projected area, which is the footprint."""
    write_mesh(coarse_mesh(STACK, cap(STACK), MESH), ["inp"], tmp_path)
    found = base_force(tmp_path, ["*DSLOAD", f"contact, P, {PRESSURE}"])
    agrees("CalculiX loads a SURFACE of segment.inp, force (N)", found[2], PRESSURE * 2.5 * 2.5, 1e-5)


def pressed(mesh):
    """Force that holds the base, of softdot's own elements with a pressure unknown."""
    body = ElasticBody(mesh.points_mm, np.arange(3 * len(mesh.points_mm)).reshape(-1, 3), 3 * len(mesh.points_mm))
    for name in mesh.region_names:
        shear = YOUNG[name] / (2 * (1 + POISSON_RATIO))
        law = LinearLaw(shear, bulk_modulus(shear, POISSON_RATIO))
        body.add_region(name, law, mesh.tets[mesh.region_tets(name)])
    prescribed = body.free_displacements()
    prescribed[np.unique(mesh.facets["contact"]), 2] = -DEPTH_MM
    prescribed[np.unique(mesh.facets["base"])] = 0.0
    body.solve(prescribed)
    return body.reaction(np.unique(mesh.facets["base"]))[2]


def base_force(folder, load):
    """Force (3,) on the base by CalculiX; the deck includes the exported mesh and names only its sets."""
    deck = ["*INCLUDE, INPUT=segment.inp"]
    for name, modulus in YOUNG.items():
        deck += [f"*MATERIAL, NAME=of-{name}", "*ELASTIC", f"{modulus}, {POISSON_RATIO}"]
        deck += [f"*SOLID SECTION, ELSET={name}, MATERIAL=of-{name}"]
    deck += ["*BOUNDARY", "base, 1, 3", "*STEP", "*STATIC", *load]
    deck += ["*NODE PRINT, NSET=base, TOTALS=ONLY", "RF", "*END STEP"]
    (folder / "press.inp").write_text("\n".join(deck) + "\n", "utf-8")
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "CCX_NPROC_EQUATION_SOLVER": "1"}
    done = subprocess.run(
        [CCX, "press"], cwd=folder, env=environment, capture_output=True, encoding="utf-8", check=False, timeout=600
    )
    found = re.search(r"total force.*\n+\s*(\S+)\s+(\S+)\s+(\S+)", (folder / "press.dat").read_text(encoding="utf-8"))
    assert found, done.stdout[-1500:]
    return [float(value) for value in found.groups()]


SLICE = {
    "segment": {"section": "plane-strain"},
    "dot": {"shape": "ridge", "radius_mm": 1.15},
    "press": {"indentation_mm": 0.1, "load_steps": 2},
    "mesh": {"mesher": "layered", "element_size_mm": 0.5, "contact_element_size_mm": 0.3},
}
SOLID = {"press": {"indentation_mm": 0.1, "load_steps": 1}, "mesh": {**SLICE["mesh"], "contact_element_size_mm": 0.5}}


@pytest.mark.press
@pytest.mark.parametrize(
    ("name", "tables", "extension"),
    [("slice", SLICE, "msh"), ("slice", SLICE, "inp"), ("slice", SLICE, "xdmf"), ("solid", SOLID, "msh")],
)
def test_a_press_on_its_own_exported_mesh_gives_the_same_numbers(name, tables, extension, tmp_path):
    """Only the order of nodes and elements differs, and in .inp the fifteenth digit of the coordinates."""
    config = config_from(with_default_design(tables))
    (path,) = write_mesh(Case(config).mesh, [extension], tmp_path)
    own = config_from(with_default_design({**tables, "mesh": {"file": str(path)}}))
    before, after = (solve_outcome(one, lambda *_: None) for one in (config, own))
    solved_as = 2 ** len(before["mesh"]["symmetry_planes"])
    assert after["mesh"]["tetrahedra"] == solved_as * before["mesh"]["tetrahedra"]
    for key in ("reaction_force_N", "film_charge_pC", "open_circuit_voltage_V"):
        agrees(f"{name} from its own {extension}, {key}", after[key][-1], before[key][-1], 1e-9)
