"""Touches by a sensor of the tests' own: dots pass six channels, each a smooth bump, and sums of them saturate."""

import numpy as np

from softdot.reading.learned_kernel.touches import letter_cells

SAMPLING_HZ, SAMPLES, LAG_S = 50.0, 40, 0.2


def made_touches(letters, repeats, seed=0, noise=0.02):
    """Arrays of a file of touches, the letters one after the other."""
    random = np.random.default_rng(seed)
    letter = np.repeat(np.array(list(letters)), repeats)
    dots = np.array([letter_cells()[one] for one in letter])[:, None] >> np.arange(6) & 1
    gains = np.random.default_rng(99).uniform(-0.4, 1.0, (3, 6)) + np.repeat(np.eye(3), 2, axis=1)  # row, channel
    delay_s = 0.03 * np.arange(6)
    time = np.arange(SAMPLES)[None, :, None] / SAMPLING_HZ - random.normal(0.0, 0.02, (len(letter), 1, 1))
    bumps = [np.exp(-0.5 * ((time - 0.25 - column * LAG_S - delay_s) / 0.07) ** 2) for column in range(2)]
    drive = sum(bumps[dot // 3] * (dots[:, dot, None, None] * gains[dot % 3]) for dot in range(6))
    taxels = random.normal(1.0, 0.1, (len(letter), 1, 1)) * np.tanh(drive / 2.0) + 0.1 * time
    taxels = 3.0 + taxels + noise * random.standard_normal(taxels.shape)
    return {"taxels": taxels, "letter": letter, "sampling_Hz": SAMPLING_HZ}
