"""Cook's membrane at finite strain by NGSolve, for softdot verify: python -m benchmarks.other_codes."""

import ngsolve as ng
from netgen.geom2d import SplineGeometry

MU, KAPPA, TRACTION = 80.194, 400889.8, 6.25


def rise(order: int, h: float, grading: float) -> float:
    """Of the upper right corner; h : of the triangles, grading : at the singular corner of the clamp, mm."""
    geometry = SplineGeometry()
    corners = [(0, 0), (48, 44), (48, 60), (0, 44)]
    numbers = [geometry.AddPoint(*p, maxh=grading if p[0] == 0 and p[1] == 44 else h) for p in corners]
    for a, name in enumerate(("below", "right", "above", "left")):
        geometry.Append(["line", numbers[a], numbers[(a + 1) % 4]], bc=name)
    mesh = ng.Mesh(geometry.GenerateMesh(maxh=h, grading=0.2))
    space = ng.VectorH1(mesh, order=order, dirichlet="left") * ng.H1(mesh, order=order - 1)
    u, p = space.TrialFunction()
    f = ng.Id(2) + ng.Grad(u)
    j = ng.Det(f)
    first = ng.InnerProduct(f, f) + 1.0
    load = ng.Parameter(0.0)
    form = ng.BilinearForm(space, symmetric=True)
    form += ng.Variation(
        (MU / 2 * (j ** (-2 / 3) * first - 3) + p * (j - 1) - p * p / (2 * KAPPA)).Compile() * ng.dx(bonus_intorder=4)
    )
    form += ng.Variation(-load * u[1] * ng.ds("right"))
    state = ng.GridFunction(space)
    r, s = state.vec.CreateVector(), state.vec.CreateVector()
    for step in range(1, 6):
        load.Set(TRACTION * step / 5)
        for _ in range(15):
            form.Apply(state.vec, r)
            form.AssembleLinearization(state.vec)
            s.data = form.mat.Inverse(space.FreeDofs(), inverse="pardiso") * r
            state.vec.data -= s
            if ng.Norm(s) < 1e-9 * ng.Norm(state.vec):
                break
    return float(state.components[0](mesh(48, 60 - 1e-9))[1])


if __name__ == "__main__":
    for numbers in ((3, 4, 0.3), (3, 2, 0.3), (3, 2, 0.1)):
        print(*numbers, rise(*numbers), flush=True)
