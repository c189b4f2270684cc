"""Lets CMake build what of the package is C++; all else is in pyproject.toml.

GLOCAL_BUILD names a build folder in which that is done already, such as build/release.
"""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).parent.resolve()


def run(*words):
    subprocess.run([str(word) for word in words], check=True)


class BuildWithCMake(build_ext):
    """Installs the package's component of the build into what becomes the wheel."""

    def run(self):
        build = os.environ.get("GLOCAL_BUILD")
        if not build:
            build = ROOT / "build" / "python"
            options = {
                "CMAKE_BUILD_TYPE": "Release",
                "CMAKE_UNITY_BUILD": "ON",
                "GLOCAL_BUILD_TESTS": "OFF",
                "GLOCAL_BUILD_BENCHMARKS": "OFF",
                "GLOCAL_PYTHON": "ON",
                "Python_EXECUTABLE": sys.executable,
            }
            run("cmake", "-S", ROOT, "-B", build, "-G", "Ninja", *(f"-D{name}={value}" for name, value in options.items()))
            run("cmake", "--build", build, "--target", "python_package")
        target = pathlib.Path(self.build_lib).resolve()
        run("cmake", "--install", build, "--component", "python", "--prefix", target)
        # A wheel has no links: each library under the name by which it is looked for.
        for link in (target / "glocal").glob("*.so.*"):
            if link.is_symlink():
                link.resolve().rename(link)


def version():
    return re.search(r"project\(glocal VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


setup(
    version=version(),
    # Named so that the wheel is one of this machine and this Python; CMake knows the sources.
    ext_modules=[Extension("glocal._core", [])],
    cmdclass={"build_ext": BuildWithCMake},
)
