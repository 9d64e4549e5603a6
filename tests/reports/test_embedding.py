"""Foreign text in a page: shown as it is, run never."""

import json

import pytest

from reports.rendering.embedding import embedded_json, inline_source, printable, script_hash


def test_control_characters_become_one_visible_sign_each() -> None:
    """Terminal escapes, NUL and DEL are shown as pictures, and columns stay right."""
    assert printable("a\x1b[0m\x00\x7f") == "a␛[0m␀␡"


def test_characters_that_hide_or_reorder_text_are_replaced() -> None:
    """A bidirectional override, a zero-width space and a lone surrogate cannot disguise a path."""
    assert printable("a\u202eb\u200bc\ud800d") == "a\ufffdb\ufffdc\ufffdd"


def test_ordinary_text_of_any_script_is_kept() -> None:
    """Umlauts and Chinese comments are no danger and stay."""
    assert printable("Größe 位置 §") == "Größe 位置 §"


def test_embedded_json_cannot_end_its_element_and_reads_back_unchanged() -> None:
    """No angle bracket is left, yet the value is the same after reading."""
    value = {"text": "</script><!-- & \u2028 \u202e \x00 \x1b", "more": ["]]>"]}
    embedded = str(embedded_json(value))
    assert [mark for mark in "<>&\u2028\u202e\x00\x1b" if mark in embedded] == []
    assert json.loads(embedded) == value


def test_embedded_json_with_a_lone_surrogate_can_be_encoded() -> None:
    """A surrogate left by a lenient decoder does not stop the page from being written."""
    assert json.loads(str(embedded_json("x\udc80y")).encode("utf-8")) == "x\udc80y"


@pytest.mark.parametrize("source", ["a = '</script>'", "/* </STYLE */", "if (a <!--b) {}"])
def test_a_source_that_would_end_its_element_is_refused(source: str) -> None:
    """Our own script may not hold what the reader of the page takes for its end."""
    with pytest.raises(ValueError, match="cannot be inlined"):
        inline_source(source)


def test_script_hash_is_the_policy_expression_of_the_script() -> None:
    """The hash of the empty script is the well-known one, base64 of SHA-256."""
    assert script_hash("") == "sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU="
