"""glocal.Experiment: reads, changes and runs experiments as the program does."""
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import glocal
from conftest import ROOT

TIMES = {"stage_ms", "stage_cpu_ms", "step_ms", "answer_ms", "peak_rss_mb", "others_load"}
TIMES_OF_THE_MAP = {"build_ms", "index_ms"}


def test_an_experiment_has_a_name_and_values(room):
    experiment = glocal.Experiment.load(room)
    assert experiment.name == "room"
    assert experiment.variants == []
    assert "iterations: 20000" in experiment.effective_yaml()


def test_values_are_changed_by_their_paths(room):
    before = glocal.Experiment.load(room)
    after = before.with_(**{"localizer.matcher.ransam.iterations": 777, "localizer.verdict_rule": "staged_margin"})
    assert "iterations: 777" in after.effective_yaml()
    assert "staged_margin:" in after.effective_yaml()
    assert "iterations: 20000" in before.effective_yaml()
    assert after.with_(seed=np.int64(5)).changes["localizer.matcher.ransam.iterations"] == 777
    assert "seed: 5" in after.with_(seed=np.int64(5)).effective_yaml()


def test_lists_and_dicts_are_values_too(room):
    changed = glocal.Experiment.load(room).with_(
        **{"localizer.clusterer": {"dbscan": {"radius": 0.75}}, "output.steps": False}
    )
    assert "dbscan:\n      radius: 0.75" in changed.effective_yaml()
    assert "steps: false" in changed.effective_yaml()


def test_values_within_values_are_taken_as_they_are_alone(room):
    changed = glocal.Experiment.load(room).with_(
        **{
            "map": {"simulation": {"world": room.parent / "world.yaml"}},
            "trials": {"every_scan": np.int64(7)},
            "localizer.clusterer": {"dbscan": {"radius": np.float32(0.75)}},
            "output.steps": np.False_,
        }
    )
    for text in ["world.yaml", "every_scan: 7", "radius: 0.75", "steps: false"]:
        assert text in changed.effective_yaml()
    for wrong in (object(), [object()]):
        with pytest.raises(TypeError, match="is no value of an experiment"):
            changed.with_(seed=wrong)


def test_paths_may_have_any_characters(room, tmp_path):
    world = tmp_path / "w\u00f6rld \U0001f916.yaml"
    world.write_bytes((tmp_path / "world.yaml").read_bytes())
    changed = glocal.Experiment.load(room).with_(map={"simulation": {"world": world}})
    assert world.name in changed.effective_yaml()


def test_what_is_changed_last_holds(room):
    iterations = "localizer.matcher.ransam.iterations"
    first = glocal.Experiment.load(room).with_(**{iterations: 1000})
    second = first.with_(**{"localizer.matcher": {"ransam": {"iterations": 2000}}})
    assert "iterations: 2000" in second.effective_yaml()
    assert "iterations: 3000" in second.with_(**{iterations: 3000}).effective_yaml()


def test_an_experiment_is_the_file_that_was_read(room, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    experiment = glocal.Experiment.load("room.yaml")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "room.yaml").write_text("not an experiment")
    monkeypatch.chdir(elsewhere)
    results = experiment.with_(seed=3).run(tmp_path / "out")
    assert str(room) in json.loads((results.folder / "provenance.json").read_text())["inputs_sha256"]
    later = experiment.run("results_here")
    monkeypatch.chdir(tmp_path)
    assert len(later.trial_table["trial"]) > 0
    read = hashlib.sha256(room.read_bytes()).hexdigest()
    room.write_text(room.read_text().replace("20000", "500"))
    again = experiment.run(tmp_path / "again")
    assert json.loads((again.folder / "provenance.json").read_text())["inputs_sha256"][str(room)] == read
    with pytest.raises(glocal.ConfigError, match="room.yaml: has changed since it was read"):
        experiment.with_(seed=4)


def test_all_faults_come_at_once_with_their_places(room):
    text = room.read_text().replace("iterations: 20000", "iterations: many").replace("step_length", "step_lenght")
    room.write_text(text)
    with pytest.raises(glocal.ConfigError) as caught:
        glocal.Experiment.load(room)
    faults = caught.value.faults
    assert [fault.file for fault in faults] == [str(room)] * 2
    lines = text.splitlines()
    for fault, written in zip(faults, ["step_lenght", "many"]):
        assert lines[fault.line - 1][fault.column - 1 :].startswith(written)
    assert "did you mean 'step_length'" in faults[0].message
    assert str(caught.value) == "\n".join(map(str, faults))
    assert isinstance(caught.value, ValueError)


def test_faults_of_changes_name_them(room):
    with pytest.raises(glocal.ConfigError, match="localizer.matcher.ransam.iterations=-1.*out of range"):
        glocal.Experiment.load(room).with_(**{"localizer.matcher.ransam.iterations": -1})


def test_a_missing_file_is_an_error(tmp_path):
    with pytest.raises(glocal.ConfigError, match="none.yaml"):
        glocal.Experiment.load(tmp_path / "none.yaml")


# Runs.


def without_times(file):
    """Lines of JSON without what differs between two runs."""
    lines = []
    for text in pathlib.Path(file).read_text().splitlines() if file.suffix == ".jsonl" else [file.read_text()]:
        line = json.loads(text)
        if file.name == "summary.json":
            line["map"] = {key: value for key, value in line["map"].items() if key not in TIMES_OF_THE_MAP}
            line["map"].get("index", {}).pop("build_ms", None)
        lines.append({key: value for key, value in line.items() if key not in TIMES})
    return lines


def assert_equal_results(a, b):
    """The same files, with the same bytes but for times."""
    names = sorted(str(file.relative_to(a)) for file in a.rglob("*") if file.is_file())
    assert names == sorted(str(file.relative_to(b)) for file in b.rglob("*") if file.is_file())
    for name in names:
        if name.endswith("provenance.json"):
            continue  # tells when, and how many trials ran at once
        if name.endswith("summary.json") or name.endswith(".jsonl"):
            assert without_times(a / name) == without_times(b / name), name
        else:
            assert (a / name).read_bytes() == (b / name).read_bytes(), name


def test_a_run_leaves_the_bytes_that_the_program_leaves(program, tmp_path):
    file = ROOT / "configs/experiments/paper_simulation.yaml"
    assert program("run", file, "--out", tmp_path / "program", "--quiet").returncode == 0
    results = glocal.Experiment.load(file).run(tmp_path / "python")
    assert_equal_results(tmp_path / "program", results.folder)
    assert results.summary()["trials"] == {"count": 1, "right": 1, "wrong": 0, "undecided": 0}


def test_overrides_and_jobs_leave_the_bytes_that_the_program_leaves(program, two_variants, tmp_path):
    words = ["--set", "localizer.clusterer=dbscan", "--seed", "3", "--out", tmp_path / "program", "--quiet"]
    assert program("run", two_variants, *words).returncode == 0
    experiment = glocal.Experiment.load(two_variants).with_(**{"localizer.clusterer": "dbscan", "seed": 3})
    assert experiment.variants == ["many", "few"]
    results = experiment.run(tmp_path / "python", jobs=2)
    assert_equal_results(tmp_path / "program", results.folder)


def test_results_go_where_the_program_puts_them(room, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert glocal.Experiment.load(room).run().folder == pathlib.Path("results/room")
    with pytest.raises(glocal.ConfigError, match="results/room"):
        glocal.Experiment.load(room).run()
    assert glocal.Experiment.load(room).run(force=True).trials is not None


def test_a_run_tells_how_far_it_is(two_variants, tmp_path):
    heard = []
    glocal.Experiment.load(two_variants).run(tmp_path / "out", only=["few"], progress=heard.append)
    assert [now.finished for now in heard] == list(range(1, heard[-1].trials + 1))
    assert {now.variant for now in heard} == {"few"}
    assert {now.outcome for now in heard} <= {"right", "wrong", "undecided"}
    assert not (tmp_path / "out" / "many").exists()


def test_what_progress_raises_ends_the_run(room, tmp_path):
    def tell(now):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        glocal.Experiment.load(room).run(tmp_path / "out", progress=tell)


def test_other_threads_go_on_while_the_core_works(tmp_path):
    """The lock of the interpreter is free: a thread counts while trials run."""
    count, done = 0, threading.Event()

    def counting():
        nonlocal count
        while not done.is_set():
            count += 1
            time.sleep(0.001)

    thread = threading.Thread(target=counting)
    experiment = glocal.Experiment.load(ROOT / "configs/experiments/paper_simulation.yaml")
    start = time.perf_counter()
    thread.start()
    try:
        experiment.run(tmp_path / "out")
    finally:
        done.set()
        thread.join()
    assert count > 20 * (time.perf_counter() - start)


INTERRUPTED = """
import glocal, sys
try:
    glocal.Experiment.load(sys.argv[1]).run(sys.argv[2], progress=lambda now: print("trial", flush=True))
except glocal.Interrupted as why:
    print("interrupted", why.results.trial_table.rows, why.results.summary()["complete"], flush=True)
    sys.exit(3)
"""


def test_ctrl_c_ends_a_run_in_good_order_and_the_next_one_goes_on(room, tmp_path):
    room.write_text(room.read_text().replace("iterations: 20000", "iterations: 400000").replace("every_scan: 10", "every_scan: 3"))
    words = [sys.executable, "-c", INTERRUPTED, str(room), str(tmp_path / "out")]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "trial\n"
    process.send_signal(signal.SIGINT)
    out = process.communicate(timeout=120)[0]
    assert process.returncode == 3
    word, rows, complete = out.splitlines()[-1].split()
    assert (word, complete) == ("interrupted", "False")
    whole = glocal.Experiment.load(room).run(tmp_path / "out")
    assert whole.summary()["complete"]
    assert 1 <= int(rows) < whole.trial_table.rows
    assert_equal_results(glocal.Experiment.load(room).run(tmp_path / "other").folder, whole.folder)


def test_ctrl_c_that_comes_too_late_for_a_run_is_not_lost(room, tmp_path):
    def tell(now):
        if now.finished == now.trials:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt) as caught:
        glocal.Experiment.load(room).run(tmp_path / "out", progress=tell)
    assert not isinstance(caught.value, glocal.Interrupted)
    assert glocal.load_results(tmp_path / "out").summary()["complete"]


def test_ctrl_c_is_pythons_again_after_a_run(room, tmp_path):
    glocal.Experiment.load(room).run(tmp_path / "out")
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(1)


def test_ctrl_c_is_pythons_again_after_runs_that_overlap(room, tmp_path):
    second_began, first_ended = threading.Event(), threading.Event()

    def tell_second(_):
        second_began.set()
        assert first_ended.wait(60)

    second = threading.Thread(target=lambda: glocal.Experiment.load(room).run(tmp_path / "second", progress=tell_second))

    def begin_second(_):
        if not second.ident:
            second.start()
        assert second_began.wait(60)

    glocal.Experiment.load(room).run(tmp_path / "first", progress=begin_second)
    first_ended.set()
    second.join()
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(1)


def test_no_map_is_an_error(room):
    for wrong in (lambda: glocal.Localizer(None), lambda: glocal.contact_index(None, 0.1), lambda: glocal.Localizer(None, glocal.Experiment.load(room))):
        with pytest.raises(TypeError):
            wrong()


# Step by step.


def test_the_localizer_of_an_experiment_steps_as_its_run_does(room, tmp_path):
    experiment = glocal.Experiment.load(room).with_(**{"trials.every_scan": 1000})
    results = experiment.run(tmp_path / "out")
    localizer = experiment.localizer()
    samples = experiment.load_samples()
    steps = results.step_table
    for i in range(steps.rows):
        step = localizer.step(samples[i].observation)
        assert step.step == i
        assert step.verdict.kind == steps["verdict"][i]
        assert (step.omega_best, step.proposals, len(step.clusters)) == (
            steps["omega_best"][i], steps["proposals"][i], steps["clusters"][i])
        assert len(step.hypotheses) == steps["hypotheses"][i]
        assert (step.estimate.x, step.estimate.heading) == (steps["estimate.x"][i], steps["estimate.theta"][i])
        assert samples[i].map_from_robot.x == steps["reference.x"][i]
    localizer.reset()
    assert localizer.step(samples[0].observation).omega_best == steps["omega_best"][0]


def test_a_verification_in_pieces_goes_on_without_a_step(room):
    experiment = glocal.Experiment.load(room).with_(**{"localizer.verifier": "whole_map"})
    whole = experiment.localizer()
    pieces = experiment.with_(**{"localizer.looks_per_step": 100}).localizer()
    waits = 0
    for sample in experiment.load_samples():
        wanted, found = whole.step(sample.observation), pieces.step(sample.observation)
        while found.goes_on:
            waits += 1
            found = pieces.go_on(looks=100)
        assert (found.step, found.verdict.kind, found.verdict.why) == (wanted.step, wanted.verdict.kind, wanted.verdict.why)
    assert waits > 1
    with pytest.raises(RuntimeError, match="no search is open"):
        pieces.go_on()


def test_of_several_maps_the_map_says_which_one_a_pose_is_on(room):
    world = "source: {simulation: {world: world.yaml}}"
    room.write_text(f"""\
schema: 1
name: floors
map: {{several: {{maps: [{{name: ground, {world}}}, {{name: first, {world}}}]}}}}
observations: {{several: {{drives: [{{map: ground, {world}}}, {{map: first, {world}}}]}}}}
trials: {{every_scan: 1000, max_steps: 1}}
""")
    experiment = glocal.Experiment.load(room)
    known, samples = experiment.load_map(), experiment.load_samples()
    assert (samples[0].map, samples[len(samples) // 2].map) == ("ground", "first")
    # The same walls twice, side by side.
    x = known.points.x
    shift = float(x[len(x) // 2] - x[0])
    assert shift > 40
    below, above = known.place_of((1, 3, 0.5)), known.place_of((1 + shift, 3, 0.5))
    assert (below[0], above[0]) == ("ground", "first")
    assert (above[1].x, above[1].y, above[1].heading) == pytest.approx((below[1].x, below[1].y, 0.5), abs=1e-4)
    alone = glocal.GlobalMap([[1, 2]], resolution=0.1).place_of((1, 2, 0))
    assert (alone[0], alone[1].x, alone[1].y) == ("", 1, 2)


def test_a_localizer_takes_values_by_path_and_observations_of_numpy(room):
    experiment = glocal.Experiment.load(room)
    known = experiment.load_map()
    changes = {"matcher.ransam.iterations": 20000, "verdict_rule": "staged_margin"}
    localizer = glocal.Localizer(known, changes, seed=4, threads=2)
    same = glocal.Localizer(known, changes, seed=4, threads=1)
    for sample in experiment.load_samples()[:5]:
        given = sample.observation
        made = glocal.Observation(np.asarray(given.hits), given.odom_from_robot, given.stamp, np.asarray(given.free_ends), given.origin)
        step, other = localizer.step(made), same.step(given)
        assert np.array_equal(step.hypotheses.map_from_local, other.hypotheses.map_from_local)
        assert step.verdict.why == other.verdict.why
    assert len(localizer.local_map.points) == step.local_map_points
    with pytest.raises(glocal.ConfigError, match="matcher.ransam.iteration"):
        glocal.Localizer(known, {"matcher.ransam.iteration": 1})


def test_another_thread_gets_whole_local_maps(room):
    """Those of some step, not what a step is just making of one."""
    experiment = glocal.Experiment.load(room)
    localizer = experiment.localizer()
    seen, made = set(), {len(localizer.local_map.points)}
    is_over = threading.Event()

    def look():
        while not is_over.is_set():
            points = np.asarray(localizer.local_map.points)
            assert np.isfinite(points).all()
            seen.add(len(points))

    thread = threading.Thread(target=look)
    thread.start()
    for sample in experiment.load_samples()[:40]:
        made.add(localizer.step(sample.observation).local_map_points)
    is_over.set()
    thread.join()
    assert seen and seen <= made


def test_what_a_step_holds_outlives_the_localizer(room):
    experiment = glocal.Experiment.load(room)
    localizer = experiment.localizer()
    first = localizer.step(experiment.load_samples()[0].observation)
    quality = first.hypotheses.quality
    kept = quality.copy()
    for sample in experiment.load_samples()[1:6]:
        localizer.step(sample.observation)
    del localizer, first
    assert np.array_equal(quality, kept)
    assert not quality.flags.owndata


def test_variants_have_no_single_localizer(two_variants):
    with pytest.raises(glocal.ConfigError, match="variants"):
        glocal.Experiment.load(two_variants).localizer()


def test_a_bad_observation_is_an_error_and_reset_mends_it(room):
    localizer = glocal.Experiment.load(room).localizer()
    with pytest.raises(glocal.StrategyError, match="observation"):
        localizer.step(glocal.Observation([[np.nan, 0]], (0, 0, 0)))
    localizer.reset()
    localizer.step(glocal.Observation([[1.0, 0]], (0, 0, 0)))
