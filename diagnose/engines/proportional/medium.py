"""The medium that strains the film of a sensor of unknown geometry, and how far it is strained."""

from solve.materials.parameters import Yeoh

MEDIUM = Yeoh(c10_MPa=0.5, poisson_ratio=0.495)
"""Whatever strains the film of a sensor of unknown geometry: of shear modulus 1, the unit of stress there."""
LARGEST_MEDIUM_STRAIN = 0.1
"""Strain of the medium at the largest force: small enough that relaxation is linear."""
