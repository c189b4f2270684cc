"""glocal new-plugin --python: what it writes keeps its contract, passes its own test, and runs in the program."""
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import glocal
from glocal import strategies

KINDS = sorted(
    kind.kind
    for kind in vars(strategies).values()
    if isinstance(kind, type) and kind.__module__ == "glocal.strategies" and hasattr(kind, "kind")
)


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_plugin_works(program, tmp_path, kind):
    folder = tmp_path / "new"
    made = program("new-plugin", kind, f"my_{kind}", "--python", "-o", folder)
    assert made.returncode == 0, made.stderr
    environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(glocal.__file__).parents[1])}
    words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--basetemp", tmp_path / "own", folder]
    own = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert own.returncode == 0, own.stdout + own.stderr
    assert "2 passed" in own.stdout
    ran = program("run", folder / "experiment.yaml", "--quiet", "--out", tmp_path / "results")
    assert ran.returncode == 0, ran.stderr
    assert f"my_{kind}.py" in (tmp_path / "results/provenance.json").read_text()


def test_what_is_broken_is_said(program, tmp_path):
    before = dict(strategies._registered)

    @glocal.register("moody")
    class Moody(glocal.Clusterer):
        """Joins others each time."""

        calls = 0

        def cluster(self, hypotheses, rng):
            Moody.calls += 1
            return np.arange(len(hypotheses)) % Moody.calls

    try:
        broken = glocal.broken_promises("clusterer", "moody")
    finally:
        strategies._registered.clear()
        strategies._registered.update(before)
        strategies._version = next(strategies._versions)
    assert [sentence.split(":")[0] for sentence in broken] == ["the same again"]
    with pytest.raises(ValueError, match="there is no clusterer 'nobody'"):
        glocal.broken_promises("clusterer", "nobody")
    with pytest.raises(ValueError, match="unknown kind 'clusterers'"):
        glocal.broken_promises("clusterers", "dbscan")


def test_parameters_that_must_be_given_are_given_to_the_contract(room):
    with pytest.raises(glocal.ConfigError, match="missing key 'world'"):
        glocal.broken_promises("map_source", "simulation")
    assert glocal.broken_promises("map_source", "simulation", {"world": room.parent / "world.yaml"}) == []
