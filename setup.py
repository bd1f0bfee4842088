"""What pyproject.toml cannot say: the version is CMakeLists.txt's, CMake builds the module, and pybind11's version says which
numpy the module is for."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.build_py import build_py

ROOT = Path(__file__).resolve().parent


class BuildWithCMake(build_ext):
    """Builds in a folder of its own, or in GLIDELAB_BUILD, which is configured already."""

    def build_extension(self, ext):
        target = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        build = Path(os.environ.get("GLIDELAB_BUILD", self.build_temp)).resolve()
        if "GLIDELAB_BUILD" not in os.environ:
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            "-DGLIDELAB_TESTS=OFF", "-DGLIDELAB_BENCH=OFF", "-DGLIDELAB_PYTHON=ON",
                            f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "glidelab_python", "-j", str(os.cpu_count() or 1)],
                       check=True)
        target.mkdir(parents=True, exist_ok=True)
        modules = list((build / "python" / "glidelab").glob("_glidelab*.so"))
        if len(modules) != 1:
            raise RuntimeError(f"{build}: found {len(modules)} modules, expected one")
        shutil.copy2(modules[0], target / Path(self.get_ext_fullpath(ext.name)).name)


class BuildWithScenarios(build_py):
    """The package's sources, and the scenarios, which lie outside of them."""

    def run(self):
        super().run()
        if not getattr(self, "editable_mode", False):  # then the checkout's are found
            shutil.copytree(ROOT / "scenarios", Path(self.build_lib) / "glidelab" / "scenarios", dirs_exist_ok=True)


FIND_PYBIND11 = """cmake_minimum_required(VERSION 3.22)
project(pybind11_version NONE)
set(PYBIND11_NOPYTHON ON)
find_package(pybind11 CONFIG REQUIRED)
file(WRITE ${CMAKE_BINARY_DIR}/version ${pybind11_VERSION})
"""


def pybind11_version():
    """Of the one that CMake finds, or that the build of GLIDELAB_BUILD has found."""
    where = []
    if "GLIDELAB_BUILD" in os.environ:
        cache = (Path(os.environ["GLIDELAB_BUILD"]) / "CMakeCache.txt").read_text()
        where = [f"-D{found}" for found in re.findall("^pybind11_DIR:PATH=.*", cache, re.MULTILINE)]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "CMakeLists.txt").write_text(FIND_PYBIND11)
        subprocess.run(["cmake", "-S", folder, "-B", folder, *where], check=True, stdout=subprocess.DEVNULL)
        return (Path(folder) / "version").read_text()


def numpy_for(pybind11):
    """The requirement on numpy of a module made with this version of pybind11: 2.12 is the first that knows numpy 2."""
    major, minor = (int(part) for part in pybind11.split(".")[:2])
    return "numpy>=1.24" if (major, minor) >= (2, 12) else "numpy>=1.24,<2"


if __name__ == "__main__":
    version = re.search(r"project\(glidelab VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    setup(version=version[1], install_requires=[numpy_for(pybind11_version())],
          ext_modules=[Extension("glidelab._glidelab", sources=[])], cmdclass={"build_ext": BuildWithCMake, "build_py": BuildWithScenarios})
