"""What is made to build a segment: moulds, clamp frame, jig and the volumes to pour. Lengths in millimetres."""
