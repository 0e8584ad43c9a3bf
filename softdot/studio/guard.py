"""Who may talk to the page: its own browser tab, with the key of this start. Threats: docs/studio_security.md."""

import hmac
import secrets
import time
from collections.abc import Mapping
from dataclasses import dataclass, field

POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data:",
        "connect-src 'self'",
        "font-src 'none'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    )
)
"""Nothing from elsewhere, no script or style in the text of the page, no frame around it."""
PAPER_POLICY = (
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
    "frame-ancestors 'self'"
)
"""For reports, which hold their own scripts: they run as a page of nowhere, which reaches neither the studio nor the
net."""
FRAME_POLICY = "default-src 'none'; style-src 'self'; frame-src 'self'; base-uri 'none'; frame-ancestors 'none'"
"""For the page around a report: its frame stays with the studio's own addresses."""
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
    "Server": "softdot",
}


LONGEST_QUESTION_S, MOST_QUESTIONS = 10.0, 1000


def new_key() -> str:
    """256 random bits."""
    return secrets.token_urlsafe(32)


@dataclass(frozen=True)
class Guard:
    """hosts : names and addresses, with the port, under which the page is known. key : random.

    questions : that tabs were asked, and when.
    """

    hosts: frozenset[str]
    key: str = field(default_factory=new_key)
    questions: dict[str, float] = field(default_factory=dict)

    @classmethod
    def of(cls, host: str, port: int, key: str | None = None) -> "Guard":
        """host : the address to which the server is bound. key : of this port before, None for a new one."""
        names = {"127.0.0.1", "localhost", "[::1]"} if host in ("127.0.0.1", "localhost", "::1") else {_bracketed(host)}
        return cls(frozenset(f"{name}:{port}" for name in names), key or new_key())

    def greeting(self, nonce: str) -> dict[str, str]:
        """What shows a tab that comes back that this is the studio it knows, and what the tab is to answer with.

        Neither side sends the key: another program may listen on the port by now, or hold a tab open.
        """
        now = time.monotonic()
        for old, asked in list(self.questions.items()):
            if now - asked > LONGEST_QUESTION_S or len(self.questions) >= MOST_QUESTIONS:
                del self.questions[old]
        question = new_key()
        self.questions[question] = now
        return {"proof": self._proof("studio", nonce), "question": question}

    def answered(self, question: str, proof: str) -> bool:
        """Whether a tab holds the key; each question counts once."""
        asked = self.questions.pop(question, None)
        if asked is None or time.monotonic() - asked > LONGEST_QUESTION_S:
            return False
        return hmac.compare_digest(self._proof("tab", question).encode(), proof.encode())

    def _proof(self, who: str, text: str) -> str:
        return hmac.new(self.key.encode(), f"{who}:{text}".encode(), "sha256").hexdigest()

    def refusal(self, headers: Mapping[str, str], key: str | None, needs_origin: bool) -> str | None:
        """Why a request is refused, None where it is not.

        key : that of the request, None where it asks for what everybody may see. needs_origin : the request changes
        something, or opens a socket; then a browser states the page from which it comes.
        """
        if headers.get("Host", "") not in self.hosts:
            return "this server does not answer under that name"
        origin = headers.get("Origin")
        if (needs_origin or origin is not None) and origin not in {f"http://{host}" for host in self.hosts}:
            return "another page asked for this"
        if key is not None and not hmac.compare_digest(key.encode(), self.key.encode()):
            return "the key is missing or wrong: open the address that softdot studio printed when it started"
        return None


def _bracketed(host: str) -> str:
    """An IPv6 address as it stands in a URL."""
    return f"[{host}]" if ":" in host else host
