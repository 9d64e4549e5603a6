"""`krl conform --fault`: plants a fault or a mutant in the controller, arm or interpreter."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from krl.errors import InputError

if TYPE_CHECKING:
    from conformance.sensitivity.planted_faults import Fault

_SHOWN = 12


@contextmanager
def planted(words: str) -> Iterator[str]:
    """Plant a fault while the context lasts; yield its full name.

    ``words`` are a part of its name that identifies it. For a mutant they are its name, or the file
    and line if only one is there. Raises `InputError` if they identify none.
    """
    if "interp" in words and ":" in words:
        with _mutant(words) as name:
            yield name
        return
    fault = _chosen(words)
    with fault.plant():
        yield fault.name


@contextmanager
def _mutant(words: str) -> Iterator[str]:
    from conformance.sensitivity.code_exchange import InvalidMutant
    from conformance.sensitivity.mutants import named, of_line

    file, _, line = words.rpartition(":")
    on_line = of_line(file, int(line)) if file.endswith(".py") and line.isdigit() else []
    if len(on_line) > 1:
        choices = "; ".join(f"{one.name}: {one.was} becomes {one.now}" for one in on_line)
        raise InputError(f"--fault {words}: ambiguous; it may be {choices}")
    try:
        mutant = on_line[0] if on_line else named(words)
        with mutant.plant():
            yield f"{mutant.file}:{mutant.line}: {mutant.was} becomes {mutant.now}"
    except KeyError as error:
        raise InputError(f"--fault {words}: there is no such mutant") from error
    except InvalidMutant as error:
        raise InputError(f"--fault {words}: {error}") from error


def _chosen(words: str) -> "Fault":
    """Return the fault with these words, or the only one that contains them; ignores case."""
    from conformance.sensitivity.planted_faults import FAULTS

    wanted = words.strip().casefold()
    fitting = [one for one in FAULTS if wanted in one.name.casefold()]
    exact = [one for one in fitting if one.words.casefold() == wanted]
    if len(exact or fitting) == 1:
        return (exact or fitting)[0]
    if not fitting:
        raise InputError(
            f"--fault {words}: no such fault; 'krl bench conform --json' names them all"
        )
    choices = "; ".join(one.words for one in fitting[:_SHOWN])
    more = f"; and {len(fitting) - _SHOWN} more" if len(fitting) > _SHOWN else ""
    raise InputError(f"--fault {words}: ambiguous; it may be {choices}{more}")
