"""The reader of a line that slides by: a filter over place, speed, posture, contact and dots, on the charge."""
