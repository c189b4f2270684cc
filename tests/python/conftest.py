"""What tests of the Python package share: a small world, and experiments in it."""
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).parents[2]

WORLD = """\
size: [12, 6]
walls:
  - {points: [[0, 0], [12, 0], [12, 4], [7, 6], [0, 6]], closed: true}
  - {points: [[5, 0], [5, 2.4]]}
free_from: [[1, 1]]
way_points: [[1, 3], [10, 3], [10, 1]]
"""

EXPERIMENT = """\
schema: 1
name: room
map:
  simulation: {world: world.yaml}
observations:
  simulation: {world: world.yaml, step_length: 0.3}
trials: {every_scan: 10, max_steps: 12}
localizer:
  matcher:
    ransam: {iterations: 20000}
"""


@pytest.fixture
def room(tmp_path):
    """An experiment file in a room; runs in a fraction of a second."""
    (tmp_path / "world.yaml").write_text(WORLD)
    file = tmp_path / "room.yaml"
    file.write_text(EXPERIMENT)
    return file


@pytest.fixture
def two_variants(room):
    """The same with two variants."""
    room.write_text(
        EXPERIMENT
        + "variants:\n  list:\n    many: {}\n    few: {localizer.matcher.ransam.iterations: 2000}\n"
    )
    return room


@pytest.fixture
def program():
    """Runs the program; its exit code, and what it printed."""
    path = os.environ.get("GLOCAL_PROGRAM")
    if not path:
        pytest.skip("GLOCAL_PROGRAM does not name the program")

    def run(*words, **options):
        return subprocess.run([path, *map(str, words)], capture_output=True, text=True, **options)

    return run


@pytest.fixture
def datasets():
    folder = os.environ.get("GLOCAL_DATASETS")
    if not folder or not pathlib.Path(folder).is_dir():
        pytest.skip("GLOCAL_DATASETS names no folder")
    return pathlib.Path(folder)
