"""From a recording and a forward model to findings: what is missing, by how much, and how sure that is."""
