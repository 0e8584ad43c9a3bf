"""The sum over elements: compiled loops that add element matrices and vectors to the tangent and the residual."""

import numba as nb


@nb.njit(cache=True)
def scatter(ke, re, dofs, slots, data, residual):  # type: ignore[no-untyped-def]
    """Add element matrices (upper triangles, packed row by row in slots) and vectors; negative = fixed.

    Two local unknowns may be the same global one (a slice's twins): their pair then counts for (i, j) and (j, i).
    """
    for e in range(ke.shape[0]):
        n = 0
        for i in range(ke.shape[1]):
            if dofs[e, i] >= 0:
                residual[dofs[e, i]] += re[e, i]
            for j in range(i, ke.shape[1]):
                slot = slots[e, n]
                if slot >= 0:
                    same = i != j and dofs[e, i] == dofs[e, j]
                    data[slot] += 2.0 * ke[e, i, j] if same else ke[e, i, j]
                n += 1


@nb.njit(cache=True)
def scatter_unsymmetric(ke, re, dofs, slots, data, excess, residual):  # type: ignore[no-untyped-def]
    """Add full element matrices (m, k, k) to the upper triangle and to the excess of the lower one.

    slots as in solve.fem.pattern.Pattern: packed upper triangle of local pairs.
    """
    for e in range(ke.shape[0]):
        n = 0
        for i in range(ke.shape[1]):
            if dofs[e, i] >= 0:
                residual[dofs[e, i]] += re[e, i]
            for j in range(i, ke.shape[1]):
                slot = slots[e, n]
                n += 1
                if slot < 0:
                    continue
                if i == j:
                    data[slot] += ke[e, i, i]
                elif dofs[e, i] == dofs[e, j]:
                    data[slot] += ke[e, i, j] + ke[e, j, i]
                else:
                    above, below = (i, j) if dofs[e, i] < dofs[e, j] else (j, i)
                    data[slot] += ke[e, above, below]
                    excess[slot] += ke[e, below, above] - ke[e, above, below]
