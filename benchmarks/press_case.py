"""A quarter of the true segment, for both codes: meshed here, since NGSolve and build123d cannot share a process."""

from pathlib import Path

import numpy as np

import mesh
from foundation.arrays import Ints
from geometry.dot_at_rest import resolve_dot
from mesh.types import TET_FACES, TetMesh, boundary_faces
from softdot.config.loading import load_config
from softdot.config.schema import Config

DEPTH_MM = 0.3
PLANES = (0, 1)  # the default press is its own image in x = 0 and in y = 0
AUGMENTATION_MPA_PER_MM = 20.0  # of NGSolve's contact; see tests/verification/test_against_ngsolve_press.py


def segment_mesh(config: Config, factor: float) -> TetMesh:
    """A quarter of the default segment, its element sizes times a factor."""
    names = ("element_size_mm", "contact_element_size_mm")
    sizes = {name: factor * getattr(config.mesh, name) for name in names}
    options = config.mesh.model_copy(update=sizes)
    return mesh.build(config.segment, resolve_dot(config.dot, config.segment), options, PLANES)


def cut_facets(tet_mesh: TetMesh, axis: int) -> Ints:
    """Corners (k, 3) of the facets in a mirror plane, which NGSolve must hold itself."""
    owner, face = boundary_faces(tet_mesh.tets)
    outer = tet_mesh.tets[owner[:, None], TET_FACES[face, :3]]
    return outer[(np.abs(tet_mesh.points_mm[outer][..., axis]) < 1e-9).all(axis=1)]


def save(path: Path, factor: float) -> None:
    """Corner mesh, named facets and constants."""
    config = load_config(None)
    tet_mesh = segment_mesh(config, factor)
    materials = config.layer_materials()
    media = [name for name in tet_mesh.region_names if name != "film"]
    held = [name for name in config.segment.held_layers if f"side-{name}" in tet_mesh.facets]
    facets = {name: tet_mesh.facets[name][:, :3] for name in ("base", "contact", *(f"side-{one}" for one in held))}
    facets |= {f"plane-{name}": cut_facets(tet_mesh, axis) for axis, name in zip(PLANES, "xy", strict=True)}
    np.savez(
        path,
        points=tet_mesh.points_mm,
        tets=tet_mesh.tets[:, :4],
        region=tet_mesh.region,
        region_names=tet_mesh.region_names,
        facet_names=list(facets),
        held=np.array(held, str),
        depth=DEPTH_MM,
        media=media,
        moduli=[materials[name].youngs_modulus_MPa for name in media],
        poisson=[materials[name].poisson_ratio for name in media],
        film_thickness=1e-3 * config.segment.film.thickness_um,
        radius=resolve_dot(config.dot, config.segment).radius_mm,
        augmentation=AUGMENTATION_MPA_PER_MM,
        **{f"facet:{name}": nodes for name, nodes in facets.items()},
    )
