"""Compiled pieces of the displacement stiffness of a ten-node tetrahedron, arranged for vector registers.

K_ai,bk = int g_aJ A_iJkL g_bL with the first elasticity tensor A = d(FS)/dF (Bonet and Wood, Nonlinear Continuum
Mechanics for Finite Element Analysis, 2008, ch. 9) is not formed as A. With E'_v = B_v,kb u'_kb,
    T_iJ,kb = F_iM CC_(MJ)v B_v,kb + S_JL g_bL delta_ik,      K_ai,kb = sum over points and J of w g_aJ T_iJ,kb
holds the geometric part and needs half the products of B^t CC B. Columns run node by node inside each direction,
column 10 k + b, so that rows are long and contiguous; K is symmetric, so only the directions k >= i are formed.
"""

from solve.compiled import MATH, piece
from solve.tensors import I_OF, J_OF, NUMBER_OF

COLUMNS = 32  # 30 filled up to whole registers of eight


@piece(MATH)
def transpose_gradients(grad, g):  # type: ignore[no-untyped-def]
    """Write gradients (10, 3) transposed into g (3, 10)."""
    for a in range(10):
        for i in range(3):
            g[i, a] = grad[a, i]


@piece(MATH)
def strain_rows(f, g, b):  # type: ignore[no-untyped-def]
    """Write B (6, COLUMNS) from F (3, 3) and g (3, 10); columns beyond 30 are left as they are."""
    for k in range(3):
        for v in range(3):
            x = f[k, v]
            for a in range(10):
                b[v, 10 * k + a] = x * g[v, a]
        for v in range(3, 6):
            x, y = f[k, I_OF[v]], f[k, J_OF[v]]
            for a in range(10):
                b[v, 10 * k + a] = x * g[J_OF[v], a] + y * g[I_OF[v], a]


@piece(MATH)
def _weighted_sum(x, b, j):  # type: ignore[no-untyped-def]
    """Sum of x_v b_v,j over the six v."""
    return x[0] * b[0, j] + x[1] * b[1, j] + x[2] * b[2, j] + x[3] * b[3, j] + x[4] * b[4, j] + x[5] * b[5, j]


@piece(MATH)
def add_weighted_rows(x, b, total):  # type: ignore[no-untyped-def]
    """Add sum_v x_v b_v to total (COLUMNS,)."""
    for j in range(COLUMNS):
        total[j] += _weighted_sum(x, b, j)


@piece(MATH)
def first_tangent_rows(f, g, s, cc, b, cb, t, row):  # type: ignore[no-untyped-def]
    """Write rows row to row + 3 of T of one point, for weighted S (6,) and CC (6, 6); cb (6, COLUMNS + 8) is
    scratch.
    """
    for v in range(6):
        for j in range(COLUMNS):
            cb[v, j] = _weighted_sum(cc[v], b, j)
    for i in range(3):
        _fold(f, g, s, cb, t, row, i, COLUMNS - 8 * i)


@piece(MATH)
def _fold(f, g, s, cb, t, row, i, width):  # type: ignore[no-untyped-def]
    """Write T of direction i from the columns of directions k >= i."""
    x, y, z = f[i, 0], f[i, 1], f[i, 2]
    for d in range(3):
        v0, v1, v2 = NUMBER_OF[0, d], NUMBER_OF[1, d], NUMBER_OF[2, d]
        for j in range(width):
            t[i, row + d, j] = x * cb[v0, 10 * i + j] + y * cb[v1, 10 * i + j] + z * cb[v2, 10 * i + j]
        for a in range(10):
            t[i, row + d, a] += s[v0] * g[0, a] + s[v1] * g[1, a] + s[v2] * g[2, a]


@piece(MATH)
def displacement_stiffness(g, t, k, ke):  # type: ignore[no-untyped-def]
    """Write the upper triangle of K_uu, unknowns 3 a + i, from all rows g (r, 10) and t (3, r, COLUMNS)."""
    for i in range(3):
        _product(g, t[i], COLUMNS - 8 * i, k)
        _store(k, i, ke)


@piece(MATH)
def _product(g, t, width, k):  # type: ignore[no-untyped-def]
    """Write g^t t into k (10, width), two rows of k and three of t at a time: they then stay in registers."""
    for a in range(0, 10, 2):
        for j in range(width):
            k[a, j] = 0.0
            k[a + 1, j] = 0.0
        for r in range(0, g.shape[0], 3):
            x0, x1, x2 = g[r, a], g[r + 1, a], g[r + 2, a]
            y0, y1, y2 = g[r, a + 1], g[r + 1, a + 1], g[r + 2, a + 1]
            for j in range(width):
                t0, t1, t2 = t[r, j], t[r + 1, j], t[r + 2, j]
                k[a, j] += x0 * t0 + x1 * t1 + x2 * t2
                k[a + 1, j] += y0 * t0 + y1 * t1 + y2 * t2


@piece(MATH)
def _store(k, i, ke):  # type: ignore[no-untyped-def]
    """Write the blocks (i, m >= i), k (10, 10 (m - i) + b), into the upper triangle of ke."""
    for a in range(10):
        for b in range(a, 10):
            ke[3 * a + i, 3 * b + i] = k[a, b]
    for m in range(i + 1, 3):
        for a in range(10):
            for b in range(a):
                ke[3 * b + m, 3 * a + i] = k[a, 10 * (m - i) + b]
            for b in range(a, 10):
                ke[3 * a + i, 3 * b + m] = k[a, 10 * (m - i) + b]
