"""The skin of a sensor in a robot simulator, made from a kernel."""
