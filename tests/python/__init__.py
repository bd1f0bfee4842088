"""Tests of the Python module: ctest runs them with PYTHONPATH of the build tree."""
