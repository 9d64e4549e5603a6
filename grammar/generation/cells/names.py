"""Names that make sense, at most 24 characters long and each taken once, and remarks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from grammar.generation.choices import Choices
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Enumeration, Structure, Type

__all__ = ["LONGEST", "WORDS", "Names", "Vocabulary", "Writing"]

LONGEST = 24
"""Characters of a name [TYP-05]."""


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The words of a language that names and remarks of a cell are made of."""

    trades: tuple[str, ...]
    stations: tuple[str, ...]
    verbs: tuple[str, ...]
    things: tuple[str, ...]
    integers: tuple[str, ...]
    reals: tuple[str, ...]
    truths: tuple[str, ...]
    texts: tuple[str, ...]
    states: tuple[str, ...]
    remarks: tuple[str, ...]
    messages: tuple[str, ...]


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


def _lines(text: str) -> tuple[str, ...]:
    return tuple(line.strip() for line in text.strip().splitlines())


WORDS = {
    "en": Vocabulary(
        trades=_words(
            "palletising tending gluing milling handling welding painting deburring packing sorting"
            " foundry assembly washing testing cutting polishing dispensing bending moulding"
        ),
        stations=_words(
            "infeed outfeed lathe press oven belt table magazine gripper camera gauge washer marker"
            " scale labeller shelf drawer fixture clamp gate lift buffer pallet tray cooler riveter"
            " spindle nozzle cutter torch dresser changer turner bench rack chute feeder mould die"
        ),
        verbs=_words(
            "pick place load unload open close check search approach leave start reset prepare"
            " measure count park clean change teach wait mount release turn align weigh mark scan"
        ),
        things=_words(
            "part box sheet layer row slot hole seam edge point path tool base batch order cycle"
            " blank door bottle screw plate ring frame cover label tile bar disc"
        ),
        integers=_words("count index number step code level size limit total tries rank shift"),
        reals=_words("speed height width offset weight force torque length angle depth gap pitch"),
        truths=_words(
            "ready done full empty busy found fault present locked active enabled wanted"
        ),
        texts=_words("text title serial recipe caption remark"),
        states=_words(
            "idle waiting loading working unloading cleaning blocked finished stopped default"
        ),
        remarks=_lines(
            """
            wait until the {station} is free
            the {thing} must not be touched here
            next {thing} of the {station}
            old value, kept for the restart
            distance from the {thing} to the {station}
            only in automatic mode
            do not change, measured on site
            {station}: {thing} first, then the rest
            see the drawing of the {station}
            counts every {thing}; reset at shift change
            was slower before the {station} was rebuilt
            sensor of the {station} bounces, so ask twice
            """
        ),
        messages=_lines(
            """
            {station}: no {thing}
            {station} is not ready
            {thing} lost; check the {station}
            wrong {thing} in the {station}
            {station}: time is over
            {thing} %1 is finished
            please empty the {station}
            """
        ),
    ),
    "de": Vocabulary(
        trades=_words(
            "Palettieren Beladen Kleben Fraesen Handhaben Schweissen Lackieren Entgraten Packen"
            " Sortieren Giesserei Montage Waschen Pruefen Schneiden Polieren Biegen"
        ),
        stations=_words(
            "Zufuhr Abfuhr Presse Ofen Band Tisch Magazin Greifer Kamera Waage Spanner Schranke"
            " Ablage Palette Puffer Lift Regal Lade Drehteller Duese Fraeser Brenner Wechsler"
            " Wender Kuehlung Stempel Bohrer Nieter Rutsche Form"
        ),
        verbs=_words(
            "Hole Bringe Lade Entlade Oeffne Schliesse Pruefe Suche Starte Richte Messe Zaehle"
            " Parke Reinige Wechsle Warte Drehe Wiege Stempel Loese"
        ),
        things=_words(
            "Teil Karton Blech Lage Reihe Platz Loch Naht Kante Punkt Bahn Rohling Deckel Flasche"
            " Schraube Platte Ring Rahmen Etikett Tuer Auftrag Takt"
        ),
        integers=_words("Zaehler Nummer Schritt Code Stufe Anzahl Grenze Summe Versuch Index"),
        reals=_words("Tempo Hoehe Breite Versatz Gewicht Kraft Moment Laenge Winkel Tiefe Abstand"),
        truths=_words("Bereit Fertig Voll Leer Belegt Gefunden Fehler Da Zu Aktiv Frei Gewollt"),
        texts=_words("Text Titel Serie Rezept Hinweis"),
        states=_words("Ruhe Warten Laden Arbeiten Entladen Reinigen Gesperrt Beendet Default"),
        remarks=_lines(
            """
            warten, bis {station} frei ist
            {thing} hier nicht berühren
            alter Wert, für den Wiederanlauf
            Abstand zwischen {thing} und {station}
            nur im Automatikbetrieb
            nicht ändern, vor Ort gemessen
            siehe Zeichnung zu {station}
            zählt jeden Durchlauf; beim Schichtwechsel löschen
            früher langsamer, vor dem Umbau
            Fühler prellt, daher zweimal prüfen
            {station}: zuerst {thing}, dann der Rest
            """
        ),
        messages=_lines(
            """
            {station}: {thing} fehlt
            {station} nicht bereit
            {thing} verloren; {station} prüfen
            {station}: Zeit überschritten
            {thing} %1 fertig
            bitte {station} leeren
            """
        ),
    ),
}


class Writing(Enum):
    """How names are put together from words."""

    UPPER = "PART_COUNT"
    TYPED = "nPartCount"
    PLAIN = "PartCount"


_PREFIXES = {"INT": "n", "REAL": "r", "BOOL": "b", "CHAR": "s"}
_PREFIXES |= {"FRAME": "f", "E6POS": "x", "E6AXIS": "a"}


def _prefix(type_: Type) -> str:
    if isinstance(type_, Enumeration):
        return "e"
    return _PREFIXES.get(str(type_), "st" if isinstance(type_, Structure) else "")


class Names:
    """Makes names that nobody has taken yet; ``outer`` are names that are seen from here.

    They are put together from two words or more, so that none is a word of the language.
    """

    __slots__ = ("_outer", "_taken", "choices", "vocabulary", "writing")

    def __init__(
        self,
        choices: Choices,
        vocabulary: Vocabulary,
        writing: Writing,
        outer: Names | None = None,
    ) -> None:
        self.choices = choices
        self.vocabulary = vocabulary
        self.writing = writing
        self._outer = outer
        self._taken: set[str] = set()

    def inner(self, choices: Choices | None = None) -> Names:
        """Names for a place within, where those of here are seen."""
        return Names(choices or self.choices, self.vocabulary, self.writing, self)

    def is_taken(self, name: str) -> bool:
        """Whether the name is used here or further out, in whatever letters."""
        upper = name.upper()
        names: Names | None = self
        while names is not None:
            if upper in names._taken:
                return True
            names = names._outer
        return False

    def take(self, name: str) -> str:
        """The name, or one with a number behind it where it is taken."""
        found, number = name[:LONGEST], 1
        while self.is_taken(found):
            number += 1
            suffix = f"_{number}" if name[-1].isdigit() else str(number)
            found = name[: LONGEST - len(suffix)] + suffix
        self._taken.add(found.upper())
        return found

    def joined(self, words: Sequence[str], type_: Type | None = None) -> str:
        """Words put together as this cell does it."""
        if self.writing is Writing.UPPER:
            return "_".join(words).upper()
        name = "".join(word.capitalize() for word in words)
        is_typed = self.writing is Writing.TYPED and type_ is not None
        return f"{_prefix(type_)}{name}" if is_typed and type_ else name

    def variable(self, type_: Type, _letter: str = "V") -> str:
        """A new name for a variable, after something of the trade."""
        element = type_.element if isinstance(type_, Array) else type_
        words = self._words(element, self.vocabulary.stations)
        thing = self.choices.pick(self.vocabulary.things)
        return self.take(self.joined((thing, self.choices.pick(words)), element))

    def _words(self, type_: Type | None, others: Sequence[str]) -> Sequence[str]:
        """What a value of a type is called."""
        words = self.vocabulary
        if type_ in (INT, REAL):
            return words.integers if type_ == INT else words.reals
        if type_ in (BOOL, CHAR):
            return words.truths if type_ == BOOL else words.texts
        return others

    def routine(self, station: str) -> str:
        """A new name for a routine that does something at a station."""
        words = self.vocabulary
        return self.take(self.joined((self.choices.pick(words.verbs), station)))

    def function(self, result: Type) -> str:
        """A new name for a function with a result of a type."""
        words = self.vocabulary
        thing, station = self.choices.pick(words.things), self.choices.pick(words.stations)
        last = self.choices.pick(self._words(result, (station,)))
        return self.take(self.joined((thing, last, "of")))

    def label(self) -> str:
        """A new name for a label."""
        words = ("again", "next", "retry", "cycle", "ready", "once_more")
        return self.take(
            self.joined((self.choices.pick(words), self.choices.pick(("part", "loop"))))
        )

    def remark(self) -> str:
        """A comment, without its semicolon."""
        return self._filled(self.choices.pick(self.vocabulary.remarks))

    def message(self) -> str:
        """A text for the operator, in its quotes."""
        return f'"{self._filled(self.choices.pick(self.vocabulary.messages))}"'

    def _filled(self, text: str) -> str:
        words = self.vocabulary
        return text.replace("{station}", self.choices.pick(words.stations)).replace(
            "{thing}", self.choices.pick(words.things)
        )
