"""A dot for the configuration from a scanned surface."""
