"""Arrays of segments: which layers run through, where each segment lies, and the solids. Imports nothing by itself."""
