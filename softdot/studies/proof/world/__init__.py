"""The world that is diagnosed: its own finite elements, laws, circuit and noise; nothing here is shared with solve."""
