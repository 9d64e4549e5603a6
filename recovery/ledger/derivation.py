"""The reading of a program, by which two grammars that both accept it can be told apart."""

from __future__ import annotations

from grammar.parser.derivation import Deriver, Steps
from grammar.parser.recognizer import Recognizer

__all__ = ["Reading", "reading"]

#: Each token by its name, with the rules that begin and end before it.
Reading = tuple[tuple[Steps, str], ...]


def reading(recognizer: Recognizer, text: str) -> Reading | None:
    """How a program is read; ``None`` where the text is no program.

    Another keyword or other rules are another reading; the order of alternatives in a rule is not.
    """
    kinds = recognizer.kinds(text)
    if recognizer.run(recognizer.start, kinds)[1] is not None:
        return None
    deriver = Deriver(recognizer.grammar, recognizer.lexer)
    found = deriver.derive(kinds)
    if found is None:
        return None
    actions = (deriver.actions[number] for number in found.actions)
    return tuple((action.steps, recognizer.lexer.names[action.kind]) for action in actions)
