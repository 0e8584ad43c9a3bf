"""A kernel that no solver made: smooth bumps of charge under each segment, with crosstalk, and a sinking surface."""

import numpy as np

from softdot.arrays.kernel import ArrayKernel
from softdot.config.hashes import config_hash
from softdot.config.loading import load_config
from softdot.version import installed_version

PITCH = 2.5
FILE = "examples/array-cell.toml"


def bump(distance):
    """1 in the middle, smoothly to 0."""
    return 1.0 / (1.0 + (np.abs(distance) / 1.25) ** 4)


def made_kernel(interaction=1.0, crosstalk=0.06, deepest=0.3):
    """Charge of a dot d deep: 250 pC (d / 0.3 mm)^1.5 over a segment's middle; force 0.4 N (d / 0.3 mm)^1.3."""
    x, y, depth = np.linspace(-5.0, 5.0, 41), np.linspace(-5.5, 5.5, 45), np.linspace(0.0, deepest, 9)
    centres = np.array([(PITCH * (c - 0.5), PITCH * (r - 1.0)) for r in range(3) for c in range(2)])
    gx, gy = np.meshgrid(x, y, indexing="ij")
    edge = bump(np.maximum(np.abs(gx) - 1.2, 0.0) * 1.2) * bump(np.maximum(np.abs(gy) - 2.5, 0.0) * 1.2)
    far = np.exp(-np.hypot(gx[..., None] - centres[:, 0], gy[..., None] - centres[:, 1]) / 4.0)
    shape = bump(gx[..., None] - centres[:, 0]) * bump(gy[..., None] - centres[:, 1])
    shape = edge[..., None] * ((1.0 - crosstalk) * shape + crosstalk * far)
    charge = 250.0 * (depth / 0.3)[:, None] ** 1.5 * shape[:, :, None, :]
    force = 0.4 * (depth / 0.3) ** 1.3 * edge[..., None]
    px, py, load = np.linspace(-5.0, 5.0, 9), np.linspace(-5.5, 5.5, 11), np.linspace(0.0, deepest, 4)
    gap = np.hypot(px[:, None, None, None] - px[:, None], py[:, None, None] - py)
    sinking = interaction * 0.12 * load[:, None, None] * np.exp(-gap / 2.0)[:, :, None]
    config = load_config(FILE)
    about = {
        "centres_mm": centres.tolist(),
        "capacitance_pF": [20.0] * 6,
        "labels": [f"segment-r{r}c{c}" for r in (1, 2, 3) for c in (1, 2)],
        "pitch_mm": PITCH,
        "size_mm": [2.3, 2.3],
        "standard": "marburg-medium",
        "dot": {"base_diameter_mm": 1.5, "height_mm": 0.5},
        "softdot_version": installed_version(),
        "config_hash": config_hash(config),
        "kernel_error": {"force_percent": 0.0, "charge_percent": 0.0},
        "config": config.model_dump(mode="json"),
    }
    return ArrayKernel(x, y, depth, charge, force, px, py, load, sinking, about)
