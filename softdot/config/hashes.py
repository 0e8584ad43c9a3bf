"""Hashes of all that a user states of a press, by which results are kept."""

import hashlib
import json
from pathlib import Path

from softdot.config.loading import with_implied_values
from softdot.config.schema import Config


def config_hash(config: Config) -> str:
    """SHA-256 of the canonical text of the resolved configuration, in hexadecimal.

    How the parts are made is left out: it changes no press.

    >>> from softdot.config.loading import load_config
    >>> six, seven = load_config(None, ["press.load_steps=6"]), load_config(None, ["press.load_steps=7"])
    >>> config_hash(six) == config_hash(seven)
    False
    """
    tables = with_implied_values(config).model_dump(mode="json", exclude={"fabrication"})
    text = json.dumps(tables, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def input_hash(config: Config) -> str:
    """SHA-256, in hexadecimal, of a configuration and of the files of waveform, mesh and profile that it names: of all
    that a user states of a press.
    """
    waveform = config.press.waveform
    file = Path(waveform.file) if waveform is not None and waveform.file is not None else None
    content = file.read_bytes() if file is not None and file.is_file() else b""
    if config.mesh.file is not None:
        from mesh.files.user_mesh import file_contents

        content += file_contents(config.mesh.file)
    if config.dot.profile_csv is not None and Path(config.dot.profile_csv).is_file():
        content += Path(config.dot.profile_csv).read_bytes()
    return hashlib.sha256(config_hash(config).encode() + content).hexdigest()
