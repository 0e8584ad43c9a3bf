"""A server that holds a bounded number of connections, so that half-open ones of others keep nobody out."""

import weakref
from typing import Any

from tornado.httpserver import HTTPServer
from tornado.iostream import IOStream

MOST_CONNECTIONS = 128
LONGEST_HEAD_S, LONGEST_BODY_S = 10.0, 60.0
"""For the head of a request, or the next one of a connection; and for its body."""
TRUSTED: "weakref.WeakSet[Any]" = weakref.WeakSet()
"""Connections over which the key has come: they are not closed in favour of others."""


class BoundedServer(HTTPServer):
    """Where there are too many connections, the oldest over which no key has come is closed."""

    _open: list[IOStream]

    def handle_stream(self, stream: IOStream, address: Any) -> None:
        """A new connection."""
        self._open = [one for one in getattr(self, "_open", []) if not one.closed()]
        if len(self._open) >= MOST_CONNECTIONS:
            oldest = next((one for one in self._open if one not in TRUSTED), stream)
            oldest.close()
        self._open.append(stream)
        if not stream.closed():
            super().handle_stream(stream, address)
