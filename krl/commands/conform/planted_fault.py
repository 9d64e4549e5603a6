"""`krl conform --fault`: a fault planted into the controller, the arm or the machine in Python."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from krl.errors import InputError

if TYPE_CHECKING:
    from conformance.sensitivity import Fault

__all__ = ["planted"]

_SHOWN = 12


@contextmanager
def planted(words: str) -> Iterator[str]:
    """Plant a fault as long as the context lasts; gives its whole name.

    ``words`` are some of it, enough to tell it apart. Raises `InputError` where they are not.
    """
    fault = _chosen(words)
    with fault.plant():
        yield f"{fault.group}: {fault.words}"


def _chosen(words: str) -> "Fault":
    """The one with these words, or with these among its own, whatever the letter case."""
    from conformance.sensitivity.trial import all_faults

    wanted = words.strip().casefold()
    fitting = [one for one in all_faults() if wanted in f"{one.group}: {one.words}".casefold()]
    exact = [one for one in fitting if one.words.casefold() == wanted]
    if len(exact or fitting) == 1:
        return (exact or fitting)[0]
    if not fitting:
        raise InputError(
            f"--fault {words}: there is none; 'krl bench conform --json' names them all"
        )
    told = "; ".join(one.words for one in fitting[:_SHOWN])
    more = f"; and {len(fitting) - _SHOWN} more" if len(fitting) > _SHOWN else ""
    raise InputError(f"--fault {words}: which one? {told}{more}")
