"""Plots of what `glocal run` and `glocal sweep` leave, for notebooks and scripts. Needs matplotlib.

    from glocal.plotting import plot_map
    plot_map("results/paper_simulation").savefig("map.png")

- Each function returns a matplotlib Figure. A notebook shows it if it is the last value of a cell.
- Such a figure is none of pyplot's. To see a plot in a window, or beside others, give `axes` from `pyplot.subplots()`.
  What comes back is then the figure of these axes.
- All look the same whatever the settings of matplotlib are, apart from `figure.dpi`. The settings stay as they are.
- Maps are in metres, in the map's frame, and poses in space are seen from above.
- Bad results are a ValueError with a sentence that names the file and a way out.
- docs/file-formats.md says what is in a folder of results. `folder` is that of one run: of several variants, one.
"""
# mypy: allow-subclassing-any
import contextlib
import io
import os
import pathlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import matplotlib
import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from glocal import _core, _figures

__all__ = ["plot_curves", "plot_map", "plot_outcomes", "plot_sweep"]

Folder = str | os.PathLike[str]
JsonPose = Mapping[str, float]  # {x, y, theta}, or {x, y, z, qx, qy, qz, qw, theta}: m, rad
Pose = tuple[float, float, float]  # x, y, theta

_WIDTH, _HEIGHT = 6.0, 5.0  # of maps, inches
_STYLE = {  # type is larger than in print
    **_figures.STYLE,
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.labelsize": 10,
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "legend.fontsize": 9,
    "legend.title_fontsize": 9,
    "figure.constrained_layout.h_pad": 0.08,  # inches
    "figure.constrained_layout.w_pad": 0.08,
}
_MAP_KEYS = set("trial step best verdict local_from_robot".split())
# Colour, marker and what it is called, in the order in which they are drawn: what matters most lies on top.
_OUTCOMES = {
    "undecided": (_figures.ORANGE, "s", "undecided"),
    "declared": ("#cc79a7", "v", "declared, nothing to judge by"),
    "right": (_figures.GREEN, "o", "right"),
    "failed": (_figures.BLACK, "P", "failed"),
    "wrong": (_figures.RED, "X", "wrong"),
}
_ALWAYS_COUNTED = ("right", "wrong", "undecided")  # even if there are none


def plot_map(folder: Folder, trial: int = 0, step: int | None = None, *, axes: Axes | None = None) -> Figure:
    """Draws a step of a trial on the map: what the robot saw, what was thought of it, and what is true.

    Grey points are the global map, black ones the local map of the step, where the step's pose estimate puts it. Small
    triangles are the best clusters (`output.clusters`), coloured by rating. Large ones are the declared pose (red) or
    the candidates of an ambiguous step (orange). Outlines are the reference pose (green) and an estimate that was not
    declared (blue). What the run did not keep is left out, but the global map must be there.

    Args:
        folder: results of one run.
        trial: its number, from 0.
        step: its number in the trial, from 0; by default that of the first declaration, else the last one.
        axes: where to draw; by default in a new figure of up to 6 inches by 6.

    Raises:
        ValueError: there are no such steps (`output.steps`) or no global map (`output.maps`), or a file is damaged.
    """
    run = _figures.Run(folder, trial, _MAP_KEYS)
    shown = _step_of(run, step)
    picture = _figures.Picture(run.global_map(), _local_map_on_global(run, shown), is_ground=True)
    picture.rated = [(cluster["r"], _figures.pose(cluster["pose"])) for cluster in shown["best"]]
    outlined = []  # gid, pose, how large, colour, what it is
    if shown["verdict"] == "ambiguous":
        places = [_figures.pose(candidate) for candidate in shown.get("candidates", [])]
        picture.marks = [(place, _figures.ORANGE, f"candidates ({len(places)})") for place in places]
    if "reference" in shown:
        outlined.append(("reference", _figures.pose(shown["reference"]), 2.2, _figures.GREEN, "reference pose"))
    if "estimate" in shown:
        estimate, off = _figures.pose(shown["estimate"]), _error(shown)
        if shown["verdict"] == "localized":
            picture.marks.append((estimate, _figures.RED, f"declared pose{off}"))
        else:
            outlined.append(("estimate", estimate, 1.6, _figures.BLUE, f"estimate, not declared{off}"))
    picture.others = [place for _, place, _, _, _ in outlined]

    with _style():
        axes = axes or _new_axes(picture)
        _figures.draw_things(axes, picture)
        handles = [_dot("#b0b0b0", "global map")]
        if picture.foreground[0]:
            handles.append(_dot(_figures.BLACK, "local map"))
        handles += _figures.handles_of(picture.marks)
        for gid, place, scale, colour, label in outlined:
            corners = _figures.triangle(place, scale * picture.mark_size())
            axes.fill(*zip(*corners), gid=gid, facecolor="none", edgecolor=colour, linewidth=1.2, zorder=4)
            style = {"linestyle": "none", "marker": ">", "markersize": 7, "markeredgewidth": 1.2}
            handles.append(Line2D([], [], color=colour, markerfacecolor="none", label=label, **style))
        verdict = shown["verdict"].replace("_", " ")
        _add_title_and_legend(axes, f"Trial {trial}, step {shown['step']}: {verdict}", handles)
        return _map_laid_out(axes, picture)


def plot_curves(folders: Folder | Iterable[Folder] | Mapping[str, Folder], trial: int = 0) -> Figure:
    """Draws the curves of Fig. 3 over the steps of a trial, a curve for each run.

    Panels: (a) time of each match, ms; (b) Omega_best, and dotted the score where that is another; (c) Omega_max; (d)
    Omega'; (e) errors in all steps called localized, cm and degrees; (f) number of clusters, with a line where the
    robot was localized first.

    Args:
        folders: results of one run, or of several. The legend has the names of folders, or the keys of a mapping.
        trial: its number in each of them, from 0.

    Raises:
        ValueError: no folders are given, a run has no steps of this trial (`output.steps`), or a file is damaged.
    """
    labels: list[str] = []
    if isinstance(folders, (str, os.PathLike)):
        folders = [folders]
    elif isinstance(folders, Mapping):
        labels, folders = list(folders.keys()), list(folders.values())
    runs = [_figures.Run(folder, trial) for folder in folders]
    if not runs:
        raise ValueError("there is nothing to draw; name at least one folder of results")
    _figures.give_names(runs)
    for run, label in zip(runs, labels):
        run.label = _figures.printable(label)
    with _style():
        figure = _NotebookFigure(figsize=(1.2 * _WIDTH, 1.3 * _WIDTH), layout="constrained")
        _figures.draw_panels(figure, runs)
        return _laid_out(figure)


def plot_outcomes(folder: Folder, *, axes: Axes | None = None) -> Figure:
    """Draws on the map where each trial began, by its outcome, and counts outcomes in the legend.

    Right, wrong, undecided and failed trials differ in colour and marker. For wrong ones, if the run kept its steps, a
    dotted line is the way driven up to the declaration, and a thin line leads from its end to the pose that was
    declared. Trials whose start has no reference pose cannot be drawn; they count, and a note above the legend says
    how many these are.

    Args:
        folder: results of one run.
        axes: where to draw; by default in a new figure of up to 6 inches by 6.

    Raises:
        ValueError: there are no trials or no global map (`output.maps`), or a file is damaged.
    """
    folder = pathlib.Path(folder)
    trials = _trials_of(folder)
    placed = [trial for trial in trials if "reference" in trial["start"]]
    lines = _lines_of_wrong(folder, trials)
    picture = _figures.Picture(_figures.read_pcd(_figures.global_map_file(folder)), is_ground=True)
    picture.others = [_figures.pose(trial["start"]["reference"]) for trial in placed]
    picture.others += [place for way, declared in lines.values() for place in [*way, declared]]

    with _style():
        axes = axes or _new_axes(picture)
        _figures.draw_things(axes, picture)
        handles = _draw_starts(axes, trials)
        if lines:
            handles += _draw_lines(axes, lines, 0.6 * picture.mark_size())
        without = len(trials) - len(placed)
        note = f"{without} of {len(trials)} trials have no reference pose\nat their start and are not drawn"
        _add_title_and_legend(axes, f"Outcomes of {len(trials)} trials", handles, note if without else None)
        return _map_laid_out(axes, picture)


def plot_sweep(sweep: Mapping[str, Any]) -> Figure:
    """Draws what each parameter of a sweep does and, where two or more vary, a map of two of them.

    Above, a panel for each parameter, that of the largest effect first: the rate of right trials with each of its
    values over all else that varies, in per cent, and its 95 % interval. Below, that rate for each pair of values of
    two parameters; a cell without a setting is empty.

    Args:
        sweep: what `glocal sweep --json` prints, as a dict; docs/file-formats.md has its keys.

    Raises:
        ValueError: it is something else, or no parameter varies.
    """
    if "effects" not in sweep:
        raise ValueError("sweep: has no key 'effects'; give what glocal sweep --json prints, read with json.load")
    if not sweep["effects"]:
        raise ValueError("sweep: no parameter varies, so that there is nothing to draw; give a sweep of variants")
    heights = [0.45 + 0.23 * sum(map(_figures.rows_of, sweep["effects"]))]
    if "map" in sweep:
        heights.append(1.2 + 0.35 * len(sweep["map"]["cells"]))
    with _style():
        figure = _NotebookFigure(figsize=(_WIDTH, sum(heights)), layout="constrained")
        parts = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
        _figures.draw_effects(parts[0], sweep["effects"])
        if "map" in sweep:
            _figures.draw_heat_map(parts[1], sweep["map"])
        return _laid_out(figure)


class _NotebookFigure(Figure):
    """Notebooks know how to show figures only once pyplot has made one. This one tells them."""

    def _repr_png_(self) -> bytes:
        png = io.BytesIO()
        self.savefig(png, format="png", dpi=self.dpi)
        return png.getvalue()


@contextlib.contextmanager
def _style() -> Iterator[None]:
    """Meanwhile the plots' own settings, and those of the user afterwards."""
    resolution = {"figure.dpi": matplotlib.rcParams["figure.dpi"]}
    with matplotlib.style.context(["default", {**_STYLE, **resolution}]):
        yield


def _laid_out(figure: Figure) -> Figure:
    """Ticks are made when they are first drawn, which shall be in this style. How many depends on their size."""
    for axes in figure.axes:
        for axis in "xy":
            axes.tick_params(axis, labelsize=matplotlib.rcParams[f"{axis}tick.labelsize"])
    figure.draw_without_rendering()
    return figure


def _new_axes(picture: _figures.Picture) -> Axes:
    """Of a new figure as wide as suits the picture."""
    room = 0.8 if picture.rated else 0.1  # for a colour bar
    width = max(min(_WIDTH, _HEIGHT * picture.aspect() + room), 0.75 * _WIDTH)
    return _NotebookFigure(figsize=(width, _HEIGHT), layout="constrained").add_subplot()


def _map_laid_out(axes: Axes, picture: _figures.Picture) -> Figure:
    """A new figure becomes as high as picture, title and legend need. One that was given stays as it is."""
    figure = axes.figure.figure
    if isinstance(figure, _NotebookFigure):
        _laid_out(figure)
        others = [axes.title, axes.get_legend()]
        height = sum(other.get_window_extent().height for other in others) / figure.dpi + 0.32
        height += axes.get_position(original=True).width * figure.get_figwidth() / picture.aspect()
        figure.set_figheight(min(height, _HEIGHT + 1.0))
        for _ in range(3):  # places of title and legend depend on the size of the picture, and the other way round
            figure.draw_without_rendering()
    return figure


def _dot(colour: str, label: str) -> Line2D:
    return Line2D([], [], color=colour, marker="o", markersize=3, linestyle="none", label=label)


def _add_title_and_legend(axes: Axes, title: str, handles: list[Line2D], note: str | None = None) -> None:
    """The legend below, where it covers nothing, with the note on top."""
    axes.set_title(title, fontfamily=matplotlib.rcParams["font.family"])
    width = axes.get_position(original=True).width * axes.figure.figure.get_figwidth()
    columns = 3 if len(handles) <= 3 or width > 0.7 * _WIDTH else 2
    place = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "ncol": columns}
    axes.legend(handles=handles, title=note, **place)


def _x_and_y(poses: Sequence[Pose]) -> tuple[list[float], list[float]]:
    return [pose[0] for pose in poses], [pose[1] for pose in poses]


def _step_of(run: _figures.Run, step: int | None) -> dict[str, Any]:
    if step is None:
        return run.first_localized() or run.steps[-1]
    for chosen in run.steps:
        if chosen["step"] == step:
            return chosen
    file = run.folder / "steps.jsonl"
    raise ValueError(f"{file}: trial {run.trial} has no step {step}; choose one from 0 to {run.steps[-1]['step']}")


def _error(step: Mapping[str, Any]) -> str:
    """Of the estimate, if there is a reference."""
    if "translation_error_m" not in step:
        return ""
    metres, degrees = step["translation_error_m"], step["rotation_error_deg"]
    length = f"{100 * metres:.1f} cm" if metres < 1 else f"{metres:.1f} m"
    return f" ({length} and {degrees:.1f}° off)"


def _pose_of(pose: JsonPose) -> _core.Pose:
    """Of the plane, or of space."""
    if "qw" in pose:
        return _core.Pose([pose[key] for key in ("x", "y", "z", "qw", "qx", "qy", "qz")])
    return _core.Pose(pose["x"], pose["y"], pose["theta"])


def _local_map_on_global(run: _figures.Run, step: Mapping[str, Any]) -> tuple[list[float], list[float]]:
    """x and y in the map's frame; none where the run has not kept the local map, or there is no estimate."""
    file = run.local_map_file(step)
    if "estimate" not in step or not file.exists():
        return [], []
    points = np.reshape(_figures.read_points(file), (-1, 3))
    map_from_local = (_pose_of(step["estimate"]) * _pose_of(step["local_from_robot"]).inverse()).matrix()
    x, y, _ = map_from_local[:3, :3] @ points.T + map_from_local[:3, 3:]
    return x.tolist(), y.tolist()


def _trials_of(folder: pathlib.Path) -> list[dict[str, Any]]:
    file = folder / "trials.jsonl"
    trials = list(_figures.read_lines(file, {"trial", "start", "outcome"}, "name a folder that one run has left"))
    if not trials:
        raise ValueError(f"{file}: has no trials; run the experiment again")
    return trials


def _lines_of_wrong(folder: pathlib.Path, trials: list[dict[str, Any]]) -> dict[int, tuple[list[Pose], Pose]]:
    """Reference poses up to the declaration, and the declared one, by the number of the trial; as far as steps tell."""
    declared = {trial["trial"]: trial["pose"] for trial in trials if trial["outcome"] == "wrong"}
    file = folder / "steps.jsonl"
    lines: dict[int, tuple[list[Pose], Pose]] = {}
    if not declared or not file.exists():
        return lines
    ways: dict[int, list[Pose]] = {}
    for step in _figures.read_lines(file, {"trial", "verdict"}, "run the experiment with --set output.steps=true"):
        number = step["trial"]
        if number in declared and number not in lines and "reference" in step:
            way = ways.setdefault(number, [])
            way.append(_figures.pose(step["reference"]))
            if step["verdict"] == "localized":
                lines[number] = way, _figures.pose(declared[number])
    return lines


def _draw_starts(axes: Axes, trials: list[dict[str, Any]]) -> list[Line2D]:
    """And counts of outcomes for the legend."""
    handles = {}
    for kind, (colour, marker, label) in _OUTCOMES.items():
        of_kind = [trial for trial in trials if trial["outcome"] == kind]
        style = {"color": colour, "marker": marker, "linestyle": "none", "markersize": 7}
        style.update(markeredgecolor="white", markeredgewidth=0.6)
        if of_kind or kind in _ALWAYS_COUNTED:
            handles[kind] = Line2D([], [], label=f"{label}: {len(of_kind)}", **style)
        starts = [_figures.pose(trial["start"]["reference"]) for trial in of_kind if "reference" in trial["start"]]
        if starts:
            axes.plot(*_x_and_y(starts), gid=f"outcome_{kind}", zorder=4, **style)
    return [handles.pop(kind) for kind in _ALWAYS_COUNTED] + list(handles.values())


def _draw_lines(axes: Axes, lines: dict[int, tuple[list[Pose], Pose]], size: float) -> list[Line2D]:
    """Of wrong trials, with a triangle of this size (m) at the declared pose. And what they are, for the legend."""
    style = {"color": _figures.RED, "linewidth": 0.8}
    for number, (way, declared) in lines.items():
        axes.plot(*_x_and_y(way), gid=f"way_{number}", linestyle=":", zorder=3, **style)
        axes.plot(*_x_and_y([way[-1], declared]), gid=f"error_{number}", zorder=3, **style)
        corners = zip(*_figures.triangle(declared, size))
        axes.fill(*corners, gid=f"declared_{number}", facecolor="white", edgecolor=_figures.RED, zorder=5)
    return [
        Line2D([], [], linestyle=":", label="way up to the declaration", **style),
        Line2D([], [], marker=">", markerfacecolor="white", label="to the declared pose", **style),
    ]
