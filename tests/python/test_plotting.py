"""glocal.plotting: what is drawn has the numbers of results that are written here by hand."""
import ast
import inspect
import itertools
import json
import math
import pathlib
import struct
import subprocess
import sys

import pytest

matplotlib = pytest.importorskip("matplotlib")

import matplotlib.colors
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from glocal import _figures, plotting

MAP = [(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 8.0, 1.0), (0.0, 8.0, 2.0)]
BLUE, GREEN, ORANGE, RED = "#0072b2", "#009e73", "#e69f00", "#d55e00"  # Okabe and Ito's


# Results, as docs/file-formats.md describes them.


def pose(x, y, theta=0.0):
    return {"x": x, "y": y, "theta": theta}


def cluster(r, place):
    return {"pose": place, "size": 3, "r": r, "r_normalised": 0.5}


def step(number, verdict="searching", trial=0, **more):
    return {
        "trial": trial,
        "step": number,
        "stage_ms": {"local_map": 1.0, "match": 10.0 + number, "cluster": 1.0, "rate": 1.0},
        "omega_best": 0.5 + 0.1 * number,
        "score_best": 0.5 + 0.1 * number,
        "omega_max": 0.25,
        "hypotheses": 7,
        "clusters": 2,
        "best": [],
        "verdict": verdict,
        "local_from_robot": pose(0.5 * number, 0.0),
        **more,
    }


def trial(number, outcome, **more):
    return {"trial": number, "start": {"sample": 0, "distance_m": 0.0, "stamp": 0.0}, "outcome": outcome, **more}


def from_start(x, y):
    return {"start": {"sample": 0, "distance_m": 0.0, "stamp": 0.0, "reference": pose(x, y)}}


def write_lines(file, objects):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("".join(json.dumps(line) + "\n" for line in objects))


def write_pcd(file, points):
    file.parent.mkdir(parents=True, exist_ok=True)
    header = f"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS {len(points)}\nDATA binary\n"
    file.write_bytes(header.encode() + b"".join(struct.pack("<3f", *point) for point in points))


def write_run(folder, steps, points=MAP):
    write_lines(folder / "steps.jsonl", steps)
    write_pcd(folder / "maps/global.pcd", points)
    return folder


@pytest.fixture
def drive(tmp_path):
    """Searching, ambiguous, localized, localized; and a second trial, which is never localized."""
    declared = pose(5.0, 2.0, math.pi / 2)
    steps = [
        step(0, best=[cluster(0.2, pose(1.0, 1.0, 0.5)), cluster(0.7, pose(8.0, 6.0, -2.0))]),
        step(1, "ambiguous", candidates=[pose(2.0, 3.0), pose(8.0, 5.0, math.pi)], estimate=pose(8.0, 5.0, math.pi)),
        step(
            2,
            "localized",
            estimate=declared,
            reference=pose(5.1, 2.2, 1.5),
            translation_error_m=0.2236,
            rotation_error_deg=4.06,
            best=[cluster(0.9, declared)],
        ),
        step(3, "localized", estimate=pose(5.0, 3.0, math.pi / 2), translation_error_m=7.0, rotation_error_deg=90.0),
        step(0, trial=1),
        step(1, "unknown_place", trial=1),
    ]
    folder = write_run(tmp_path / "drive", steps)
    write_pcd(folder / "maps/trial_0000/step_0002.pcd", [(2.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 0.0, 5.0)])
    return folder


# What is drawn.


def only_axes(figure):
    """Those of the map, which are made before those of a colour bar."""
    return figure.axes[0]


def with_gid(axes, gid):
    found = [artist for artist in axes.get_children() if artist.get_gid() == gid]
    assert len(found) <= 1, gid
    return found[0] if found else None


def points_of(axes, gid):
    return [tuple(point) for point in with_gid(axes, gid).get_xydata()]


def approx(points):
    return [pytest.approx(point, abs=1e-5) for point in points]


def robot_of(triangle):
    """Place and heading of a triangle's robot: two fifths of the way from the tip to the back."""
    (x, y), left, right = triangle[:3]
    back = (0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1]))
    heading = math.atan2(y - back[1], x - back[0])
    return 0.4 * x + 0.6 * back[0], 0.4 * y + 0.6 * back[1], heading


def robot_at(axes, gid):
    return robot_of(with_gid(axes, gid).get_xy())


def colour_of(patch):
    return matplotlib.colors.to_hex(patch.get_facecolor())


def clusters_of(axes):
    return [shapes for shapes in axes.collections if isinstance(shapes, PolyCollection)]


def legend_of(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


# A step on the map.


def test_map_shows_the_first_declaration(drive):
    axes = only_axes(plotting.plot_map(drive))
    assert axes.get_title() == "Trial 0, step 2: localized"
    assert axes.get_aspect() == 1.0
    assert points_of(axes, "global_map") == [point[:2] for point in MAP]
    assert with_gid(axes, "global_map").get_color() == "#b0b0b0"
    assert robot_at(axes, "mark_0") == pytest.approx((5.0, 2.0, math.pi / 2))
    assert colour_of(with_gid(axes, "mark_0")) == RED
    assert robot_at(axes, "reference") == pytest.approx((5.1, 2.2, 1.5))
    assert with_gid(axes, "estimate") is None
    declared = "declared pose (22.4 cm and 4.1° off)"
    assert legend_of(axes) == ["global map", "local map", declared, "reference pose"]


def test_map_has_the_local_map_where_the_estimate_puts_it(drive):
    # The robot is at (1, 0) of the local map and at (5, 2) of the global one, looking along y. The local origin is
    # a metre behind it, at (5, 1).
    axes = only_axes(plotting.plot_map(drive))
    assert points_of(axes, "local_map") == approx([(5.0, 3.0), (4.0, 2.0), (5.0, 1.0)])


def test_map_has_a_local_map_in_space_seen_from_above(tmp_path):
    # The local map is rolled by 90 degrees about x: its y is up, and its z is -y of the map. The robot is 1 m above its
    # origin.
    half = math.sqrt(0.5)
    estimate = {"x": 10.0, "y": 20.0, "z": 0.0, "qx": 0.0, "qy": 0.0, "qz": 0.0, "qw": 1.0, "theta": 0.0}
    robot = {"x": 0.0, "y": 1.0, "z": 0.0, "qx": -half, "qy": 0.0, "qz": 0.0, "qw": half, "theta": 0.0}
    folder = write_run(tmp_path / "space", [step(0, "localized", estimate=estimate, local_from_robot=robot)])
    write_pcd(folder / "maps/trial_0000/step_0000.pcd", [(0.0, 1.0, 0.0), (1.0, 2.0, 3.0)])
    axes = only_axes(plotting.plot_map(folder))
    assert points_of(axes, "local_map") == approx([(10.0, 20.0), (11.0, 17.0)])
    assert robot_at(axes, "mark_0") == pytest.approx((10.0, 20.0, 0.0))

    # A third of a turn about (1, 1, 1): x of the local map is y of the map, its y is z, and its z is x.
    turned = {"x": 10.0, "y": 20.0, "z": 0.0, "qx": 0.5, "qy": 0.5, "qz": 0.5, "qw": 0.5, "theta": math.pi / 2}
    write_lines(folder / "steps.jsonl", [step(0, "localized", estimate=turned)])
    assert points_of(only_axes(plotting.plot_map(folder)), "local_map") == approx([(10.0, 20.0), (13.0, 21.0)])


def test_map_shows_clusters_by_rating(drive):
    axes = only_axes(plotting.plot_map(drive, step=0))
    (shapes,) = clusters_of(axes)
    assert list(shapes.get_array()) == [0.2, 0.7]  # the best on top
    assert shapes.get_clim() == (0.0, 1.0)
    robots = [robot_of(path.vertices) for path in shapes.get_paths()]
    assert robots[0] == pytest.approx((1.0, 1.0, 0.5))
    assert robots[1] == pytest.approx((8.0, 6.0, -2.0))
    assert axes.get_title() == "Trial 0, step 0: searching"
    assert legend_of(axes) == ["global map"]


def test_map_shows_candidates_and_an_estimate_that_was_not_declared(drive):
    axes = only_axes(plotting.plot_map(drive, step=1))
    assert robot_at(axes, "mark_0") == pytest.approx((2.0, 3.0, 0.0))
    assert robot_at(axes, "mark_1")[:2] == pytest.approx((8.0, 5.0))
    assert colour_of(with_gid(axes, "mark_0")) == colour_of(with_gid(axes, "mark_1")) == ORANGE
    assert robot_at(axes, "estimate")[:2] == pytest.approx((8.0, 5.0))
    assert with_gid(axes, "reference") is None
    assert clusters_of(axes) == []
    assert legend_of(axes) == ["global map", "candidates (2)", "estimate, not declared"]


def test_map_shows_the_last_step_where_none_is_localized(drive):
    axes = only_axes(plotting.plot_map(drive, trial=1))
    assert axes.get_title() == "Trial 1, step 1: unknown place"
    assert with_gid(axes, "mark_0") is None


def test_map_tells_errors_of_metres_in_metres(drive):
    axes = only_axes(plotting.plot_map(drive, step=3))
    assert legend_of(axes)[-1] == "declared pose (7.0 m and 90.0° off)"


def test_map_has_room_for_all(tmp_path):
    far = step(0, estimate=pose(-20.0, 4.0), reference=pose(5.0, 30.0))
    axes = only_axes(plotting.plot_map(write_run(tmp_path / "far", [far])))
    left, right, bottom, top = *axes.get_xlim(), *axes.get_ylim()
    assert left < -20.0 and right > 10.0 and bottom < 0.0 and top > 30.0


# Curves.


def curve(figure, gid):
    """Steps and values."""
    (line,) = (line for axes in figure.axes for line in axes.lines if line.get_gid() == gid)
    return [(x, y) for x, y in line.get_xydata() if not math.isnan(y)]


def test_curves_have_the_values_of_the_steps(drive):
    figure = plotting.plot_curves(drive)
    assert curve(figure, "match_0") == [(0, 10.0), (1, 11.0), (2, 12.0), (3, 13.0)]
    assert curve(figure, "omega_best_0") == approx([(0, 0.5), (1, 0.6), (2, 0.7), (3, 0.8)])
    assert curve(figure, "translation_0") == approx([(2, 22.36), (3, 700.0)])
    assert curve(figure, "clusters_0") == [(0, 2), (1, 2), (2, 2), (3, 2)]
    assert curve(figure, "localized_0")[0][0] == 2
    assert all(axes.get_legend() is None for axes in figure.axes)
    assert curve(plotting.plot_curves(str(drive), trial=1), "match_0") == [(0, 10.0), (1, 11.0)]


def test_curves_of_several_runs_have_labels(drive, tmp_path):
    other = write_run(tmp_path / "other" / "drive", [step(0), step(1)])
    figure = plotting.plot_curves([drive, other])
    assert len(curve(figure, "match_0")) == 4
    assert len(curve(figure, "match_1")) == 2
    assert legend_of(figure.axes[0]) == ["drive", "drive_2"]
    named = plotting.plot_curves({"_new $x$": other, "old": drive})
    assert legend_of(named.axes[0]) == [r" _new \$x\$", "old"]  # no formula, and not left out
    assert len(curve(named, "match_0")) == 2
    assert legend_of(plotting.plot_curves(folder for folder in (drive, other)).axes[0]) == ["drive", "drive_2"]


# Outcomes.


@pytest.fixture
def outcomes(tmp_path):
    """Two right, one of them without reference, one wrong, one failed; none undecided."""
    trials = [
        trial(0, "right", pose=pose(1.0, 1.0), **from_start(1.0, 2.0)),
        trial(1, "wrong", pose=pose(9.0, 7.0, math.pi), **from_start(3.0, 4.0)),
        trial(2, "right", pose=pose(2.0, 2.0)),
        trial(3, "failed", **from_start(6.0, 5.0)),
        trial(4, "right", pose=pose(1.0, 1.0), **from_start(7.0, 2.0)),
    ]
    steps = [
        step(0, "localized", reference=pose(1.0, 2.0), estimate=pose(1.0, 1.0)),
        step(0, trial=1, reference=pose(3.0, 4.0)),
        step(1, trial=1, reference=pose(3.5, 4.0)),
        step(2, "localized", trial=1, reference=pose(4.0, 4.5), estimate=pose(9.0, 7.0)),
        step(3, "localized", trial=1, reference=pose(4.5, 4.5), estimate=pose(9.0, 7.0)),
    ]
    folder = write_run(tmp_path / "outcomes", steps)
    write_lines(folder / "trials.jsonl", trials)
    return folder


def test_outcomes_are_where_trials_began(outcomes):
    axes = only_axes(plotting.plot_outcomes(outcomes))
    assert points_of(axes, "outcome_right") == [(1.0, 2.0), (7.0, 2.0)]
    assert points_of(axes, "outcome_wrong") == [(3.0, 4.0)]
    assert points_of(axes, "outcome_failed") == [(6.0, 5.0)]
    assert with_gid(axes, "outcome_undecided") is None
    right, wrong, failed = (with_gid(axes, f"outcome_{kind}") for kind in ("right", "wrong", "failed"))
    assert (right.get_color(), wrong.get_color()) == (GREEN, RED)
    assert len({line.get_color() for line in (right, wrong, failed)}) == 3
    assert len({line.get_marker() for line in (right, wrong, failed)}) == 3
    assert points_of(axes, "global_map") == [point[:2] for point in MAP]
    assert axes.get_aspect() == 1.0


def test_outcomes_are_counted_in_the_legend_with_a_note_on_those_not_drawn(outcomes):
    axes = only_axes(plotting.plot_outcomes(outcomes))
    assert legend_of(axes)[:4] == ["right: 3", "wrong: 1", "undecided: 0", "failed: 1"]
    assert axes.get_legend().get_title().get_text().startswith("1 of 5 trials have no reference")
    assert axes.get_title() == "Outcomes of 5 trials"


def test_outcomes_without_any_reference_are_counted(outcomes):
    write_lines(outcomes / "trials.jsonl", [trial(0, "declared", pose=pose(1.0, 1.0)), trial(1, "undecided")])
    axes = only_axes(plotting.plot_outcomes(outcomes))
    counts = ["right: 0", "wrong: 0", "undecided: 1", "declared, nothing to judge by: 1"]
    assert legend_of(axes) == counts
    assert axes.get_legend().get_title().get_text().startswith("2 of 2 trials")
    assert not [line for line in axes.lines if str(line.get_gid()).startswith("outcome_")]


def test_outcomes_lead_from_a_wrong_start_to_the_declared_pose(outcomes):
    axes = only_axes(plotting.plot_outcomes(outcomes))
    assert points_of(axes, "way_1") == [(3.0, 4.0), (3.5, 4.0), (4.0, 4.5)]
    assert points_of(axes, "error_1") == [(4.0, 4.5), (9.0, 7.0)]
    assert robot_at(axes, "declared_1")[:2] == pytest.approx((9.0, 7.0))
    assert with_gid(axes, "error_0") is None
    (outcomes / "steps.jsonl").unlink()
    without = only_axes(plotting.plot_outcomes(outcomes))
    assert with_gid(without, "error_1") is None
    assert points_of(without, "outcome_wrong") == [(3.0, 4.0)]


# Sweeps.


def rate(value, low, high):
    return {"value": value, "low": low, "high": high}


def level(label, trials, success_rate):
    return {"label": label, "settings": 1, "trials": trials, "success_rate": success_rate}


def sweep_with_map():
    cells = [
        [{"settings": 1, "trials": 4, "success_rate": rate(0.25, 0.0, 0.7)}, {"settings": 0, "trials": 0}],
        [{"settings": 1, "trials": 4, "success_rate": rate(1.0, 0.5, 1.0)} for _ in range(2)],
    ]
    levels = [level("100", 8, rate(0.5, 0.25, 0.875)), level("200", 8, rate(1.0, 0.7, 1.0))]
    return {
        "experiment": "some",
        "effects": [
            {"label": "iterations", "levels": levels},
            {"label": "local_mapper", "levels": [level("odometry", 8, rate(0.75, 0.5, 1.0))]},
        ],
        "map": {
            "rows": {"label": "iterations", "levels": ["100", "200"]},
            "columns": {"label": "min_side", "levels": ["1", "2"]},
            "cells": cells,
        },
    }


def test_sweep_has_effects_and_map():
    effects = plotting.plot_sweep(sweep_with_map()).axes
    assert [axes.get_title(loc="left") for axes in effects[:2]] == ["iterations", "local_mapper"]
    marks = [[line for line in axes.lines if line.get_gid()] for axes in effects[:2]]
    assert [(line.get_gid(), *line.get_xdata()) for line in marks[0]] == [("effect_0_0", 50.0), ("effect_0_1", 100.0)]
    assert [(line.get_gid(), *line.get_xdata()) for line in marks[1]] == [("effect_1_0", 75.0)]
    interval = effects[0].collections[0].get_segments()[0]
    assert [x for x, _ in interval] == pytest.approx([25.0, 87.5])
    assert [label.get_text() for label in effects[0].get_yticklabels()] == ["100", "200"]
    heat = effects[2]
    assert {text.get_gid(): text.get_text() for text in heat.texts} == {
        "cell_0_0": "25",
        "cell_0_1": "–",
        "cell_1_0": "100",
        "cell_1_1": "100",
    }
    assert (heat.get_xlabel(), heat.get_ylabel()) == ("min_side", "iterations")


def test_sweep_of_one_parameter_has_no_map():
    sweep = sweep_with_map()
    del sweep["map"], sweep["effects"][1]
    (axes,) = plotting.plot_sweep(sweep).axes
    assert axes.get_title(loc="left") == "iterations"


# Errors.


@pytest.mark.parametrize(
    "plot, message",
    [
        (lambda d: plotting.plot_map(d / "missing"), "missing/steps.jsonl: cannot be read; run .* output.steps=true"),
        (lambda d: plotting.plot_map(d, trial=7), "steps.jsonl: has no steps of trial 7"),
        (lambda d: plotting.plot_map(d, step=4), "trial 0 has no step 4; choose one from 0 to 3"),
        (lambda d: plotting.plot_map(d, step=-1), "trial 0 has no step -1; choose one from 0 to 3"),
        (lambda d: plotting.plot_curves([d, d / "missing"]), "missing/steps.jsonl: cannot be read; run "),
        (lambda d: plotting.plot_curves([]), "name at least one folder"),
        (lambda d: plotting.plot_curves({}), "name at least one folder"),
        (lambda d: plotting.plot_outcomes(d), "drive/trials.jsonl: cannot be read; name a folder"),
        (lambda d: plotting.plot_sweep({"name": "x"}), "has no key 'effects'; give what glocal sweep --json prints"),
        (lambda d: plotting.plot_sweep({"effects": []}), "no parameter varies, so that there is nothing to draw"),
    ],
)
def test_errors_name_a_way_out(drive, plot, message):
    with pytest.raises(ValueError, match=message):
        plot(drive)


def test_errors_of_files_name_them(drive, outcomes):
    write_lines(outcomes / "trials.jsonl", [])
    with pytest.raises(ValueError, match="outcomes/trials.jsonl: has no trials; run the experiment again"):
        plotting.plot_outcomes(outcomes)
    with open(drive / "steps.jsonl", "a", encoding="utf-8") as steps:
        steps.write('{"trial": 0, "st')
    with pytest.raises(ValueError, match=r"drive/steps.jsonl:7: is no line of results; run"):
        plotting.plot_map(drive)
    global_map = outcomes / "maps/global.pcd"
    global_map.write_bytes(global_map.read_bytes()[:-1])
    with pytest.raises(ValueError, match=r"maps/global.pcd: is no point cloud as glocal writes them"):
        plotting.plot_map(outcomes)
    global_map.unlink()
    with pytest.raises(ValueError, match=r"there is no .*maps/global.pcd; run .* --set output.maps=all"):
        plotting.plot_map(outcomes)


# What the user has set, and where plots are shown.


def all_plots(drive, outcomes):
    return {
        "map": lambda: plotting.plot_map(drive),
        "clusters": lambda: plotting.plot_map(drive, step=0),
        "curves": lambda: plotting.plot_curves(drive),
        "outcomes": lambda: plotting.plot_outcomes(outcomes),
        "sweep": lambda: plotting.plot_sweep(sweep_with_map()),
    }


def test_plots_leave_settings_and_pyplot_alone(drive, outcomes):
    from matplotlib import pyplot

    own = {"font.size": 31.0, "lines.linewidth": 9.0, "axes.facecolor": "red"}
    with matplotlib.rc_context(own):
        pyplot.figure()
        before = matplotlib.rcParams.copy()
        registered = pyplot.get_fignums()
        for name, plot in all_plots(drive, outcomes).items():
            assert isinstance(plot(), Figure), name
            assert pyplot.get_fignums() == registered, name
            assert dict(matplotlib.rcParams) == dict(before), name
        with pytest.raises(ValueError):
            plotting.plot_map(drive, step=9)
        assert dict(matplotlib.rcParams) == dict(before)
        pyplot.close("all")


def test_plots_look_the_same_with_any_settings(drive, outcomes):
    odd = {"font.size": 31.0, "xtick.labelsize": 20.0, "axes.facecolor": "red", "axes.grid": True, "text.color": "blue"}
    odd.update({"figure.facecolor": "green", "mathtext.fontset": "cm", "lines.linewidth": 5.0})
    for name, plot in all_plots(drive, outcomes).items():
        usual = plot()._repr_png_()
        with matplotlib.rc_context(odd):
            assert plot()._repr_png_() == usual, name


def test_plots_are_shown_by_notebooks_in_the_resolution_of_figures(drive):
    with matplotlib.rc_context({"figure.dpi": 50}):
        figure = plotting.plot_map(drive)
    png = figure._repr_png_()
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    assert struct.unpack(">2I", png[16:24]) == tuple(int(50 * inches) for inches in figure.get_size_inches())


def test_plots_need_no_pyplot():
    program = "import sys; from glocal import plotting; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_plots_are_drawn_where_they_are_told_to(drive, outcomes):
    figure = Figure(figsize=(9, 4))
    left, right = figure.subplots(1, 2)
    assert plotting.plot_map(drive, axes=left) is figure
    assert plotting.plot_outcomes(outcomes, axes=right) is figure
    assert robot_at(left, "mark_0")[:2] == pytest.approx((5.0, 2.0))
    assert points_of(right, "outcome_wrong") == [(3.0, 4.0)]
    part = Figure().subfigures(1, 2)[1]
    assert plotting.plot_map(drive, axes=part.subplots()) is part.figure


@pytest.mark.parametrize("size", [(4.0, 20.0), (10.0, 8.0), (30.0, 3.0)])
def test_maps_of_any_shape_have_nothing_covered_or_cut(drive, outcomes, size):
    for folder in (drive, outcomes):
        write_pcd(folder / "maps/global.pcd", [(0.0, 0.0, 0.0), (*size, 0.0)])
    write_lines(drive / "steps.jsonl", [step(0, best=[cluster(0.5, pose(1.0, 1.0))], estimate=pose(1.0, 1.0))])
    for figure in (plotting.plot_map(drive), plotting.plot_outcomes(outcomes)):
        axes = only_axes(figure)
        parts = [axes.patch, axes.title, axes.get_legend(), *(more.patch for more in figure.axes[1:])]
        boxes = [part.get_window_extent() for part in parts]
        figure.draw_without_rendering()
        for part, box in zip(parts, boxes):
            assert part.get_window_extent().bounds == pytest.approx(box.bounds, abs=4), "places are not settled"
        for a, b in itertools.combinations(boxes, 2):
            assert min(a.x1, b.x1) - max(a.x0, b.x0) < 1 or min(a.y1, b.y1) - max(a.y0, b.y0) < 1
        for box in boxes:
            assert box.x0 >= 0 and box.y0 >= 0
            assert box.x1 <= figure.bbox.width and box.y1 <= figure.bbox.height


def test_the_stub_says_what_the_script_of_figures_has():
    stub = pathlib.Path(__file__).parents[2] / "python/glocal/_figures.pyi"

    def parameters_of(function):
        return [argument.arg for argument in function.args.args]

    for node in ast.parse(stub.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.AnnAssign):
            assert hasattr(_figures, node.target.id)
        elif isinstance(node, ast.FunctionDef):
            assert parameters_of(node) == list(inspect.signature(getattr(_figures, node.name)).parameters)
        elif isinstance(node, ast.ClassDef):
            for method in (part for part in node.body if isinstance(part, ast.FunctionDef)):
                function = getattr(getattr(_figures, node.name), method.name)
                assert parameters_of(method) == list(inspect.signature(function).parameters), method.name
