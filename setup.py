"""What pyproject.toml cannot say: the version is CMakeLists.txt's, and CMake builds the module."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

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


VERSION = re.search(r"project\(glidelab VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
setup(version=VERSION[1], ext_modules=[Extension("glidelab._glidelab", sources=[])],
      cmdclass={"build_ext": BuildWithCMake})
