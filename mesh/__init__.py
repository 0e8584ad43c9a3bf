"""Meshes: one conforming, region-labelled quadratic tetrahedral mesh with named facets."""

from mesh.build import build

__all__ = ["build"]
