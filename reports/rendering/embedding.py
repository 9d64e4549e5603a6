"""Embedding of untrusted text in a page, so that it cannot run or break the markup.

KRL files may contain anything: `</script>` in a comment, terminal escapes, NUL, or bidirectional
overrides that display text in a different order.
"""

import base64
import hashlib
import json
import re
from typing import Any

from markupsafe import Markup

_REPLACEMENT = "\N{REPLACEMENT CHARACTER}"
# C1 controls, soft hyphen, zero-width and bidirectional controls, line separators, surrogates.
_UNSEEN_CLASS = "\x80-\x9f\xad\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ud800-\udfff"
_UNSEEN = re.compile(f"[{_UNSEEN_CLASS}]")
_CONTROL_PICTURES = {code: 0x2400 + code for code in range(0x20)} | {0x7F: 0x2421}
# An element can be ended, or a comment opened, only by the first three.
_UNSAFE_IN_JSON = re.compile(f"[<>&\x7f{_UNSEEN_CLASS}]")
_ENDS_ELEMENT = re.compile(r"</\s*(script|style)|<!--", re.IGNORECASE)


def printable(text: str) -> str:
    """Return ``text`` with visible replacements for invisible and control characters.

    Each character becomes one character, so that columns stay valid. This is for one-line text:
    tabs and line ends are replaced too.
    """
    if text.isprintable():
        return text
    return _UNSEEN.sub(_REPLACEMENT, text.translate(_CONTROL_PICTURES))


def embedded_json(value: Any) -> Markup:
    """Return ``value`` as JSON for a ``<script type="application/json">`` element."""
    plain = json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    safe = _UNSAFE_IN_JSON.sub(lambda found: f"\\u{ord(found.group()):04x}", plain)
    return Markup(safe)  # contains nothing that could end the element


def inline_source(source: str) -> Markup:
    """Return our own script or style sheet as markup for the inside of its element.

    Raises ValueError if the source contains text that would end the element.
    """
    found = _ENDS_ELEMENT.search(source)
    if found:
        raise ValueError(f"source holds {found.group()!r} and cannot be inlined")
    return Markup(source)  # ours, and checked above


def script_hash(source: str) -> str:
    """Return the Content-Security-Policy source expression that permits only this script."""
    digest = hashlib.sha256(source.encode("utf-8")).digest()
    return f"sha256-{base64.b64encode(digest).decode('ascii')}"
