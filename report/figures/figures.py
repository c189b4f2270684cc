#!/usr/bin/env python3
"""Draws Fig. 3, 4 and 5 of the paper from folders of results that `glocal run` left.

    python3 figures.py DIR... --out FOLDER [--trial N]
    python3 figures.py --sweep FILE --out FOLDER

The second draws what `glocal sweep --json` has told instead: what each parameter does, and two of them in a map.
`glocal figures` calls it like this, and keeps the file as it is once it is there: change what you like.
Needs matplotlib (Debian: python3-matplotlib). The same results give the same bytes.
The Python package has it as a module. Nothing is drawn or set when it is imported.
"""
import argparse
import array
import json
import math
import os
import pathlib
import re
import sys
import tempfile
from dataclasses import dataclass, field

try:
    import matplotlib
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
except ImportError as error:
    if __name__ != "__main__":
        raise
    sys.exit(f"figures.py needs matplotlib ({error}): install Debian's package python3-matplotlib")

# What a run is called in legends, by the name of its folder: {"paper_simulation": "simulation"}.
LABELS = {}
FORMATS = ["pdf", "svg", "png"]
COLUMN, PAGE = 3.5, 7.16  # width of a column and of both, inches (IEEE)
# Okabe and Ito's colours, which colour-blind readers tell apart; styles for print without colour.
BLACK, ORANGE, GREEN, BLUE, RED = "#000000", "#e69f00", "#009e73", "#0072b2", "#d55e00"
COLOURS = [BLUE, RED, GREEN, ORANGE, "#cc79a7", "#56b4e9", BLACK]
DASHES = ["-", (0, (4, 1)), (0, (1, 1)), (0, (4, 1, 1, 1))]
SHADES = "viridis"
OMEGA_PLACE = "$\\Omega\\prime$"
STYLE = {
    "font.family": ["STIXGeneral", "DejaVu Sans"],  # the second has what a folder's name may need
    "mathtext.fontset": "stix",
    "font.size": 8,
    "axes.labelsize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "legend.handletextpad": 0.4,
    "legend.columnspacing": 1.2,
    "axes.linewidth": 0.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.5,
    "ytick.major.width": 0.5,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "lines.linewidth": 0.8,
    "path.simplify": False,  # each value stays in the file
    "savefig.dpi": 300,
    "pdf.fonttype": 42,
    "svg.hashsalt": "glocal",
}
MAKER = "glocal figures"  # how figures of an earlier call are known
METADATA = {  # without dates: the same results give the same bytes
    "pdf": {"Creator": MAKER, "CreationDate": None},
    "svg": {"Creator": MAKER, "Date": None},
    "png": {"Software": MAKER},
}
# What each step must have.
NEEDED = set("trial step stage_ms omega_best score_best omega_max hypotheses clusters best verdict local_from_robot".split())


class FiguresError(ValueError):
    """What is wrong with results, and a way out."""


class LeftOut(FiguresError):
    """Why a figure cannot be drawn from these results."""


# Poses are (x, y, theta): metres, radians.


def pose(json_pose):
    return json_pose["x"], json_pose["y"], json_pose["theta"]


def times(a, b):
    """a_from_c of a_from_b and b_from_c."""
    x, y = moved(a, b[0], b[1])
    return x, y, a[2] + b[2]


def moved(a, x, y):
    return a[0] + math.cos(a[2]) * x - math.sin(a[2]) * y, a[1] + math.sin(a[2]) * x + math.cos(a[2]) * y


def inverse(a):
    x, y = moved((0, 0, -a[2]), -a[0], -a[1])
    return x, y, -a[2]


# What a run left.


class Run:
    """One trial of a run: the lines of steps.jsonl, and point clouds. docs/file-formats.md says what is in them.

    Each step must have the keys `needed`, `local_from_robot` among them.
    """

    def __init__(self, folder, trial, needed=NEEDED):
        self.folder, self.trial = pathlib.Path(folder), trial
        self.steps = read_steps(self.folder / "steps.jsonl", trial, needed)
        # A local map's frame is the robot's pose where it was started: there again, and it has started over.
        origin = (0, 0, 0)
        epoch, last = 0, origin
        for step in self.steps:
            now = pose(step["local_from_robot"])
            if now == origin and last != origin:
                epoch += 1
            step["epoch"], last = epoch, now

    def with_verdict(self, verdict, key):
        """Steps with this verdict that have `key`."""
        return [step for step in self.steps if step["verdict"] == verdict and step.get(key)]

    def first_localized(self):
        return next(iter(self.with_verdict("localized", "estimate")), None)

    def global_map(self):
        return read_pcd(global_map_file(self.folder))

    def local_map(self, step):
        return read_pcd(self.local_map_file(step))

    def local_map_file(self, step):
        return self.folder / f"maps/trial_{self.trial:04}/step_{step['step']:04}.pcd"


def global_map_file(folder):
    return folder / "maps/global.pcd"


def printable(text):
    """Text without what matplotlib would take for something else: formulas, labels to be left out, odd bytes."""
    text = os.fsencode(text).decode("utf-8", "replace").replace("$", r"\$")
    text = "".join(c if c.isprintable() else "?" for c in text)
    return " " + text if text.startswith("_") else text


def read_lines(file, needed, way_out):
    """Yields the objects of a file of results, one a line; each must have the keys `needed`."""
    number = 1
    try:
        with open(file, encoding="utf-8") as lines:
            for number, line in enumerate(lines, 1):
                result = json.loads(line)
                if not needed <= result.keys():
                    raise ValueError
                yield result
    except OSError:
        raise FiguresError(f"{file}: cannot be read; {way_out}") from None
    except (ValueError, AttributeError):
        raise FiguresError(f"{file}:{number}: is no line of results; run the experiment again") from None


def read_steps(file, trial, needed):
    lines = read_lines(file, needed, "run the experiment with --set output.steps=true")
    steps = [step for step in lines if step["trial"] == trial]
    if not steps:
        raise FiguresError(f"{file}: has no steps of trial {trial}")
    return steps


def read_points(file):
    """x, y, z, x, ... of a binary PCD file with three numbers a point, in single or double precision."""
    if not file.exists():
        raise LeftOut(f"there is no {file}; run the experiment with --set output.maps=all")
    header, _, body = file.read_bytes().partition(b"DATA binary\n")
    points = re.search(rb"\nPOINTS (\d+)\n", header)
    kind = "d" if b"\nSIZE 8 8 8\n" in header else "f"
    if not points or len(body) != 3 * array.array(kind).itemsize * int(points[1]):
        why = "is no point cloud as glocal writes them, or a part of one; run the experiment again"
        raise FiguresError(f"{file}: {why}")
    return array.array(kind, body)


def read_pcd(file):
    """Lists of x and y."""
    values = read_points(file)
    return list(values[0::3]), list(values[1::3])


def new_figure(width, height):
    """In inches. It is no figure of pyplot's, which would keep it."""
    return Figure(figsize=(width, height), layout="constrained")


# Fig. 3: curves over steps.


@dataclass
class Curve:
    name: str  # in SVG files NAME_RUN is the id of a run's curve, runs counted from 0
    label: str
    value: object  # a function of a step; None is a gap
    top: float = None  # of the axis; as the values are, without
    is_logarithmic: bool = False
    beside: object = None  # another curve, dotted, in the same axes


def error(key, factor):
    """Of steps in which the robot was called localized."""
    return lambda step: factor * step[key] if step["verdict"] == "localized" and key in step else None


def of_best(key):
    return lambda step: step[key] if step["hypotheses"] else None


def score_where_other(step):
    """What the matcher ranks by, where that is not Omega."""
    return None if step["score_best"] == step["omega_best"] else of_best("score_best")(step)


# One list for each panel, (a) to (f).
CURVES = [
    [Curve("match", "time of a match (ms)", lambda step: step["stage_ms"]["match"])],
    [
        Curve(
            "omega_best",
            "$\\Omega_{best}$",
            of_best("omega_best"),
            1.03,
            beside=Curve("score_best", "score", score_where_other),
        )
    ],
    [Curve("omega_max", "$\\Omega_{max}$", lambda step: step["omega_max"], 1.03)],
    [Curve("omega_place", OMEGA_PLACE, lambda step: step.get("omega_place"), 1.03)],
    [
        Curve("translation", "error (cm)", error("translation_error_m", 100)),
        Curve("rotation", "error (°)", error("rotation_error_deg", 1)),
    ],
    [Curve("clusters", "clusters", lambda step: step["clusters"], is_logarithmic=True)],
]


def plot_values(axes, curve, run, i, **line):
    values = [curve.value(step) for step in run.steps]
    values = [math.nan if value is None else value for value in values]
    steps = [step["step"] for step in run.steps]
    axes.plot(steps, values, gid=f"{curve.name}_{i}", color=COLOURS[i % len(COLOURS)], **line)


def draw_curve(axes, curve, runs):
    for i, run in enumerate(runs):
        line = {"linestyle": DASHES[i % len(DASHES)], "label": run.label}
        # With dots, for what lies alone between two gaps.
        plot_values(axes, curve, run, i, marker="o", markersize=1.2, markeredgewidth=0, **line)
        if curve.beside and any(curve.beside.value(step) is not None for step in run.steps):
            plot_values(axes, curve.beside, run, i, linestyle=":")
        first = run.first_localized()
        if curve.name == "clusters" and first:
            axes.axvline(first["step"], gid=f"localized_{i}", color=BLACK, linestyle=line["linestyle"], linewidth=0.6)
    if not any(math.isfinite(y) for line in axes.lines for y in line.get_ydata()):
        axes.text(0.5, 0.5, "none", transform=axes.transAxes, ha="center", va="center")
    if curve.is_logarithmic:
        axes.set_yscale("symlog", linthresh=1)  # linear from 0 to 1
        axes.yaxis.set_major_formatter("{x:g}")
    axes.set(ylabel=curve.label, xlim=(0, 1.02 * max(len(run.steps) for run in runs)), ylim=(0, curve.top))
    axes.xaxis.get_major_locator().set_params(integer=True)


def draw_panel(figure, place, panel, runs, letter, has_legend):
    """The curves of a panel, one over the other."""
    all_axes = [figure.add_subplot(row) for row in place.subgridspec(len(panel), 1)]
    for axes, curve in zip(all_axes, panel):
        draw_curve(axes, curve, runs)
        axes.tick_params(labelbottom=axes is all_axes[-1])
    figure.align_ylabels(all_axes)
    all_axes[-1].set_xlabel("localization step" + letter)
    if has_legend and len(runs) > 1:
        all_axes[0].legend()


def draw_panels(figure, runs):
    """All of them."""
    for letter, place, panel in zip("abcdef", figure.add_gridspec(3, 2), CURVES):
        draw_panel(figure, place, panel, runs, f"\n({letter})", letter == "a")


def draw_curves(runs):
    """Yields names and figures: each panel for itself, and all of them."""
    for letter, panel in zip("abcdef", CURVES):
        figure = new_figure(COLUMN, 1.9)
        draw_panel(figure, figure.add_gridspec(1, 1)[0], panel, runs, "", True)
        yield f"fig3{letter}", figure
    figure = new_figure(COLUMN, 4.6)
    draw_panels(figure, runs)
    yield "fig3", figure


# Fig. 4 and 5: pictures of maps. A picture is put together first, so that its size is known before it is drawn.


@dataclass
class Picture:
    """What is seen on a map; all in one frame."""

    background: tuple = ((), ())  # x and y of the global map
    foreground: tuple = ((), ())  # of the local map
    path: list = field(default_factory=list)  # poses
    rated: list = field(default_factory=list)  # (rating, pose)
    marks: list = field(default_factory=list)  # (pose, colour, what it is)
    others: list = field(default_factory=list)  # poses that need room, too
    is_ground: bool = False  # whether the global map is grey although there is no local one

    def extent(self):
        """Smallest and largest x and y, with a margin, and room for the scale bar below."""
        poses = self.path + [p for _, p in self.rated] + [p for p, _, _ in self.marks] + self.others
        x = [*self.background[0], *self.foreground[0], *(p[0] for p in poses)]
        y = [*self.background[1], *self.foreground[1], *(p[1] for p in poses)]
        size = max(max(x) - min(x), max(y) - min(y), 1.0)
        return min(x) - 0.02 * size, max(x) + 0.02 * size, min(y) - 0.09 * size, max(y) + 0.02 * size

    def aspect(self):
        left, right, bottom, top = self.extent()
        return (right - left) / (top - bottom)

    def mark_size(self):
        """Of triangles, m."""
        left, right, bottom, top = self.extent()
        return 0.04 * max(right - left, top - bottom)


def clusters_of_first_step(run):
    """Fig. 4 (a) and 5 (a): as many clusters as steps.jsonl lists."""
    rated = [(cluster["r"], pose(cluster["pose"])) for cluster in run.steps[0]["best"]]
    if not rated:
        raise LeftOut("the first step has no clusters")
    return Picture(run.global_map(), rated=rated)


def map_from_local(localized):
    return times(pose(localized["estimate"]), inverse(pose(localized["local_from_robot"])))


def marks(run, last, anchor):
    """Triangles where the robot started, was localized first and, up to the step `last`, least on the map.

    They lie in the local map of `last`. Where the robot was before this was started, the reference says, by what the
    localized step `anchor` makes of the two frames; without either there is no triangle.
    """

    def local_from_robot(step):
        if step["epoch"] == last["epoch"]:
            return pose(step["local_from_robot"])
        if not anchor or "reference" not in step:
            return None
        return times(inverse(map_from_local(anchor)), pose(step["reference"]))

    chosen = [(run.steps[0], GREEN, "start"), (run.first_localized(), RED, "localized")]
    unknown = [step for step in run.with_verdict("unknown_place", "local_from_robot") if step["step"] <= last["step"]]
    if unknown:
        least = min(unknown, key=lambda step: step.get("omega_place", 1))
        chosen.append((least, BLUE, OMEGA_PLACE + " least"))
    placed = [(local_from_robot(step), colour, label) for step, colour, label in chosen if step]
    return [mark for mark in placed if mark[0]]


def where_localized(run):
    """Fig. 4 (b): the local map on the global one, as the first localized step has it."""
    first = run.first_localized()
    if not first:
        raise LeftOut("the robot was never localized")
    picture = on_global_map(run, first, first)
    placed = marks(run, first, first)
    picture.marks = [(times(map_from_local(first), robot), colour, label) for robot, colour, label in placed]
    return picture


def on_global_map(run, step, anchor):
    """The local map of a step, laid on the global one as the localized step `anchor` has it."""
    points = [moved(map_from_local(anchor), x, y) for x, y in zip(*run.local_map(step))]
    return Picture(run.global_map(), ([x for x, _ in points], [y for _, y in points]))


def last_localized(run):
    """The last localized step that has the final local map; None without."""
    steps = run.with_verdict("localized", "estimate")
    return steps[-1] if steps and steps[-1]["epoch"] == run.steps[-1]["epoch"] else None


def last_map_on_global(run):
    """Fig. 5 (b)."""
    if not last_localized(run):
        raise LeftOut("the robot was never localized with the final local map")
    return on_global_map(run, run.steps[-1], last_localized(run))


def last_map(run):
    """Fig. 5 (c): the final local map in its own frame, with the path driven in it."""
    last = run.steps[-1]
    path = [pose(step["local_from_robot"]) for step in run.steps if step["epoch"] == last["epoch"]]
    return Picture(foreground=run.local_map(last), path=path, marks=marks(run, last, last_localized(run)))


def spread(step):
    """The largest distance between two candidates, m."""
    places = [pose(candidate)[:2] for candidate in step["candidates"]]
    return max(math.dist(a, b) for a in places for b in places)


def ambiguous(run):
    """Fig. 4 (c): the ambiguous step whose candidates lie farthest apart, and where the robot was in truth."""
    steps = run.with_verdict("ambiguous", "candidates")
    if not steps:
        raise LeftOut("no step is ambiguous")
    step = max(steps, key=spread)
    shown = [(pose(candidate), ORANGE, "candidate") for candidate in step["candidates"]]
    if "reference" in step:
        shown.append((pose(step["reference"]), RED, "true pose"))
    return Picture(run.global_map(), marks=shown)


PICTURES = {
    "fig4": [clusters_of_first_step, where_localized, ambiguous],
    "fig5": [clusters_of_first_step, last_map_on_global, last_map],
}


def triangle(robot, size):
    """Corners of a triangle that points where the robot looks."""
    return [moved(robot, x * size, y * size) for x, y in [(0.6, 0), (-0.4, 0.35), (-0.4, -0.35)]]


def dots(axes, name, points, colour, size):
    """Points as dots; in vector files as an image where there are very many."""
    style = {"marker": "o", "markersize": size, "markeredgewidth": 0, "linestyle": "none"}
    axes.plot(*points, gid=name, color=colour, rasterized=len(points[0]) > 30000, **style)


def scale_bar(axes, left, right, bottom, top):
    lengths = [digit * 10**power for power in range(-1, 4) for digit in (1, 2, 5)]
    length = max((metres for metres in lengths if metres <= 0.25 * (right - left)), default=0.1)
    x, y = left + 0.03 * (right - left), bottom + 0.02 * max(right - left, top - bottom)
    axes.plot([x, x + length], [y, y], color=BLACK, linewidth=1.2, solid_capstyle="butt")
    axes.text(x + length, y, f"  {length:g} m", va="center", fontsize=matplotlib.rcParams["legend.fontsize"])


def handles_of(marks):
    """For a legend: one for each label."""
    labels = {label: colour for _, colour, label in marks}
    style = {"linestyle": "none", "marker": ">", "markersize": 4.5, "markeredgewidth": 0.3}
    return [Line2D([], [], c=colour, mec=BLACK, label=label, **style) for label, colour in labels.items()]


def draw_picture(axes, picture, letter):
    """With a legend above."""
    draw_things(axes, picture, letter)
    if picture.marks:
        place = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncol": 3, "borderpad": 0}
        axes.legend(handles=handles_of(picture.marks), **place)


def draw_things(axes, picture, letter=""):
    left, right, bottom, top = picture.extent()
    axes.set(xlim=(left, right), ylim=(bottom, top), xticks=[], yticks=[], aspect="equal", xlabel=letter)
    axes.spines[:].set_visible(False)
    size = picture.mark_size()
    alone = not picture.foreground[0] and not picture.is_ground
    dots(axes, "global_map", picture.background, BLACK if alone else "#b0b0b0", 0.6 if alone else 1.2)
    dots(axes, "local_map", picture.foreground, BLACK, 0.6)
    x, y = [p[0] for p in picture.path], [p[1] for p in picture.path]
    axes.plot(x, y, gid="path", color="#808080", linewidth=0.6)
    if picture.rated:
        rated = sorted(picture.rated)  # the best on top
        corners = [triangle(robot, 0.7 * size) for _, robot in rated]
        shapes = PolyCollection(corners, cmap=SHADES, edgecolors="white", linewidths=0.2)
        shapes.set_array([r for r, _ in rated])
        shapes.set_clim(0, 1)
        axes.add_collection(shapes)
        axes.figure.colorbar(shapes, ax=axes, location="left", label="$r(C_i)$", shrink=0.7, aspect=25, pad=0.01)
    for i, (robot, colour, _) in enumerate(picture.marks):
        style = {"facecolor": colour, "edgecolor": BLACK, "linewidth": 0.3, "zorder": 3}
        axes.fill(*zip(*triangle(robot, size)), gid=f"mark_{i}", **style)
    scale_bar(axes, left, right, bottom, top)


def draw_pictures(run):
    """Yields names and figures: each picture for itself, and those of Fig. 4 and of Fig. 5 side by side.

    Tells of those that cannot be drawn.
    """
    for name, makers in PICTURES.items():
        made = {}
        for letter, make in zip("abc", makers):
            try:
                made[letter] = make(run)
            except LeftOut as why:
                print(f"{run.folder}: {name}{letter} is left out: {why}", file=sys.stderr)
                continue
            width = COLUMN - 0.6 if made[letter].rated else COLUMN  # beside the colour bar
            height = min(width / made[letter].aspect(), COLUMN) + 0.15
            figure = new_figure(COLUMN, height)
            draw_picture(figure.add_subplot(), made[letter], "")
            yield name + letter, figure
        if made:
            aspects = [picture.aspect() for picture in made.values()]
            height = min((PAGE - 0.6) / sum(aspects), COLUMN)
            figure = new_figure(max(height * sum(aspects) + 0.6, COLUMN), height + 0.4)
            places = figure.add_gridspec(1, len(made), width_ratios=aspects)
            for place, (letter, picture) in zip(places, made.items()):
                draw_picture(figure.add_subplot(place), picture, f"({letter})")
            yield name, figure


# What a sweep has taught.


def read_sweep(file):
    try:
        sweep = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as problem:
        raise FiguresError(f"{file}: is not what glocal sweep --json prints ({problem})") from None
    if not sweep["effects"]:
        raise FiguresError(f"{file}: no parameter varies; there is nothing to draw")
    return sweep


def per_cent(rate):
    """Value, and how far its interval reaches down and up."""
    return 100 * rate["value"], 100 * (rate["value"] - rate["low"]), 100 * (rate["high"] - rate["value"])


def draw_effect(axes, number, effect):
    """The levels of a parameter, the first on top, with their intervals."""
    levels = [level for level in effect["levels"] if level["trials"]]
    for place, level in enumerate(levels):
        value, down, up = per_cent(level["success_rate"])
        bar = axes.errorbar(value, place, xerr=[[down], [up]], color=BLUE, marker="o", markersize=3, linewidth=1)
        bar.lines[0].set_gid(f"effect_{number}_{place}")
    axes.set_yticks(range(len(levels)), [printable(level["label"]) for level in levels])
    axes.set(xlim=(-1, 101), ylim=(len(levels) - 0.5, -0.5))
    # Above, where a long name has room beside few levels.
    axes.set_title(printable(effect["label"]), loc="left", fontsize=matplotlib.rcParams["font.size"], pad=3)
    axes.xaxis.grid(True, linewidth=0.3, color="#d0d0d0")
    axes.set_axisbelow(True)


def rows_of(effect):
    """How high its axes are: so many rows of text."""
    return len(effect["levels"]) + 1.2


def draw_effects(figure, effects):
    places = figure.add_gridspec(len(effects), 1, height_ratios=[rows_of(effect) for effect in effects])
    first = None
    for number, (place, effect) in enumerate(zip(places, effects)):
        axes = figure.add_subplot(place, sharex=first)
        first = first or axes
        draw_effect(axes, number, effect)
        axes.tick_params(labelbottom=number == len(effects) - 1)
    axes.set_xlabel("right trials (%), mean over all else")


def draw_heat_map(figure, heat):
    rows, columns = heat["rows"], heat["columns"]
    values = [[100 * cell["success_rate"]["value"] if cell["trials"] else math.nan for cell in row] for row in heat["cells"]]
    axes = figure.add_subplot()
    image = axes.imshow(values, cmap=SHADES, vmin=0, vmax=100, aspect="auto")
    for r, row in enumerate(values):
        for c, value in enumerate(row):
            # Viridis is dark below the middle. A cell without a setting stays empty.
            style = {"ha": "center", "va": "center", "color": "black" if value > 43 or math.isnan(value) else "white"}
            axes.text(c, r, "–" if math.isnan(value) else f"{value:.0f}", gid=f"cell_{r}_{c}", **style)
    turned = any(len(label) > 6 for label in columns["levels"])
    style = {"rotation": 30, "ha": "right"} if turned else {}
    axes.set_xticks(range(len(columns["levels"])), [printable(label) for label in columns["levels"]], **style)
    axes.set_yticks(range(len(rows["levels"])), [printable(label) for label in rows["levels"]])
    axes.set(xlabel=printable(columns["label"]), ylabel=printable(rows["label"]))
    axes.spines[:].set_visible(False)
    figure.colorbar(image, ax=axes, label="right trials (%)", aspect=12, pad=0.02)


def draw_sweep(sweep, out):
    """Yields folder, names and figures."""
    figure = new_figure(COLUMN, 0.35 + 0.18 * sum(map(rows_of, sweep["effects"])))
    draw_effects(figure, sweep["effects"])
    yield out, "sweep_effects", figure
    if "map" in sweep:
        figure = new_figure(COLUMN, 1.0 + 0.3 * len(sweep["map"]["cells"]))
        draw_heat_map(figure, sweep["map"])
        yield out, "sweep_map", figure


# Files.


def write(out, figures):
    """Writes (folder, name, figure) below `out`: elsewhere first, and moved when all are drawn.

    Figures of an earlier call that are not drawn any more are removed.
    """
    out.mkdir(parents=True, exist_ok=True)
    moves = []
    with tempfile.TemporaryDirectory(dir=out, prefix=".figures.") as unfinished:
        for folder, name, figure in figures:
            figure.draw_without_rendering()
            figure.set_layout_engine(None)  # laid out once for all formats
            for extension in FORMATS:
                file = pathlib.Path(unfinished) / f"{len(moves)}.{extension}"
                figure.savefig(file, metadata=METADATA.get(extension))
                moves.append((file, folder / f"{name}.{extension}"))
        for file, target in moves:
            target.parent.mkdir(exist_ok=True)
            os.replace(file, target)
    targets = {target for _, target in moves}
    for folder in {target.parent for target in targets}:
        drawn = "sweep_*.*" if folder / "sweep_effects.svg" in targets else "fig[345]*.*"
        for old in set(folder.glob(drawn)) - targets:
            if old.is_file() and MAKER.encode() in old.read_bytes():
                old.unlink()
    print(f"{len(moves) // len(FORMATS)} figures in {out}, each as {', '.join(FORMATS)}")


def give_names(runs):
    """Names of folders and labels that tell runs apart."""
    taken = set()
    for run in runs:
        name = run.folder.resolve().name
        same = (f"{name}_{i}" for i in range(2, len(runs) + 1))
        run.name = name if name not in taken else next(other for other in same if other not in taken)
        run.label = LABELS.get(run.name, printable(run.name))
        taken.add(run.name)


def draw_all(runs, out):
    """Yields folders, names and figures."""
    for name, figure in draw_curves(runs):
        yield out, name, figure
    for run in runs:
        for name, figure in draw_pictures(run):
            yield out / run.name if len(runs) > 1 else out, name, figure


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", metavar="DIR", help="folder of results, as glocal run leaves it")
    parser.add_argument("--out", required=True, type=pathlib.Path, metavar="FOLDER", help="where to write the figures")
    parser.add_argument("--trial", type=int, default=0, metavar="N", help="number of the trial, from 0 (default: 0)")
    parser.add_argument("--sweep", type=pathlib.Path, metavar="FILE", help="what glocal sweep --json printed")
    options = parser.parse_args()
    if bool(options.folders) == bool(options.sweep):
        parser.error("name folders of results, or a file with --sweep")
    sys.stdout.reconfigure(errors="surrogateescape")  # names of folders need not be UTF-8
    matplotlib.rcdefaults()  # whatever a matplotlibrc says
    matplotlib.rcParams.update(STYLE)
    try:
        if options.sweep:
            write(options.out, draw_sweep(read_sweep(options.sweep), options.out))
            return
        runs = [Run(folder, options.trial) for folder in options.folders]
        give_names(runs)
        write(options.out, draw_all(runs, options.out))
    except FiguresError as problem:
        sys.exit(str(problem))
    except OSError as problem:
        sys.exit(f"figures.py: {problem}")


if __name__ == "__main__":
    main()
