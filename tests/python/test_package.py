"""The wheel: what is in it, and that it works where the build folder is not at hand."""
import os
import pathlib
import shutil
import subprocess
import sys
import venv
import zipfile

import pytest

from conftest import ROOT

pytest.importorskip("build")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Made of what is built, in a copy of what a wheel is made of: setuptools writes beside its sources."""
    if "GLOCAL_BUILD" not in os.environ:
        pytest.skip("GLOCAL_BUILD names no build folder")
    source = tmp_path_factory.mktemp("source")
    for name in ("pyproject.toml", "setup.py", "CMakeLists.txt", "LICENSE"):
        shutil.copy(ROOT / name, source)
    shutil.copytree(ROOT / "python" / "glocal", source / "python" / "glocal")
    words = [sys.executable, "-m", "build", "--no-isolation", "--wheel", "--outdir", str(source / "dist"), str(source)]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(words, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    (made,) = (source / "dist").glob("*.whl")
    return made


def test_a_wheel_has_the_module_its_libraries_and_its_types(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = [name for name in archive.namelist() if name.startswith("glocal/")]
    stems = {name.removeprefix("glocal/").split(".")[0] for name in names}
    assert stems >= {"__init__", "_core", "_figures", "_host", "libglocal", "libglocal_evaluation", "py", "plotting"}
    assert {"glocal/_core.pyi", "glocal/_figures.pyi", "glocal/py.typed"} <= set(names)
    assert len([name for name in names if "/libglocal." in name]) == 1


def test_a_wheel_works_by_itself(wheel, room, tmp_path):
    """In an environment of its own, in which only Debian's packages are found besides."""
    home = tmp_path / "venv"
    venv.create(home, system_site_packages=True, with_pip=False)
    site = next((home / "lib").glob("python3*")) / "site-packages"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    code = (
        "import glocal; print(glocal.__file__); "
        f"print(glocal.Experiment.load({str(room)!r}).run({str(tmp_path / 'out')!r}).summary())"
    )
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHONPATH", "GLOCAL"))}
    done = subprocess.run([home / "bin" / "python", "-c", code], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    first, *summary = done.stdout.splitlines()
    assert pathlib.Path(first).is_relative_to(home)
    assert summary[0] == "room, seed 1"
    # No library is taken from the build folder.
    linked = subprocess.run(["ldd", *site.glob("glocal/_core*.so")], capture_output=True, text=True, env=environment).stdout
    assert str(site / "glocal" / "libglocal.so") in linked
    assert os.environ["GLOCAL_BUILD"] + "/framework" not in linked
