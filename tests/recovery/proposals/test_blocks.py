"""Blocks found by counting the words that lead lines."""

import pytest

from recovery.proposals.blocks import SourceFile, find_blocks


def _file(leads: str, origin: str) -> SourceFile:
    return SourceFile(tuple((lead, ((1, None),)) for lead in leads.split()), frozenset({origin}))


def test_two_words_in_balance_are_a_block() -> None:
    """Words that open and close in balance in the files of two origins are a block."""
    files = [_file("O x C y", "a"), _file("O x O x C C", "b"), _file("O y C O x C", "b")]
    found = find_blocks(files, ["O", "C"])
    assert [("O", "C", True)] == [(b.opener, b.closer, b.has_body) for b in found]


def test_a_word_only_found_inside_divides() -> None:
    """A free word whose lines are inside of every block, and nowhere else, divides it."""
    files = [_file("O M x M C", "a"), _file("O M C", "b"), _file("O M x D x C", "b")]
    (block,) = find_blocks(files, ["O", "C", "M", "D"])
    assert ({"M": "+", "D": "?"}, False) == (block.often, block.has_body)


@pytest.mark.parametrize(("origins", "often"), [("aab", {}), ("abc", {"M": "?"})])
def test_a_seldom_word_divides_where_three_origins_have_it(
    origins: str, often: dict[str, str]
) -> None:
    """Fewer than a third of the blocks have it, and nothing else."""
    files = [_file("O x C " * 4 + "O M x C", origin) for origin in origins]
    (block,) = find_blocks(files, ["O", "C", "M"])
    assert often == block.often


def test_two_statements_in_pairs_are_no_block() -> None:
    """Words with nothing between them in any file open nothing."""
    files = [_file("O C x", o) for o in "abc"]
    assert [] == find_blocks(files, ["O", "C"])


def test_words_out_of_balance_are_no_block() -> None:
    """A word with more lines than the other closes nothing."""
    files = [_file("O x C C", o) for o in "abc"]
    assert [] == find_blocks(files, ["O", "C"])


@pytest.mark.parametrize(("origins", "found"), [(1, 1), (2, 0)])
def test_a_block_of_one_origin(origins: int, found: int) -> None:
    """One origin shows a block only where nothing asks for a second one."""
    files = [_file("O x C", "a")] * 3
    assert found == len(find_blocks(files, ["O", "C"], (origins, 3)))
