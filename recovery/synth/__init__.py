"""Programs of any volume, made by chance: valid, in the manner of real cells, for tests of scale.

Never evidence for a grammar: they hold what this package knows of KRL and nothing else. They are
made by type, from what each place can name, so that a checker finds nothing to say about them.
"""

from recovery.synth.cells import File, files
from recovery.synth.writing import Written, write_cells

__all__ = ["File", "Written", "files", "write_cells"]
