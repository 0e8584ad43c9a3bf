"""A small segment and a made-up press of the right shape, for tests that need no solver.

The top follows a bump that just fits under the dot; the film strain is that of a membrane so deflected.
"""

from itertools import pairwise, permutations

import numpy as np

from geometry.dot import DotShape
from mesh.types import TetMesh
from solve.result import Fields, FilmPeak, PressResult, Step, Trace

LAYERS = (("medium2", 2.0, 2), ("film", 0.028, 1), ("medium1", 0.5, 1), ("effector", 1.0, 2))
HEIGHT_MM = sum(thickness for _, thickness, _ in LAYERS)
LENGTH_MM = 2.5
DOT_RADIUS_MM = 0.8
DEPTHS_MM = (0.0, 0.1, 0.2, 0.3)


def box_mesh(across: int = 6, width_mm: float = LENGTH_MM, rows: int | None = None) -> TetMesh:
    """Hexahedra on a grid, each cut into six tetrahedra around its diagonal; rows is the count in y."""
    rows = across if rows is None else rows
    x, y = np.linspace(-0.5, 0.5, across + 1) * LENGTH_MM, np.linspace(-0.5, 0.5, rows + 1) * width_mm
    z, names = _heights()
    corners, region = _kuhn(across, rows, len(z) - 1), []
    for name in names:
        region += [[n for n, _, _ in LAYERS].index(name)] * (6 * across * rows)
    grid = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).transpose(2, 1, 0, 3).reshape(-1, 3)
    points, tets = _quadratic(grid, corners)
    facets = _facets(points, tets, np.array(region))
    twin = np.arange(len(points))
    if rows == 1:
        _, first, group = np.unique(np.round(points[:, [0, 2]], 9), axis=0, return_index=True, return_inverse=True)
        twin = first[group.ravel()]
    return TetMesh(points, tets, np.array(region), tuple(n for n, _, _ in LAYERS), facets, twin, width_mm)


def _heights() -> tuple[np.ndarray, list[str]]:
    z, names = [0.0], []
    for name, thickness, count in LAYERS:
        z += list(z[-1] + thickness * np.arange(1, count + 1) / count)
        names += [name] * count
    return np.array(z), names


def _kuhn(nx: int, ny: int, nz: int) -> np.ndarray:
    stride = np.array([1, nx + 1, (nx + 1) * (ny + 1)])
    i, j, k = (a.ravel() for a in np.meshgrid(range(nx), range(ny), range(nz), indexing="ij"))
    order = np.lexsort((i, j, k))
    base = (np.column_stack([i, j, k]) @ stride)[order]
    paths = [np.cumsum([0, *stride[list(p)]]) for p in permutations(range(3))]
    return np.stack([base[:, None] + path for path in paths], axis=1).reshape(-1, 4)


def _quadratic(grid: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    a, b, c, d = (grid[corners[:, i]] for i in range(4))
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    corners = np.where(turned[:, None], corners[:, [0, 2, 1, 3]], corners)
    edges = corners[:, [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]]]
    unique, inverse = np.unique(np.sort(edges.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    points = np.vstack([grid, grid[unique].mean(axis=1)])
    return points, np.hstack([corners, len(grid) + inverse.reshape(-1, 6)])


def _facets(points: np.ndarray, tets: np.ndarray, region: np.ndarray) -> dict[str, np.ndarray]:
    local = np.array([[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]])
    faces, owner = tets[:, local].reshape(-1, 6), np.repeat(region, 4)
    low, high = points[faces].min(axis=1), points[faces].max(axis=1)

    def on(axis: int, value: float, of: int | None = None) -> np.ndarray:
        flat = (np.abs(low[:, axis] - value) < 1e-9) & (np.abs(high[:, axis] - value) < 1e-9)
        return faces[flat if of is None else flat & (owner == of)]

    z = dict(zip((n for n, _, _ in LAYERS), pairwise(np.cumsum([0.0, *(t for _, t, _ in LAYERS)])), strict=True))
    names = [n for n, _, _ in LAYERS]
    result = {
        "contact": on(2, HEIGHT_MM),
        "base": on(2, 0.0),
        "film-top": on(2, z["film"][1], names.index("film")),
        "film-bottom": on(2, z["film"][0], names.index("medium2")),
    }
    for number, name in enumerate(names):
        result[f"side-{name}"] = np.vstack([on(0, s * LENGTH_MM / 2, number) for s in (-1, 1)])
    return result


def box_dot(kind: str = "cap") -> DotShape:
    return DotShape(
        kind=kind,  # type: ignore[arg-type]
        radius_mm=DOT_RADIUS_MM,
        height_mm=0.5,
        tips_mm=np.zeros((1, 3)),
        origin_mm=np.array([0.0, 0.0, HEIGHT_MM]),
        rotation=np.eye(3),
    )


def _bump(xy: np.ndarray, ridge: bool) -> tuple[np.ndarray, np.ndarray]:
    """Shape of the deflection and its gradient (1/mm); zero on the sides."""
    spread = DOT_RADIUS_MM * 0.4
    xy = xy * [1, 0] if ridge else xy
    hold = (1 - (2 * xy / LENGTH_MM) ** 2).prod(axis=1)
    value = np.exp(-(xy**2).sum(axis=1) / (2 * spread)) * hold
    return value, -xy / spread * value[:, None]


def made_up_press(tet_mesh: TetMesh, converged: bool = True) -> PressResult:
    ridge = bool(np.any(tet_mesh.twin != np.arange(len(tet_mesh.twin))))
    steps = tuple(_step(tet_mesh, depth, ridge) for depth in (DEPTHS_MM if converged else DEPTHS_MM[:3]))
    last = steps[-1].fields
    return PressResult(
        steps=steps,
        trace=_trace(steps),
        follows_time=False,
        progress=np.linspace(0.0, 1.0, len(steps)),
        tet_mesh=tet_mesh,
        converged=converged,
        failure=None if converged else "the contact did not converge beyond 0.2 mm",
        electrode_names=("film",),
        capacitance_F=np.array([23.7e-12]),
        unknowns=3 * len(tet_mesh.points_mm),
        linear_solver="pardiso",
        max_relative_residual=3e-12,
        film_peak=_peak(last),
        warnings=("the film's stress of 62 MPa exceeds its yield stress of 50 MPa",),
    )


def _peak(fields: Fields) -> FilmPeak:
    """Nothing is singular here: the largest values everywhere."""
    strain, stress = float(fields.film_strain[:, :2].max()), float(fields.film_stress_Pa[:, :2].max())
    density = fields.charge_density_C_per_m2
    return FilmPeak(strain, stress, (min(0.0, float(density.min())), float(density.max())), 0.0, strain, stress)


def _trace(steps) -> Trace:
    """The histories of the steps alone."""
    depth = np.array([step.indentation_m for step in steps])
    force = np.array([step.reaction_force_N for step in steps])
    return Trace(
        time_s=np.arange(len(steps), dtype=float),
        indentation_m=depth,
        dot_path_m=depth,
        reaction_force_N=force,
        contact_force_N=force[:, None] * [0, 0, 1],
        film_charge_C=np.array([step.film_charge_C for step in steps]),
        contact_area_m2=1e-6 * force,
    )


def _step(tet_mesh: TetMesh, depth: float, ridge: bool) -> Step:
    points, centroid = tet_mesh.points_mm, tet_mesh.points_mm[tet_mesh.tets[:, :4]].mean(axis=1)
    value, slope = _bump(points[:, :2], ridge)
    fall = (points[:, 2] / HEIGHT_MM) ** 0.8
    u = np.column_stack([-0.15 * depth * slope * (fall * (1 - fall))[:, None] * 4, -depth * value * fall])
    value, slope = _bump(centroid[:, :2], ridge)
    modulus = np.array([1e6, 2e9, 5e6, 1e6])[tet_mesh.region]
    squash = depth * value / HEIGHT_MM
    stress = np.zeros((len(squash), 6))
    stress[:, :3] = -(modulus * squash)[:, None] * [0.4, 0.4, 1.0]
    film = np.flatnonzero(tet_mesh.region == 1)
    strain = np.zeros((len(film), 6))
    strain[:, :2] = 0.5 * (0.6 * depth * slope[film]) ** 2
    film_stress = 2e9 * strain
    contact = np.unique(tet_mesh.facets["contact"])
    r2 = (points[contact, :2] ** 2 * ([1, 0] if ridge else [1, 1])).sum(axis=1)
    gap = r2 / (2 * DOT_RADIUS_MM) - depth - u[contact, 2]
    charge = film_stress[:, 0] * 23e-12 + film_stress[:, 1] * 2.3e-12
    fields = Fields(
        displacement_m=u * 1e-3,
        cauchy_stress_Pa=stress,
        green_lagrange_strain=stress / 1e9,
        von_mises_Pa=0.6 * modulus * squash,
        pressure_Pa=-stress[:, :3].mean(axis=1),
        max_stretch=1 + 0.5 * squash,
        film_tets=film,
        film_strain=strain,
        film_stress_Pa=film_stress,
        charge_density_C_per_m2=charge,
        contact_nodes=contact,
        gap_m=gap * 1e-3,
        contact_pressure_Pa=np.where(gap < 0.01, 1e6 * depth, 0.0),
        contact_traction_Pa=np.where(gap < 0.01, 1e6 * depth, 0.0)[:, None] * [0.0, 0.0, -1.0],
    )
    return Step(
        time_s=0.0,
        dot_force_N=np.zeros(3),
        indentation_m=depth * 1e-3,
        reaction_force_N=2.0 * depth**1.5,
        film_charge_C=np.array([4e-9 * depth**2]),
        open_circuit_voltage_V=np.array([170.0 * depth**2]),
        newton_iterations=0 if depth == 0 else 5,
        relative_residual=0.0 if depth == 0 else 3e-12,
        dot_position_m=np.array([0.0, 0.0, HEIGHT_MM - depth]) * 1e-3,
        fields=fields,
    )
