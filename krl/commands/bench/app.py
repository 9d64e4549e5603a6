"""`krl bench`: the commands below it."""

from krl.commands.bench.arm import arm
from krl.commands.bench.check import check
from krl.commands.bench.conform import conform
from krl.commands.bench.fuzz import fuzz
from krl.commands.bench.growth import growth
from krl.commands.bench.mutation import mutation
from krl.commands.bench.programs import programs
from krl.commands.bench.real_code import real_code
from krl.commands.bench.recover import recover
from krl.commands.bench.scale import scale
from krl.commands.bench.vm import vm
from krl.terminal.options import Commands

app = Commands(help="Measure the tools themselves.")
for _command in (
    *(mutation, vm, arm, programs, conform, fuzz, real_code, recover, check, growth, scale),
):
    app.command(_command.__name__.replace("_", "-"))(_command)


@app.callback()
def _bench() -> None:
    """Measure the tools themselves: figures, and never a verdict."""
