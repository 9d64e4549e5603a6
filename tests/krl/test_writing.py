"""Records are written whole, and whatever names of files they hold."""

import json
from pathlib import Path

from krl.writing import write_json


def test_names_that_are_no_text(tmp_path: Path) -> None:
    """Half of a character, as names of files have it that are no UTF-8, comes back as it was."""
    record = {"path": "a\udcff.src", "text": "é 𝄞 \x1b"}
    write_json(record, tmp_path / "new" / "a.json")
    assert record == json.loads((tmp_path / "new" / "a.json").read_text(encoding="utf-8"))
    assert ["a.json"] == [file.name for file in (tmp_path / "new").iterdir()]
