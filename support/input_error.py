"""The base of exceptions about input, in every package."""

from __future__ import annotations


class InputError(Exception):
    """Input that cannot be used; the message is one line that a person can act on.

    The command line prints it and ends with the status 2, wherever it was raised.
    """
