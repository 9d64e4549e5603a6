"""`krl demo`: runs the example program and opens its page."""

import webbrowser
from pathlib import Path
from typing import Annotated

import typer

from krl.commands.run import run
from krl.errors import InputError, say
from krl.running.run_options import Robot, RunOptions

_NAME, _SUBMIT = "search_demo", "count_parts"
#: The folders of the example in an installed package and in a checkout.
_PLACES = (
    Path(__file__).parents[1] / _NAME,
    Path(__file__).parents[2] / "corpus" / "programs" / _NAME,
)


def demo(
    html: Path = Path("krl-demo.html"),
    opened: Annotated[bool, typer.Option("--open/--no-open")] = True,
) -> int:
    """Run an example that finds parts by touch and carries them, and open its page.

    A six-axis arm in MuJoCo, with inputs from a script; takes a few seconds. The page shows the arm
    in motion, the line being executed, signals and axes over time.

    Options:
        html: The page to write.
        opened: Open the page in the browser.
    """
    folder = next((place for place in _PLACES if place.is_dir()), None)
    if folder is None:
        raise InputError("the program of the demonstration is missing: install the package again")
    program = folder / "R1" / "Program" / f"{_NAME}.src"
    script = program.with_suffix(".io")
    words = f"krl run {program} --robot mujoco --io {script} --submit {_SUBMIT} --html {html}"
    say(words, err=True)
    options = RunOptions(robot=Robot.MUJOCO, io=script, submit=_SUBMIT)
    status = run(program, options=options, html=html)
    if opened:
        webbrowser.open(html.absolute().as_uri())
    return status
