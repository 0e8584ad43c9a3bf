"""Commit, diagnose, reveal, verify: a truth is fixed by a hash before anybody looks at its recording.

A commitment is the SHA-256 of a random salt and the truth as canonical JSON. The salt keeps short truths from being
guessed; nobody can exchange the truth afterwards (Blum, Coin flipping by telephone, 1981).
"""

import hashlib
import json
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Sealed:
    """A truth with its salt; digest is what may be shown before."""

    truth: Mapping[str, Any]
    salt: str

    @property
    def digest(self) -> str:
        """SHA-256 in hexadecimal."""
        return digest_of(self.truth, self.salt)


def seal(truth: Mapping[str, Any]) -> Sealed:
    """Seal a truth with a new salt of 256 bits."""
    return Sealed(truth, secrets.token_hex(32))


def digest_of(truth: Mapping[str, Any], salt: str) -> str:
    """SHA-256 of salt and truth."""
    text = json.dumps(truth, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(f"{salt}\n{text}".encode()).hexdigest()


def matches_digest(truth: Mapping[str, Any], salt: str, digest: str) -> bool:
    """Whether truth and salt have this digest."""
    return secrets.compare_digest(digest_of(truth, salt), digest)
