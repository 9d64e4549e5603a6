"""Readers of other people's bytes keep their laws on every input that is kept."""

from __future__ import annotations

import pytest

from tests.soak.readers import KEPT, READERS


@pytest.mark.parametrize("name", READERS)
def test_an_input_that_is_kept_breaks_no_reader(name: str) -> None:
    """It is read, or refused in one line, and the law of its reader holds."""
    inputs = [file.read_bytes() for file in sorted((KEPT / name).iterdir())]
    assert inputs
    for data in inputs:
        READERS[name](data)
