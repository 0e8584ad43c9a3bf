"""Finite-element building blocks: quadrature, kinematics, compiled element kernels, numbering, pattern, tangent."""
