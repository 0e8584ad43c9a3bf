"""Finite-element building blocks: quadrature, kinematics, compiled element kernels, numbering, sparsity."""
