"""Recordings as a laboratory hands them over: read, checked, aligned in time and cut into phases."""
