"""Generator of the MJCF of the built-in arm: ``python -m interp.robot.models.generate``."""

from __future__ import annotations

from interp.robot.models import DEFAULT, default_machine, model_file
from interp.robot.simulation.mujoco_model import mjcf_of


def generated() -> str:
    """Return the text of the model, with a comment on its origin."""
    word = (
        f"<!-- Made of {DEFAULT}.dat by python -m interp.robot.models.generate; do not edit.\n"
        f"     {DEFAULT}.dat names the sources,"
        " interp/robot/simulation/mujoco_model.py what is assumed. -->\n"
    )
    return word + mjcf_of(default_machine())


if __name__ == "__main__":
    path = model_file(f"{DEFAULT}.xml")
    path.write_text(generated(), encoding="utf-8", newline="\n")
    print(f"{path.name}: written")
