"""What a step of the filter is given: the sensor with its channels, and how a hand moves."""

from typing import NamedTuple

from foundation.arrays import Bools, Floats


class Sensor(NamedTuple):
    """What the charges are compared with: charges of single dots, what dots beside each other add, pitches, and floor
    of the variance and drift of each channel (n,).

    drift_pC, bend_pC : standard deviations in a step of the walk of the drift, and of the change of the bend
    of its course. silent_mm : distance of the array's middle from the middle row beyond which nothing tells whether the
    far row has dots.
    """

    lone: Floats
    beside: Floats
    within: Bools
    dot_pitch_mm: float
    cell_pitch_mm: float
    alive: Bools
    floor_pC2: Floats
    drift_pC: Floats
    bend_pC: Floats
    silent_mm: float


class HandMotion(NamedTuple):
    """Log-probabilities of a step, and constants of the weights.

    faster, jump : steps of the log-speed; relax, settle : shares of the way of log-speed and mean to each other in a
    step. log_blank, log_dots (4,) : of a blank column, and of each other pattern, by kind_before. log_unseen : of one
    that passes without contact. log_aside : of the array being elsewhere beside the line. height, height_spread : mean
    and variance of the height of dots, as shares of the nominal charge. rough : standard deviation of a charge over the
    charge; degrees : of Student's t. fade : what is left of a wander across the line. gain_spread, least_gain_spread,
    gain_walk : variance of a gain at first, at least, and by which it may change. kept_log : how far behind the best
    hypotheses are kept; most_weighed, most_kept : how many of them the charges weigh, and how many are left then.
    """

    step_s: float
    faster: float
    jump: float
    relax: float
    settle: float
    log_jump: float
    log_stop: float
    log_go: float
    log_back: float
    log_forth: float
    log_turn: float
    log_lift: float
    log_touch: float
    log_aside: float
    log_blank: Floats
    log_dots: Floats
    log_unseen: float
    height: float
    height_spread: float
    rough: float
    degrees: float
    fade: float
    gain_spread: float
    least_gain_spread: float
    gain_walk: float
    kept_log: float
    most_weighed: int
    most_kept: int
