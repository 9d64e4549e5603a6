"""Every code is explained by a program that has a finding of it, and by one that has none."""

import re

from grammar.check.project.project_check import CheckOptions, Content, found_in_project, recheck
from grammar.check.project.suppression_comments import apply_suppressions
from grammar.diagnostics.codes import by_code
from grammar.diagnostics.explanations import explanation

#: What no short program shows: other bytes than text, sizes, and 256 routines.
WITHOUT = {"KRL002", "KRL003", "KSS2710"}

HEAD = re.compile(r"^-- (\S+) --\n", re.MULTILINE)


def found_in(example: str, *, is_complete: bool) -> set[str]:
    """The codes of all findings in the files of an example."""
    options = CheckOptions(stops=True, is_complete=is_complete)
    first, *parts = HEAD.split(example)
    names = parts[::2] or ["work.dat" if first.lstrip().startswith("DEFDAT") else "work.src"]
    files = dict(zip(names, parts[1::2] or [first], strict=True))
    contents = [Content(name, "", text.encode()) for name, text in files.items()]
    known = recheck(contents, options, {})
    results = [one.checked for one in known]
    all_ = found_in_project(contents, known)
    found = set()
    for name, result in zip(files, results, strict=True):
        its = [one for one in all_ if one.path == name]
        kept = apply_suppressions(name, its, result.comments, options.wanted_codes)
        found |= {one.code for one in kept}
    return found


def test_examples() -> None:
    """The wrong program of each code has a finding of it, the right one has none."""
    found = {}
    for name in sorted(set(by_code()) - WITHOUT):
        known = explanation(name)
        assert known is not None, name
        found[name] = tuple(
            name in found_in(program, is_complete=known.is_whole)
            for program in (known.wrong, known.right)
        )
    assert {} == {name: said for name, said in found.items() if said != (True, False)}
