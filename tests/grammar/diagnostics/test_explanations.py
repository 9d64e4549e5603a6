"""Every code is explained by a program that has a finding of it, and by one that has none."""

import pytest

from grammar.check.framework import check_project
from grammar.check.project_check import CheckOptions, Content, check_whole
from grammar.check.suppression_comments import apply_suppressions
from grammar.diagnostics.codes import by_code
from grammar.diagnostics.explanations import example_files, explanation

#: What no short program shows: other bytes than text, sizes, and 256 routines.
WITHOUT = {"KRL002", "KRL003", "KSS2710"}


def found_in(example: str, *, is_complete: bool) -> set[str]:
    """The codes of all findings in the files of an example."""
    options = CheckOptions(stops=True, is_complete=is_complete)
    files = example_files(example)
    contents = [Content(name, "", text.encode()) for name, text in files.items()]
    results = check_whole(contents, options)
    all_ = check_project(one.findings for one in results)
    found = set()
    for name, result in zip(files, results, strict=True):
        its = [one for one in all_ if one.path == name]
        kept = apply_suppressions(name, its, result.comments, options.wanted_codes)
        found |= {one.code for one in kept}
    return found


@pytest.mark.parametrize("name", sorted(set(by_code()) - WITHOUT))
def test_example(name: str) -> None:
    """The wrong program has a finding of the code, the right one has none."""
    known = explanation(name)
    assert known is not None
    found = [
        name in found_in(program, is_complete=known.is_whole)
        for program in (known.wrong, known.right)
    ]
    assert [True, False] == found
