"""Cut files of flat patterns: DXF and SVG in millimetres, with named layers."""
