"""Presses of the 3D model that fill tables over depth: run by worker processes, kept on disk, smoothed."""
