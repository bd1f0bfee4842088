"""What `blind` runs in a process of its own, which is given a folder and knows of no truth."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from ._diagnosis import diagnose
from ._errors import Error, SystemFailure
from ._film import render_folder


def interpreter() -> list[str]:
    """The command that starts `main` with the package of this process, wherever it was found.

    Raises
    ------
    SystemFailure
        Python is embedded in another program, and there is no interpreter to start.
    """
    if not sys.executable:
        raise SystemFailure("no Python interpreter is known that another process could run")
    package = Path(__file__).absolute().parent
    return [sys.executable, "-P", "-c", _START.format(folder=str(package), beside=str(package.parent))]


# This package and no other of its name; what stands beside it comes last, and hides no module of Python.
_START = """
import importlib.util, sys
sys.path.append({beside!r})
found = importlib.util.spec_from_file_location("glidelab", {folder!r} + "/__init__.py",
                                               submodule_search_locations=[{folder!r}])
sys.modules["glidelab"] = importlib.util.module_from_spec(found)
found.loader.exec_module(sys.modules["glidelab"])
from glidelab._apart import main
sys.exit(main(sys.argv[1:]))
"""


def main(words: Sequence[str]) -> int:
    """``diagnose FOLDER OUT EFFECT...`` leaves diagnosis.json in OUT, ``render SCENARIO FOLDER`` a new folder."""
    try:
        if words[0] == "diagnose":
            said = diagnose(words[1], without=words[3:], jobs=1).to_json()
            Path(words[2], "diagnosis.json").write_text(said, encoding="utf-8")
        else:
            render_folder(words[1], words[2], jobs=1)
    except Error as error:
        print(error, file=sys.stderr)
        return 1
    return 0
