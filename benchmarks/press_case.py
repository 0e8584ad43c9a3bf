"""The true segment at one fineness, for both codes: meshed here, since NGSolve and build123d cannot share a process."""

from pathlib import Path

import numpy as np

import mesh
from geometry.dot import resolve_dot
from mesh.types import TetMesh
from softdot.config import Config, load_config

DEPTH_MM = 0.3
AUGMENTATION_MPA_PER_MM = 20.0  # of NGSolve's contact; see tests/verification/test_against_ngsolve_press.py


def segment_mesh(config: Config, factor: float) -> TetMesh:
    """The default segment, its element sizes times a factor."""
    names = ("element_size_mm", "contact_element_size_mm")
    sizes = {name: factor * getattr(config.mesh, name) for name in names}
    options = config.mesh.model_copy(update=sizes)
    return mesh.build(config.segment, resolve_dot(config.dot, config.segment), options)


def save(path: Path, factor: float) -> None:
    """Corner mesh, named facets and constants."""
    config = load_config(None)
    tet_mesh = segment_mesh(config, factor)
    materials = config.layer_materials()
    media = [name for name in tet_mesh.region_names if name != "film"]
    held = [name for name in config.segment.held_layers if f"side-{name}" in tet_mesh.facets]
    names = ["base", "contact", *(f"side-{name}" for name in held)]
    np.savez(
        path,
        points=tet_mesh.points_mm,
        tets=tet_mesh.tets[:, :4],
        region=tet_mesh.region,
        region_names=tet_mesh.region_names,
        facet_names=names,
        held=np.array(held, str),
        depth=DEPTH_MM,
        media=media,
        moduli=[materials[name].youngs_modulus_MPa for name in media],
        poisson=[materials[name].poisson_ratio for name in media],
        film_thickness=1e-3 * config.segment.film.thickness_um,
        radius=resolve_dot(config.dot, config.segment).radius_mm,
        augmentation=AUGMENTATION_MPA_PER_MM,
        **{f"facet:{name}": tet_mesh.facets[name][:, :3] for name in names},
    )
