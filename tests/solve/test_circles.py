"""Newton's iterations that run in a circle: found by residual and discrete states, left by shorter steps."""

import numpy as np

from solve.solution.newton import MAX_CIRCLES, Circles

OPEN, CLOSED = np.array([False]), np.array([True])


def halves(y):
    """A root at y = 0 with a flat piece on each side, whose full Newton steps lead across and back for ever."""
    return (CLOSED, y + 2.0, 1.0) if y > 0.0 else (OPEN, y - 2.0, 1.0)


def test_full_steps_between_two_states_are_found_and_each_time_halved_once_more():
    y, circles, shares = 1.0, Circles(), []
    for _ in range(12):
        status, residual, slope = halves(y)
        shares.append(circles.share(status, abs(residual)))
        y -= shares[-1] * residual / slope
    assert shares[:4] == [1.0, 1.0, 1.0, 0.5]
    assert 0.25 in shares


def test_a_residual_that_falls_is_never_shortened():
    circles = Circles()
    assert [circles.share(CLOSED, 10.0**-n) for n in range(12)] == [1.0] * 12
    assert circles.count == 0


def test_the_same_residual_with_other_nodes_in_contact_is_no_circle():
    circles = Circles()
    assert [circles.share(state, 1.0) for state in (OPEN, CLOSED)] == [1.0, 1.0]
    assert circles.count < MAX_CIRCLES
