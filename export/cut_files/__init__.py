"""Cut files of a kit and their pictures: DXF (R2010) and SVG in millimetres, with named layers."""
