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
    package = str(Path(__file__).absolute().parent.parent)
    return [sys.executable, "-P", "-c", f"import sys; sys.path.insert(0, {package!r}); "
                                  "from glidelab._apart import main; sys.exit(main(sys.argv[1:]))"]


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
