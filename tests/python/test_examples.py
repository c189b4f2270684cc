"""examples/python: each runs as a script, from any folder, and comes to the result that it is there to show."""
import ast
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import glocal
from conftest import ROOT

EXAMPLES = ROOT / "examples/python"


def environment(**more):
    """Simulated experiments only, unless more is given; the package that these tests import."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("GLOCAL_")}
    return {**kept, "PYTHONPATH": str(pathlib.Path(glocal.__file__).parents[1]), **more}


def run(name, folder, **more):
    """What a script prints that is started in a folder, with more in its environment."""
    done = subprocess.run(
        [sys.executable, EXAMPLES / name], cwd=folder, env=environment(**more), capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def trials_in(folder):
    return json.loads((folder / "summary.json").read_text())["trials"]


def is_picture(file):
    return file.read_bytes().startswith(b"\x89PNG") and file.stat().st_size > 10_000


# first_localization


def test_first_localization_declares_right_poses(tmp_path):
    pytest.importorskip("matplotlib")
    said = run("first_localization.py", tmp_path)
    assert len(re.findall(r"^step \d+: localized: ", said, re.MULTILINE)) == 2  # of the drive, and its own
    apart = float(re.search(r"([\d.]+) cm and [\d.]+ degrees apart", said)[1])
    assert apart < 10.0
    # Its own observations have the map's cells of 3 cm as walls.
    own = float(re.search(r"own observations: .*, ([\d.]+) cm from the truth", said)[1])
    assert own < 10.0
    out = tmp_path / "results/python/first_localization"
    assert trials_in(out / "run")["right"] == 1
    assert is_picture(out / "map.png") and is_picture(out / "curves.png")
    # Nothing is left anywhere else.
    assert [file.name for file in tmp_path.iterdir()] == ["results"]
    assert [file.name for file in (tmp_path / "results").iterdir()] == ["python"]


# clusterer


def table_of(said):
    """Numbers of each clusterer in the printed table: right, wrong, undecided, steps, cluster ms, its 95 %, step ms."""
    rows = re.findall(r"^([a-z_]+)((?: +[\d.]+,?){7})$", said, re.MULTILINE)
    return {name: [float(number.rstrip(",")) for number in numbers.split()] for name, numbers in rows}


def check_clusterer(said, out):
    table = table_of(said)
    assert set(table) == {"hierarchical_kmeans", "mean_shift", "dbscan", "pose_grid", "leaders"}
    for name, (right, wrong, undecided, *_) in table.items():
        trials = trials_in(out / name)
        assert (right, wrong, undecided) == (trials["right"], trials["wrong"], trials["undecided"])
    ours, paper = table["leaders"], table["hierarchical_kmeans"]
    assert ours[0] >= paper[0] and ours[1] <= paper[1]
    # It is the class of the notebook that was run, by its price.
    assert ours[4] > paper[4] > 0.0
    assert "leaders against hierarchical_kmeans" in said
    return table


def test_clusterer_is_as_good_as_the_built_in_one(tmp_path):
    said = run("clusterer.py", tmp_path, GLOCAL_EXAMPLES_OUT=str(tmp_path / "out"))
    table = check_clusterer(said, tmp_path / "out/clusterer")
    assert table["leaders"][0] >= 10


def test_clusterer_on_a_log(tmp_path, datasets):
    said = run("clusterer.py", tmp_path, GLOCAL_DATASETS=str(datasets), GLOCAL_EXAMPLES_EVERY_M="30")
    table = check_clusterer(said, tmp_path / "results/python/clusterer")
    assert sum(table["leaders"][:3]) >= 8
    assert table["leaders"][1] == 0


def test_clusterer_is_short():
    text = (EXAMPLES / "clusterer.py").read_text()
    strategies = [node for node in ast.parse(text).body if isinstance(node, ast.ClassDef)]
    assert len(strategies) == 1
    first = strategies[0].decorator_list[0].lineno
    assert strategies[0].end_lineno - first + 1 <= 20


def test_clusterer_groups_as_its_docstring_says():
    """Against a slow and obvious way to the same groups."""
    text = (EXAMPLES / "clusterer.py").read_text()
    module = ast.parse(text)
    head = [node for node in module.body if isinstance(node, (ast.Import, ast.ImportFrom, ast.ClassDef))]
    namespace = {"__name__": __name__}
    exec(compile(ast.Module(head, []), "clusterer.py", "exec"), namespace)
    random = np.random.default_rng(5)
    poses = np.column_stack([random.uniform(0, 2, (300, 2)), random.uniform(-np.pi, np.pi, 300)])
    score = np.sort(random.uniform(0.1, 1.0, 300))[::-1]

    class Seen:  # as the core hands them over
        map_from_robot = np.column_stack([poses[:, :2], np.zeros((300, 5))])
        heading = poses[:, 2]

        def __len__(self):
            return len(score)

    strategy = namespace["Leaders"](namespace["Leaders"].Params(radius=0.4, angle_deg=40.0), None)
    labels = strategy.cluster(Seen(), glocal.Rng(1))
    expected = {}
    for i, (x, y, heading) in enumerate(poses):
        for leader in sorted(set(expected.values())):
            turned = abs((heading - poses[leader][2] + np.pi) % (2 * np.pi) - np.pi)
            if np.hypot(x - poses[leader][0], y - poses[leader][1]) <= 0.4 and np.degrees(turned) <= 40.0:
                expected[i] = leader
                break
        else:
            expected[i] = i
    assert labels.tolist() == [expected[i] for i in range(300)]
    assert 5 < len(set(expected.values())) < 300


# tuning


def study_of(folder):
    optuna = pytest.importorskip("optuna")
    study = optuna.load_study(study_name="glocal", storage=f"sqlite:///{folder}/tuning/worlds/study.db")
    return [(trial.state.name, trial.params, trial.value) for trial in study.trials]


def numbers_in(said):
    return [int(number) for number in re.findall(r"^trial (\d+): ", said, re.MULTILINE)]


def judgement_in(said):
    return said[said.index("best of ") :]


def kill_in_third_trial(folder, settings):
    """Starts the script, and kills it while it runs its third trial."""
    with subprocess.Popen(
        [sys.executable, EXAMPLES / "tuning.py"],
        cwd=folder,
        env=environment(**settings),
        stdout=subprocess.PIPE,
        text=True,
    ) as script:
        for line in script.stdout:
            if line.startswith("trial 1:"):
                break
        begun = pathlib.Path(settings["GLOCAL_EXAMPLES_OUT"]) / "tuning/worlds/trial_0002"
        deadline = time.monotonic() + 60.0
        while not begun.exists() and time.monotonic() < deadline:
            time.sleep(0.001)
        script.send_signal(signal.SIGKILL)
        assert script.wait() == -signal.SIGKILL


def when_written(folder):
    return {file: file.stat().st_mtime_ns for file in folder.rglob("*") if file.is_file()}


def test_tuning_goes_on_after_a_kill(tmp_path):
    pytest.importorskip("optuna")
    killed, whole = tmp_path / "killed", tmp_path / "whole"
    settings = {"GLOCAL_EXAMPLES_OUT": str(killed), "GLOCAL_EXAMPLES_TRIALS": "4"}
    kill_in_third_trial(tmp_path, settings)
    assert [state for state, _, _ in study_of(killed)] == ["COMPLETE", "COMPLETE", "RUNNING"]
    finished = [killed / "tuning/worlds/trial_0000", killed / "tuning/worlds/trial_0001"]
    before = [when_written(folder) for folder in finished]
    assert all(before)

    said = run("tuning.py", tmp_path, **settings)
    # The rest, and nothing else; what was finished is untouched, but that the best one has been judged since.
    assert numbers_in(said) == [2, 3]
    for folder, files in zip(finished, before):
        assert files.items() <= when_written(folder).items()

    # The end is that of a study which was never killed.
    uninterrupted = run("tuning.py", tmp_path, **{**settings, "GLOCAL_EXAMPLES_OUT": str(whole)})
    assert numbers_in(uninterrupted) == [0, 1, 2, 3]
    assert study_of(killed) == study_of(whole)
    assert [state for state, _, _ in study_of(killed)] == ["COMPLETE"] * 4
    assert len({tuple(sorted(params.items())) for _, params, _ in study_of(killed)}) == 4
    assert judgement_in(said) == judgement_in(uninterrupted)

    # Started again with nothing left to do, it says the same.
    again = run("tuning.py", tmp_path, **settings)
    assert numbers_in(again) == [] and judgement_in(again) == judgement_in(said)

    check_judgement(said, killed)


def check_judgement(said, folder):
    """Scores are those of the trials on disk: the rate of right ones less that of wrong ones, of each group of worlds."""
    out = folder / "tuning/worlds"
    values = [value for _, _, value in study_of(folder)]
    best = max(range(len(values)), key=lambda number: values[number])
    assert f"trial {best} " in said.splitlines()[-4] and "warning: " in said
    for kind, worlds, shown, by_hand in re.findall(
        r"^(chosen|judged) on (.*): (-?[\d.]+); set by hand (-?[\d.]+)$", said, re.MULTILINE
    ):
        for folder, score in ((out / f"trial_{best:04}", shown), (out / "by_hand", by_hand)):
            counts = [trials_in(folder / world) for world in worlds.split(", ")]
            total = sum(count["right"] - count["wrong"] for count in counts) / sum(count["count"] for count in counts)
            assert f"{total:.3f}" == score, kind
        assert len(counts) == {"chosen": 3, "judged": 2}[kind]
