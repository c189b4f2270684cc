"""docs/python.md: its blocks of Python and bash run as they stand, in their order."""
import json
import os
import pathlib
import re
import subprocess
import sys

import pytest

import glocal
from conftest import ROOT

PAGE = ROOT / "docs/python.md"

# Runs the page's blocks one after the other, all in one namespace: in Python, or in the shell.
DRIVER = """
import json, subprocess, sys
namespace = {"__name__": "__main__"}
for number, (language, text) in enumerate(json.load(sys.stdin)):
    if language == "bash":
        subprocess.run(["bash", "-e", "-c", text], check=True, stdin=subprocess.DEVNULL)
    else:
        exec(compile(text, f"block {number}", "exec"), namespace)
"""


def blocks():
    return re.findall(r"^```(python|bash)\n(.*?)^```$", PAGE.read_text(), re.MULTILINE | re.DOTALL)


def file_of(text):
    """A block that begins with a comment naming a file is that file."""
    name = re.match(r"# (\w+\.py)\n", text)
    return name and name[1]


def test_blocks_run(tmp_path):
    pytest.importorskip("matplotlib")
    if "GLOCAL_PROGRAM" not in os.environ:
        pytest.skip("GLOCAL_PROGRAM does not name the program")
    program = pathlib.Path(os.environ["GLOCAL_PROGRAM"])
    (tmp_path / "configs").symlink_to(ROOT / "configs")
    found = blocks()
    for _, text in found:
        if file_of(text):
            (tmp_path / file_of(text)).write_text(text)
    environment = {
        **os.environ,
        "PATH": f"{program.parent}:{os.environ['PATH']}",
        "PYTHONPATH": str(pathlib.Path(glocal.__file__).parents[1]),
        "GLOCAL_PYTHON": sys.executable,
    }
    environment.pop("GLOCAL_DATASETS", None)
    done = subprocess.run(
        [sys.executable, "-c", DRIVER],
        input=json.dumps([block for block in found if not file_of(block[1])]),
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    # What the page promises is there: runs of both, a figure, and the file's strategy in use.
    for folder in ["results/fewer", "results/all", "results/cells", "results/paper_lab"]:
        assert (tmp_path / folder / "summary.json").is_file(), folder
    assert (tmp_path / "outcomes.png").read_bytes().startswith(b"\x89PNG")
    for folder in ["results/cells", "results/paper_lab"]:
        assert "cells.py" in (tmp_path / folder / "provenance.json").read_text(), folder
        effective = (tmp_path / folder / "effective.yaml").read_text()
        assert re.search(r"clusterer:\n\s+cells:", effective), effective


def test_the_reference_is_that_of_the_package():
    """docs/python-reference.md is what scripts/python_reference writes."""
    environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(glocal.__file__).parents[1])}
    written = subprocess.run([sys.executable, ROOT / "scripts/python_reference"], env=environment, capture_output=True, text=True)
    assert written.returncode == 0, written.stderr
    assert (ROOT / "docs/python-reference.md").read_text() == written.stdout


def test_the_reference_has_each_method_once():
    for section in (ROOT / "docs/python-reference.md").read_text().split("\n### ")[1:]:
        methods = re.findall(r"^\| `(\w+\()", section, re.MULTILINE)
        assert len(set(methods)) == len(methods), section.splitlines()[0]


def test_kinds_are_those_of_the_package():
    """The table has all base classes, with the methods that a class must have."""
    rows = dict(re.findall(r"^\| (`[A-Z]\w+`(?:, `\w+`)*) \| (.*?) \|", PAGE.read_text(), re.MULTILINE))
    shown = {}
    for names, methods in rows.items():
        for name in re.findall(r"\w+", names):
            shown[name] = set(re.findall(r"`(\w+)\(", methods))
    kinds = {
        name: kind
        for name, kind in vars(glocal).items()
        if isinstance(kind, type) and getattr(kind, "kind", None) and kind.__module__ == "glocal.strategies"
    }
    errors = {"ConfigError", "StrategyError", "RunError", "Interrupted"}
    assert set(shown) - errors == set(kinds)
    for name, kind in kinds.items():
        assert set(kind.abstract) <= shown[name], name


def test_names_exist():
    """What is written as glocal.NAME is there."""
    names = set(re.findall(r"\bglocal\.([A-Za-z_]+)", PAGE.read_text()))
    assert names
    for name in names:
        assert hasattr(glocal, name), name
