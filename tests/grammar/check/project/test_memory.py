"""What a check keeps of files that it is done with."""

import gc

from grammar.check.project.project_check import CheckOptions, Content, recheck
from grammar.syntax import ast

PROGRAM = b"""DEF KEPT()
INT N
N = 1
LOOP
N = N + OTHER(N)
IF N > 5 THEN
EXIT
ENDIF
ENDLOOP
END
DEFFCT INT OTHER(M :IN)
INT M
RETURN 2 * M
ENDFCT
"""


def test_the_tree_of_a_checked_file_is_freed_at_once() -> None:
    """No garbage has to be collected for it: that takes longer the more there is."""
    was_enabled = gc.isenabled()
    gc.collect()
    gc.disable()
    try:
        [file] = recheck([Content("KEPT.SRC", "", PROGRAM)], CheckOptions(), {})
        left = [one for one in gc.get_objects() if type(one) is ast.Routine]
    finally:
        if was_enabled:
            gc.enable()
    assert file.checked.findings is not None
    assert "KEPT" not in {one.name.text for one in left}
