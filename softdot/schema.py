"""The JSON Schema of the configuration."""

from typing import Any

from softdot.config import Config


def config_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12): description, unit, bounds and default of every key."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **Config.model_json_schema()}
