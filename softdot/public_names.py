"""Where the public names of softdot live: each is loaded on first use, so that importing the package costs nothing."""

HOMES = {
    "Case": "softdot.case",
    "Config": "softdot.config.schema",
    "ConvergenceWarning": "softdot.pressed",
    "InputError": "foundation.errors",
    "MeshingError": "mesh.types",
    "Pressed": "softdot.pressed",
    "ResultWarning": "softdot.pressed",
    "Verdict": "softdot.scripting",
    "config_hash": "softdot.config.hashes",
    "config_schema": "softdot.config.schema",
    "derivatives": "softdot.scripting",
    "diagnose": "softdot.scripting",
    "load_config": "softdot.config.loading",
    "load_family": "softdot.families.folder",
    "run_config": "softdot.scripting",
    "sweep": "softdot.scripting",
}
