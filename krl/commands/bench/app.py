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
app.command("mutation")(mutation)
app.command("vm")(vm)
app.command("arm")(arm)
app.command("programs")(programs)
app.command("conform")(conform)
app.command("fuzz")(fuzz)
app.command("real-code")(real_code)
app.command("recover")(recover)
app.command("check")(check)
app.command("growth")(growth)
app.command("scale")(scale)


@app.callback()
def _bench() -> None:
    """Measure the tools themselves: figures, and never a verdict."""
