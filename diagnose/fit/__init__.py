"""A forward model fitted to a recording: whitened samples, nuisance parameters, descent, intervals."""
