"""What the studio's processes do: each task takes plain arguments and gives plain data."""
