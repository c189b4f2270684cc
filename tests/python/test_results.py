"""glocal.Results: tables, comparisons and sweeps, against the files and the program."""
import csv
import io
import json

import numpy as np
import pytest

import glocal


@pytest.fixture
def results(two_variants, tmp_path):
    return glocal.Experiment.load(two_variants).run(tmp_path / "out")


def lines(file):
    return [json.loads(line) for line in file.read_text().splitlines()]


def test_tables_have_what_the_files_have(results):
    run = results.variants["many"]
    table, written = run.trial_table, lines(run.folder / "trials.jsonl")
    assert table.rows == len(written)
    assert table["outcome"].tolist() == [line["outcome"] for line in written]
    assert table["start.reference.x"].tolist() == [line["start"]["reference"]["x"] for line in written]
    assert table["steps"].dtype == np.int64
    poses = [line.get("pose", {}).get("theta", np.nan) for line in written]
    assert np.array_equal(table["pose.theta"], poses, equal_nan=True)
    steps = lines(run.folder / "steps.jsonl")
    assert run.step_table["stage_ms.match"].tolist() == [line["stage_ms"]["match"] for line in steps]
    assert run.step_table["on_map"].dtype == bool
    with pytest.raises(KeyError, match="omega_best"):
        run.step_table["omega"]


def test_tables_cannot_be_written_to_by_accident(results):
    one = results.variants["many"]
    columns = [one.trial_table["distance_m"], one.trial_table["steps"], one.step_table["on_map"], one.trial_table["outcome"],
               results.trial_table["distance_m"], results.trial_table["steps"], results.trial_table["variant"]]
    for column in columns:
        with pytest.raises(ValueError, match="read-only"):
            column[0] = column[1]


def test_tables_of_variants_say_which_each_row_is_of(results):
    table = results.trial_table
    parts = [run.trial_table for run in results.variants.values()]
    assert table.rows == sum(part.rows for part in parts)
    assert table["variant"].tolist() == ["many"] * parts[0].rows + ["few"] * parts[1].rows  # as in the file
    assert table["distance_m"].tolist() == [*parts[0]["distance_m"], *parts[1]["distance_m"]]


def test_tables_are_data_frames_where_pandas_is_installed(results):
    pandas = pytest.importorskip("pandas")
    assert isinstance(results.trials, pandas.DataFrame)
    by_variant = results.trials.groupby("variant")["steps"].count()
    assert by_variant["many"] == results.variants["many"].trial_table.rows
    assert len(results.steps) == results.step_table.rows


def test_tables_are_arrays_without_pandas(results, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    assert isinstance(results.trials, glocal.Table)


def test_summaries_are_those_of_the_files(results):
    run = results.variants["many"]
    assert run.summary() == json.loads((run.folder / "summary.json").read_text())
    assert f"{run.summary()['trials']['right']} right" in str(run.summary())
    assert results.summary()["many"] == run.summary()
    assert str(results.summary()).splitlines()[1].startswith("many ")


def test_results_are_read_again(results):
    again = glocal.load_results(str(results.folder))
    assert again.trial_table["outcome"].tolist() == results.trial_table["outcome"].tolist()
    with pytest.raises(glocal.ConfigError):
        glocal.load_results(results.folder / "none")
    with pytest.raises(glocal.ConfigError, match="many, few"):
        results.plot_outcomes()


def test_damaged_results_are_an_error_with_their_place(results):
    file = results.folder / "many" / "trials.jsonl"
    file.write_text(file.read_text()[:-20])
    with pytest.raises(glocal.ConfigError) as caught:
        glocal.load_results(results.folder / "many").trial_table
    assert caught.value.faults[0].file == str(file)


def test_a_comparison_is_that_of_the_program(results, program, tmp_path):
    answer = program("compare", results.folder, "--baseline", "many", "--no-times", "-o", tmp_path / "c.json",
                     "-o", tmp_path / "c.csv", "-o", tmp_path / "c.md")
    assert answer.returncode == 0
    comparison = results.compare(baseline="many", times=False)
    assert comparison == json.loads((tmp_path / "c.json").read_text())
    assert comparison.csv == (tmp_path / "c.csv").read_text()
    assert comparison.markdown == (tmp_path / "c.md").read_text()
    assert answer.stdout.startswith(str(comparison))
    full = program("compare", results.folder, "--baseline", "many", "--no-times", "--full")
    assert comparison.full == full.stdout
    assert len(list(csv.reader(io.StringIO(comparison.csv)))) > 1
    parts = list(results.variants.values())
    assert glocal.compare(parts, baseline="many", times=False) == comparison


def test_a_comparison_finds_results_wherever_the_process_goes(two_variants, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    results = glocal.Experiment.load(two_variants).run("out")
    there = results.compare(times=False)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert results.compare(times=False) == there


def test_a_comparison_needs_two_runs_and_a_baseline_that_is_there(results):
    with pytest.raises(glocal.ConfigError, match="nothing to compare"):
        glocal.compare([results.variants["many"]])
    with pytest.raises(glocal.ConfigError, match="baseline none"):
        results.compare(baseline="none")


def test_a_sweep_is_that_of_the_program(room, program, tmp_path):
    room.write_text(room.read_text() + "variants:\n  grid:\n    localizer.matcher.ransam.iterations: [500, 5000]\n")
    swept = glocal.Experiment.load(room).run(tmp_path / "out", jobs=2)
    answer = program("sweep", tmp_path / "out", "--json")
    assert answer.returncode == 0
    assert swept.sweep() == json.loads(answer.stdout)
    assert str(swept.sweep()) == program("sweep", tmp_path / "out").stdout
