"""Forward models of a diagnosis: the segment in 3D, a coupon at one material point, a proportional sensor."""
