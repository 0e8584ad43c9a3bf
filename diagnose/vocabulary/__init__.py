"""What may be missing in a segment rig: every mechanism and component that the rig admits, by coordinates to fit."""
