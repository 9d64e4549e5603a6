"""The soak tests share modules of this folder, which no package holds."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
