"""The program with strategies in Python: --plugin FILE.py."""
import os
import pathlib
import shutil
import sys

import glocal
from test_experiments import assert_equal_results

CELLS = pathlib.Path(__file__).parent / "cells.py"


def test_the_program_knows_them_as_its_own(program, room):
    assert "cells " in program("list", "clusterer", "--plugin", CELLS).stdout
    described = program("describe", "cells", "--plugin", CELLS).stdout
    assert described.startswith("cells (clusterer, from cells.py, experimental)\nJoins hypotheses whose")
    assert "side: number (> 0 m), default 0.5" in described
    wrong = program("check", room, "--plugin", CELLS, "--set", "localizer.clusterer.cells.side=-1", "--set",
                    "localizer.clusterer.cells.angle_dge=5")
    assert wrong.returncode == 2
    assert "side: -1 is out of range" in wrong.stderr and "did you mean 'angle_deg'" in wrong.stderr


def test_a_run_is_that_of_python(program, room, tmp_path):
    words = ["--plugin", CELLS, "--set", "localizer.clusterer.cells.side=0.4", "--quiet"]
    assert program("run", room, "--out", tmp_path / "program", "--jobs", 2, *words).returncode == 0
    glocal.load_plugin(CELLS)
    experiment = glocal.Experiment.load(room).with_(**{"localizer.clusterer.cells.side": 0.4})
    assert_equal_results(tmp_path / "program", experiment.run(tmp_path / "python").folder)


def test_shards_run_them(program, room, tmp_path):
    words = ["--plugin", CELLS, "--set", "localizer.clusterer=cells"]
    assert program("run", room, "--out", tmp_path / "whole", "--quiet", *words).returncode == 0
    for k in (1, 2):
        ended = program("run", room, "--out", tmp_path / "shared", "--shard", f"{k}/2", "--quiet", *words)
        assert ended.returncode == 0, ended.stderr
    merged = program("merge", tmp_path / "shared", "--out", tmp_path / "merged")
    assert merged.returncode == 0, merged.stderr
    table = glocal.load_results(tmp_path / "merged").trial_table
    assert table["outcome"].tolist() == glocal.load_results(tmp_path / "whole").trial_table["outcome"].tolist()


def test_an_exception_fails_its_trial(program, room, tmp_path):
    (tmp_path / "failing.py").write_text(CELLS.read_text().replace("return np.unique", "raise OSError('no') or np.unique"))
    ended = program("run", room, "--out", tmp_path / "out", "--plugin", tmp_path / "failing.py", "--set",
                    "localizer.clusterer=cells")
    assert ended.returncode == 1
    assert "OSError: no" in ended.stderr and "in cluster" in ended.stderr
    assert glocal.load_results(tmp_path / "out").summary()["trials"]["failed"] > 0


def test_two_plugins_of_one_name_are_refused(program, tmp_path):
    shutil.copy(CELLS, tmp_path / "other.py")
    ended = program("list", "--plugin", CELLS, "--plugin", tmp_path / "other.py")
    assert ended.returncode == 2
    assert "'cells' of other.py is already registered by cells.py" in ended.stderr


def test_a_file_that_is_missing_or_broken_is_an_error(program, tmp_path):
    assert "there is no such file" in program("list", "--plugin", tmp_path / "none.py").stderr
    (tmp_path / "broken.py").write_text("import glocal\n\n1 / 0\n")
    ended = program("list", "--plugin", tmp_path / "broken.py")
    assert ended.returncode == 2
    assert "broken.py: error: cannot be loaded: ZeroDivisionError" in ended.stderr
    assert 'broken.py", line 3' in ended.stderr


def test_a_python_without_the_package_is_told(program, tmp_path):
    fake = tmp_path / "python"
    fake.write_text("#!/bin/sh\necho 'ModuleNotFoundError: no glocal' >&2\nexit 1\n")
    fake.chmod(0o755)
    ended = program("list", "--plugin", CELLS, env={**os.environ, "GLOCAL_PYTHON": str(fake)})
    assert ended.returncode == 2
    assert "no glocal" in ended.stderr and "docs/python.md" in ended.stderr
    named = program("list", "clusterer", "--plugin", CELLS, env={**os.environ, "GLOCAL_PYTHON": sys.executable})
    assert named.returncode == 0, named.stderr
