"""Docstrings in numpydoc's form: every argument, what is returned, what is raised, and where it comes from."""

import builtins
import dataclasses
import inspect
import re
import unittest

import glidelab

PLAIN = {"explain", "estimator", "load_scenario", "scenarios_folder"}  # no method of anybody's is behind these
HEADINGS = ("Parameters", "Returns", "Raises", "Notes", "Examples")


def sections_of(text):
    """Heading to text, in their order."""
    parts = re.split(r"^(\w+)\n-+\n", inspect.cleandoc(text), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


class Functions(unittest.TestCase):
    def functions(self):
        for name in glidelab.__all__:
            function = getattr(glidelab, name)
            if inspect.isfunction(function):
                yield name, function, sections_of(function.__doc__)

    def test_every_argument_is_described_and_nothing_else(self):
        for name, function, sections in self.functions():
            said = [one.strip().lstrip("*") for line in re.findall(r"^(\S.*)$", sections.get("Parameters", ""), re.MULTILINE)
                    for one in line.split(" : ")[0].split(",")]
            self.assertEqual(sorted(said), sorted(inspect.signature(function).parameters), name)

    def test_what_is_returned_and_raised_is_said_in_numpydoc_s_order(self):
        for name, function, sections in self.functions():
            self.assertIn("Returns", sections, name)
            if inspect.signature(function).parameters and name != "explain":
                self.assertIn("Raises", sections, name)
                for one in re.findall(r"^(\S.*)$", sections["Raises"], re.MULTILINE):
                    for error in one.split(", "):
                        self.assertTrue(hasattr(glidelab, error) or hasattr(builtins, error), f"{name}: {error}")
            self.assertEqual(list(sections), [one for one in HEADINGS if one in sections], name)

    def test_every_field_of_a_result_is_described(self):
        for name in glidelab.__all__:
            shown = getattr(glidelab, name)
            if dataclasses.is_dataclass(shown):
                said = {one for line in re.findall(r"^(\S.*?) : ", sections_of(shown.__doc__).get("Attributes", ""), re.MULTILINE)
                        for one in line.split(", ")} | set(re.findall(r"`(\w+)`", shown.__doc__))
                lacking = {field.name for field in dataclasses.fields(shown)} - said
                self.assertEqual(lacking, set(), name)

    def test_a_method_has_its_source(self):
        for name, _, sections in self.functions():
            if name not in PLAIN:
                self.assertGreater(len(sections.get("Notes", "").strip()), 20, name)
