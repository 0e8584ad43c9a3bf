"""What may be off in a segment that is made, and what that does to force and voltage."""
