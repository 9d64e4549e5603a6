"""Messages of the Debug Adapter Protocol: JSON after a header with its length."""

import json
from collections.abc import Iterator
from threading import Lock
from typing import Any, BinaryIO, Final

from krl.errors import InputError

#: An object of JSON.
Json = dict[str, Any]
_LARGEST: Final = 64_000_000
_LONGEST_LINE: Final = 1_000


class Connection:
    """The connection to a client over two streams; several threads may send messages."""

    def __init__(self, source: BinaryIO, target: BinaryIO) -> None:
        self._source = source
        self._target = target
        self._lock = Lock()
        self._sent = 0

    def requests(self) -> Iterator[Json]:
        """Yield the client's requests until it disconnects; raises `InputError` for bad ones."""
        while True:
            length = self._length()
            if length is None:
                return
            data = self._source.read(length)
            if len(data) < length:
                return
            try:
                message = json.loads(data)
            except (ValueError, RecursionError) as error:
                raise InputError(f"a message that is not JSON: {error}") from None
            if not isinstance(message, dict) or not isinstance(message.get("command"), str):
                raise InputError("a message that is not a request")
            yield message

    def respond(self, request: Json, body: Json | None, refusal: str = "") -> None:
        """Respond to a request with a body, or with the reason of a refusal."""
        message: Json = {"type": "response", "request_seq": request.get("seq", 0)}
        message |= {"command": request["command"], "success": not refusal}
        if body is not None:
            message["body"] = body
        if refusal:
            message["message"] = refusal
            message["body"] = {"error": {"id": 1, "format": refusal, "showUser": True}}
        self._send(message)

    def event(self, name: str, **body: Any) -> None:
        """Send an event."""
        self._send({"type": "event", "event": name, "body": body})

    def _length(self) -> int | None:
        """Return the length of the next message; ``None`` if the client has disconnected."""
        length: int | None = None
        while True:
            line = self._source.readline(_LONGEST_LINE)
            if not line:
                return None
            if not line.strip():
                break
            name, _, value = line.partition(b":")
            if name.strip().lower() == b"content-length":
                digits = value.strip()
                length = int(digits) if digits.isdigit() and len(digits) < 10 else -1
        if length is None or not 0 <= length <= _LARGEST:
            raise InputError("a message without a valid length")
        return length

    def _send(self, message: Json) -> None:
        with self._lock:
            self._sent += 1
            data = json.dumps({"seq": self._sent, **message}).encode()
            self._target.write(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))
            self._target.flush()
