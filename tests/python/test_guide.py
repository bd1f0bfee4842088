"""docs/guide/python.md: its blocks run, in order."""

import contextlib
import io
import os
import re

from tests.python.support import SOURCE, InFolder, needs


class Guide(InFolder):
    @needs("pandas", "matplotlib")
    def test_every_block_runs(self):
        import matplotlib
        matplotlib.use("Agg")
        text = (SOURCE / "docs" / "guide" / "python.md").read_text()
        blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(blocks), 5)
        (self.folder / "scenarios").symlink_to(SOURCE / "scenarios")
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        names: dict = {}
        said = io.StringIO()
        for block in blocks:
            with self.subTest(block.splitlines()[0]), contextlib.redirect_stdout(said):
                exec(compile(block, "python.md", "exec"), names)  # pylint: disable=exec-used
        # The paper's mu falls with the mass: a friction that does not grow with the load, or one of each configuration.
        self.assertEqual(names["diagnosis"].verdict, "effect")
        self.assertIn(names["diagnosis"].effects[0].id, ("load_independent_friction", "configuration_friction"))
        self.assertEqual(len(names["analysis"].configurations), 3)
        self.assertIn("0.335 kg: K/m 2.7", said.getvalue())
