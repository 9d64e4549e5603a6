"""Programs of any volume, made by chance: valid, in the manner of real cells, for tests of scale.

Never evidence for a grammar: they hold what this package knows of KRL and nothing else. They are
made by type, from what each place can name, so that a checker finds nothing to say about them.
"""

from grammar.generation.cells.cells import File, files
from grammar.generation.cells.writing import Written, write_cells

__all__ = ["File", "Written", "files", "write_cells"]
