"""Records are written whole, and whatever names of files they hold."""

import json
from pathlib import Path

import pytest

from krl.errors import InputError
from krl.terminal.output_files import check_files, json_list_pieces, json_pieces, write_json


def test_names_that_are_no_text(tmp_path: Path) -> None:
    """Half of a character, as names of files have it that are no UTF-8, comes back as it was."""
    record = {"path": "a\udcff.src", "text": "é 𝄞 \x1b"}
    write_json(record, tmp_path / "new" / "a.json")
    assert record == json.loads((tmp_path / "new" / "a.json").read_text(encoding="utf-8"))
    assert ["a.json"] == [file.name for file in (tmp_path / "new").iterdir()]


def test_what_fails_leaves_no_half(tmp_path: Path) -> None:
    """A record that cannot be told leaves the older one as it was, and nothing beside it."""
    target = tmp_path / "a.json"
    write_json({"old": 1}, target)
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_json({"new": float("nan")}, target)
    assert {"old": 1} == json.loads(target.read_text(encoding="utf-8"))
    assert [target] == list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "records", [[], [{}], [{"a": "two\nlines", "b": [1, {"c": None}]}, {"path": "a\udcff"}, []]]
)
def test_records_one_by_one_are_the_same_json(records: list[object]) -> None:
    """To the character, so that it does not matter which of both writes a list."""
    assert "".join(json_list_pieces(iter(records))) == "".join(json_pieces(records, 1))


@pytest.mark.parametrize("record", [{}, [1], {"a": 1, "é": [], "b": [{"c": []}, "\n"], "d": {}}])
def test_a_record_in_pieces_is_the_same_json(record: object) -> None:
    """To the character, whatever its fields are; a list is written item by item."""
    assert json.dumps(record, ensure_ascii=False) == "".join(json_pieces(record))


def test_no_piece_is_as_long_as_the_record() -> None:
    """A long list comes in many pieces."""
    record = {"long": [{"number": number} for number in range(50_000)]}
    pieces = list(json_pieces(record))
    assert len(pieces) > 4
    assert record == json.loads("".join(pieces))


def test_places_where_no_file_can_be(tmp_path: Path) -> None:
    """A folder, and a place below a file, are refused before any work; a new folder is none."""
    file = tmp_path / "a"
    file.touch()
    check_files(None, file, tmp_path / "new" / "deep" / "a.json")
    for target, why in ((tmp_path, "a folder, not a file"), (file / "x" / "b", "is not a folder")):
        with pytest.raises(InputError, match=why):
            check_files(None, target)
