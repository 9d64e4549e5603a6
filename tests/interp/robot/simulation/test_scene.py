"""Scene files: what they say, and what is said of those that are none."""

from pathlib import Path

import pytest

from interp.robot.simulation.scene import SceneError, SceneObject, read_scene
from interp.values.poses import Pose

BOX = '[[object]]\nname = "table"\nshape = "box"\nsize = [800, 600, 40]\n'


def written(folder: Path, text: str) -> Path:
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_objects_are_read(tmp_path: Path) -> None:
    """Shapes have edges in mm, frames are those of KRL, and what is held has a mass."""
    text = (
        f"{BOX}frame = {{X = 700, Z = 200, A = 30}}\n"
        '[[object]]\nname = "pin"\nshape = "cylinder"\nradius = 5\nheight = 80\n'
        'held = true\nmass = 1.5\n[[object]]\nname = "ball"\nshape = "sphere"\nradius = 10\n'
    )
    table, pin, ball = read_scene(written(tmp_path, text)).objects
    frame = Pose.of(x=700, z=200, a=30)
    where = f"{tmp_path / 'scene.toml'}:1"
    assert SceneObject("table", "box", frame, (800.0, 600.0, 40.0), where=where) == table
    assert ((10.0, 10.0, 80.0), True, 1.5) == (pin.edges, pin.is_held, pin.mass)
    assert (20.0, 20.0, 20.0) == ball.edges


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[[object]\n", "1: not TOML"),
        (BOX + "x = = 3\n", "5: not TOML"),
        ("[[box]]\nname = 3\n", " 'box' is not a table [[object]]"),
        ("[[object]]\nname = 3\n", "1: name is missing"),
        ('\n[[object]]\nname = "a"\nshape = "cone"\n', "2: shape of 'a' is none of box"),
        (BOX + "radius = 3\n", "1: radius is not a member of a box"),
        (BOX.replace("800", "-1"), "1: size is -1, which cannot be"),
        (BOX.replace("800, ", ""), "1: size of a box is not three numbers"),
        (BOX.replace("800", "true"), "1: size is not a number"),
        (BOX.replace("800", "inf"), "1: size is inf, which cannot be"),
        (BOX + "frame = 3\n", "1: frame is not a table of X, Y, Z, A, B, C"),
        (BOX + "frame = {x = 3}\n", "1: frame has x"),
        (BOX + "held = 1\n", "1: held is neither true nor false"),
        (BOX + "mass = 0\n", "1: mass is 0, which cannot be"),
        (BOX + BOX, "5: a second object named 'table'"),
        ('[[object]]\nname = "a"\nshape = "mesh"\nfile = "a.exe"\n', "1: file of a mesh"),
        (
            '[[object]]\nname = "a"\nshape = "mesh"\nfile = "a.stl"\n',
            "1: file 'a.stl' is not",
        ),
        ('[[object]]\nname = "a"\nshape = "sphere"\n', "1: radius is missing"),
    ],
)
def test_scenes_that_are_none(tmp_path: Path, text: str, said: str) -> None:
    """One line names the file, the line of the object, and what is wrong."""
    path = written(tmp_path, text)
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    assert str(caught.value).startswith(f"{path}:{said}")
    assert "\n" not in str(caught.value)
