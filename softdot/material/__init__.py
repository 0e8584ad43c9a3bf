"""A law for a configuration from the tests of a specimen, with its relaxation and its softening."""
