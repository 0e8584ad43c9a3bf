"""The forward model of a rig whose segment is known: tables pressed by the 3D model, read in milliseconds."""
