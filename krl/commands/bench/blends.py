"""`krl bench blends`: whether blends keep their laws, on programs drawn by seed."""

from collections.abc import Mapping
from typing import Annotated, Any

import typer
from rich.console import Console

from krl.errors import FINE
from krl.extras import ARM, expected_extras
from krl.terminal.options import JsonOption
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import figures

_WORDS = {
    "time": "no slower than exact stops",
    "straight": "points on a straight way cost nothing",
    "speed": "no axis is too fast",
    "acceleration": "nor speeds up too hard",
    "jerk": "nor jerks",
    "override_mm": "the path is the same at any override",
    "programmed": "nothing is faster than programmed at a low one",
}


def blends(
    json_file: JsonOption = None,
    programs: Annotated[
        int, typer.Option(min=1, max=1_000_000, metavar="N", help="Programs of each kind.")
    ] = 200,
    seed: Annotated[int, typer.Option(min=0, metavar="N", help="The first seed.")] = 1,
) -> int:
    """Measure blends: time compared with exact stops, and use of axis limits each millisecond.

    Programs are drawn by seed; the worst of each law is shown with its seed.
    """
    check_files(json_file)
    with expected_extras(*ARM):
        from interp.bench.blends import measure
    with progress_bar("measuring", programs) as advance:
        record = {"bench": "blends", **measure(programs, seed, advance)}
    write_json(record, json_file, indent=1)
    _print(record)
    return FINE


def _print(record: Mapping[str, Any]) -> None:
    console = Console(highlight=False)
    median = record["median_time"]
    beside = "" if median is None else f"; median time {median:.3f} of that with exact stops"
    console.print(
        f"{record['programs']:,} programs of each sort from seed {record['seed']}, "
        f"{record['blends']:,} blends, {record['refused']:,} refused{beside}",
        soft_wrap=True,
    )
    table = figures(("law", "broken", "of", "worst", "its seed", "most"))
    for name, law in record["laws"].items():
        worst = ("", "") if law["worst"] is None else (f"{law['worst']:.6g}", str(law["seed"]))
        row = (f"{law['broken']:,}", f"{law['of']:,}", *worst, f"{law['most']:g}")
        table.add_row(_WORDS[name], *row)
    console.print(table)
