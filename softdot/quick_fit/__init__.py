"""A quick fit of named parts of a rig to a recording, without a diagnosis."""
