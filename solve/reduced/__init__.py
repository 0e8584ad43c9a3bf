"""Reduced models of one segment, made from presses of the 3D model: see build.build_reduced."""
