"""Every notebook of examples/notebooks runs from top to bottom."""

from tests.python.support import SOURCE, InFolder, needs


class Notebooks(InFolder):
    @needs("nbclient", "nbformat", "ipykernel", "pandas", "matplotlib")
    def test_they_run(self):
        import nbclient
        import nbformat
        paths = sorted((SOURCE / "examples" / "notebooks").glob("*.ipynb"))
        self.assertEqual(len(paths), 6)
        for path in paths:
            with self.subTest(path.name):
                notebook = nbformat.read(path, as_version=4)
                nbformat.validate(notebook)
                self.assertTrue(all(not cell.get("outputs") for cell in notebook.cells), "outputs are not stored")
                nbclient.NotebookClient(notebook, timeout=300, resources={
                    "metadata": {"path": str(path.parent)}}).execute()
