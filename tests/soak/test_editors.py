"""Editors that people use, with the lines that docs/editors.md gives them (`make editors`)."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.soak.given import REPOSITORY

pytestmark = pytest.mark.soak

CELL = """DEF CELL()
INT i
Fetch(nParts, 1)
FOR i=1 TO 9 STEP = 2
HALT
ENDFOR
END
DEF Fetch(n:IN,m:IN)
INT n,m
END
"""
DATA = "DEFDAT CELL\nDECL INT nParts=8 ; how many are on the pallet\nENDDAT\n"
LOOP = """DEF LOOP1()
INT N
N=0
FOR N=1 TO 5
  $OUT[N]=TRUE
ENDFOR
END
"""


def test_neovim_shows_and_debugs_krl(tmp_path: Path) -> None:
    """Neovim's own client of the language server, and nvim-dap, get what they ask for."""
    nvim, plugin = shutil.which("nvim"), os.environ.get("KRL_NVIM_DAP")
    if nvim is None or plugin is None:
        pytest.skip("make editors brings Neovim and nvim-dap")
    files = {"cell.src": CELL, "cell.dat": DATA, "loop1.src": LOOP, "krl.toml": ""}
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    document = (REPOSITORY / "docs" / "editors.md").read_text(encoding="utf-8")
    blocks = re.findall(r"(?:^    .*\n|^\n(?=    ))+", document, re.MULTILINE)
    settings = "".join(block for block in blocks if "vim." in block or 'require("dap")' in block)
    added = f'vim.opt.runtimepath:append({{ "{plugin}", "{REPOSITORY}/editors/vim" }})\n'
    (tmp_path / "init.lua").write_text(added + settings, encoding="utf-8")
    result = tmp_path / "result.json"
    words = [nvim, "--headless", "-i", "NONE", "-n", "-u", "init.lua", "-S"]
    subprocess.run(
        [*words, str(REPOSITORY / "tests" / "soak" / "neovim.lua")],
        cwd=tmp_path,
        env=os.environ
        | {
            "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
            "KRL_RESULT": str(result),
            **{f"XDG_{kind}_HOME": str(tmp_path / "xdg") for kind in ("DATA", "STATE", "CONFIG")},
        },
        check=True,
        timeout=600,
    )
    found = json.loads(result.read_text(encoding="utf-8"))
    hover = found.pop("hover")
    assert "how many are on the pallet" in hover
    assert found == {
        "filetype": "krl",
        "filetype_in_capitals": "krl",
        "findings": [[4, "KRL001"], [8, "KRL117"], [8, "KRL117"]],
        "symbols": ["CELL", "Fetch"],
        "signature": "DEF Fetch(n:IN INT, m:IN INT)",
        "references": 2,
        "highlights": 1,
        "hints": 2,
        "offers_the_name": True,
        "token": "function",
        "renamed": "Fetch(nPieces, 1)",
        "fixed": "FOR i=1 TO 9 STEP  2",
        "formatted": "  HALT",
        "definition": "DECL INT nPieces=8 ; how many are on the pallet",
        # the condition, a step on, a step back, and back to the start
        "stops": ["3 (no value)", "5 3", "4 3", "5 3", "3 (no value)"],
        "exit": 0,
    }
