"""The statistics of a diagnosis, on whitened arrays alone: no forward model, no files."""
