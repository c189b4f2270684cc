"""The wheel: what is in it, and that it works where the build folder is not at hand."""
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import venv
import zipfile

import pytest

from conftest import ROOT

pytest.importorskip("build")


def tracked():
    """The project's files."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [name for name in listed.split("\0") if (ROOT / name).is_file()]


def without_glocal():
    """The environment without what leads to the build folder."""
    return {name: value for name, value in os.environ.items() if not name.startswith(("PYTHONPATH", "GLOCAL"))}


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """An archive of sources and the wheel that is made of it; what is compiled is taken from the build folder."""
    if "GLOCAL_BUILD" not in os.environ:
        pytest.skip("GLOCAL_BUILD names no build folder")
    # In a copy, for setuptools writes beside its sources.
    source = tmp_path_factory.mktemp("source") / "glocal"
    for name in tracked():
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, source / name)
    environment = {**without_glocal(), "GLOCAL_BUILD": os.environ["GLOCAL_BUILD"]}
    words = [sys.executable, "-m", "build", "--no-isolation", str(source)]
    done = subprocess.run(words, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    return source / "dist"


@pytest.fixture(scope="module")
def wheel(built):
    (made,) = built.glob("*.whl")
    return made


def test_an_archive_of_sources_has_all_that_a_wheel_is_built_from(built, tmp_path):
    (archive,) = built.glob("*.tar.gz")
    with tarfile.open(archive) as files:
        files.extractall(tmp_path)
    (source,) = tmp_path.glob("glocal-*")
    # CMake tells of sources that are missing; headers are in the same folders.
    options = ["-DGLOCAL_BUILD_TESTS=OFF", "-DGLOCAL_BUILD_BENCHMARKS=OFF", f"-DPython_EXECUTABLE={sys.executable}"]
    words = ["cmake", "-S", source, "-B", tmp_path / "build", "-G", "Ninja", *options]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    folders = {entry.name for entry in source.iterdir() if entry.is_dir() and (ROOT / entry.name).is_dir()}
    missing = [name for name in tracked() if name.split("/")[0] in folders and not (source / name).is_file()]
    assert missing == []
    assert {"framework", "report", "python"} <= folders


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
    environment = without_glocal()
    done = subprocess.run([home / "bin" / "python", "-c", code], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    first, *summary = done.stdout.splitlines()
    assert pathlib.Path(first).is_relative_to(home)
    assert summary[0] == "room, seed 1"
    # No library is taken from the build folder.
    linked = subprocess.run(["ldd", *site.glob("glocal/_core*.so")], capture_output=True, text=True, env=environment).stdout
    assert str(site / "glocal" / "libglocal.so") in linked
    assert os.environ["GLOCAL_BUILD"] + "/framework" not in linked
