"""The configuration: schema, defaults, mistakes in sentences, its model, and the rig of a recording."""
