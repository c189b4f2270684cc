"""What runs left: tables of trials and steps, summaries, comparisons and sweeps."""

from __future__ import annotations

import json
import os
import pathlib
from functools import cached_property
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Sequence, Union

import numpy as np

from glocal import _core
from glocal.errors import ConfigError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PathLike = Union[str, "os.PathLike[str]"]


class Table(Mapping[str, "np.ndarray[Any, Any]"]):
    """Columns of the same length by name: arrays of numbers, truth values or texts.

    Struct within struct is a name with a dot, as in table["pose.x"]. Where a line has no value a number is NaN, and a
    text is empty. docs/file-formats.md says what each is. The arrays cannot be written to.
    """

    def __init__(self, columns: Mapping[str, "np.ndarray[Any, Any]"]) -> None:
        self._columns = dict(columns)
        for column in self._columns.values():
            column.flags.writeable = False

    def __getitem__(self, name: str) -> "np.ndarray[Any, Any]":
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"there is no column '{name}'; there are {', '.join(self._columns)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """Number of columns; `rows` is that of lines."""
        return len(self._columns)

    @property
    def rows(self) -> int:
        return next((len(column) for column in self._columns.values()), 0)

    def frame(self) -> Any:
        """As a pandas.DataFrame. Raises ImportError without pandas."""
        import pandas

        return pandas.DataFrame(self._columns)

    def __repr__(self) -> str:
        return f"<Table: {self.rows} rows of {', '.join(self._columns)}>"


def _joined(tables: Mapping[str, Table]) -> Table:
    """The rows of several tables, with a first column that says which they are of."""
    rows = {variant: table.rows for variant, table in tables.items()}
    columns: dict[str, Any] = {"variant": np.repeat(list(rows), list(rows.values()))}
    for name in dict.fromkeys(name for table in tables.values() for name in table):
        parts = [table[name] if name in table else None for table in tables.values()]
        first = next(part for part in parts if part is not None)
        missing = "" if first.dtype.kind == "U" else np.nan
        filled = [np.full(n, missing) if part is None else part for part, n in zip(parts, rows.values())]
        columns[name] = np.concatenate(filled)
    return Table(columns)


def _as_frame(table: Table) -> Any:
    try:
        return table.frame()
    except ImportError:
        return table


class Summary(dict[str, Any]):
    """The figures of a run, as summary.json has them (docs/file-formats.md). print() shows the main ones."""

    def __str__(self) -> str:
        return _core.summary_text(json.dumps(self))


class Summaries(dict[str, Summary]):
    """Summaries of several variants by name. print() shows a table."""

    def __str__(self) -> str:
        return _core.variants_text([(name, json.dumps(summary)) for name, summary in self.items()])


class Results:
    """What a run left in a folder: that of an experiment, or those of all its variants."""

    def __init__(self, folder: PathLike) -> None:
        self.folder = pathlib.Path(folder)
        self._place = self.folder.absolute()  # wherever the process goes from here
        found = [pathlib.Path(path) for path in _core.results_folders(self._place)]
        self._is_one = [path.resolve() for path in found] == [self._place.resolve()]
        self._folders = found

    @cached_property
    def variants(self) -> dict[str, Results]:
        """The results of each variant by name; empty for an experiment without variants."""
        return {} if self._is_one else {path.name: Results(path) for path in self._folders}

    @cached_property
    def _read(self) -> tuple[Summary, Table, Table]:
        summary, trials, steps = _core.read_folder(self._place)
        return Summary(json.loads(summary)), Table(trials), Table(steps)

    def summary(self) -> Summary | Summaries:
        """The figures of the run, or of each variant."""
        return self._read[0] if self._is_one else Summaries({n: r._read[0] for n, r in self.variants.items()})

    @cached_property
    def trial_table(self) -> Table:
        """A row for each trial, as arrays; of several variants with a column `variant`."""
        return self._read[1] if self._is_one else _joined({n: r._read[1] for n, r in self.variants.items()})

    @cached_property
    def step_table(self) -> Table:
        """A row for each step of each trial, as arrays; of several variants with a column `variant`."""
        return self._read[2] if self._is_one else _joined({n: r._read[2] for n, r in self.variants.items()})

    @property
    def trials(self) -> Any:
        """A row for each trial: a pandas.DataFrame where pandas is installed, and else `trial_table`."""
        return _as_frame(self.trial_table)

    @property
    def steps(self) -> Any:
        """A row for each step of each trial: a pandas.DataFrame where pandas is installed, and else `step_table`."""
        return _as_frame(self.step_table)

    def compare(self, *, baseline: str = "", times: bool = True) -> Comparison:
        """Compares the methods or variants, as compare() does."""
        return compare([self], baseline=baseline, times=times)

    def sweep(self, *, baseline: str = "") -> Sweep:
        """What the variants teach: which settings are good, against `baseline` (default: the first), and which parameters matter."""
        return Sweep(*_core.sweep(str(self._place), 20, baseline))

    def _only(self) -> pathlib.Path:
        if not self._is_one:
            names = ", ".join(self.variants)
            raise ConfigError(f"{self.folder} holds several runs, and one is wanted: choose one of variants[...]: {names}")
        return self._place

    def plot_map(self, trial: int = 0, step: int | None = None, *, axes: Axes | None = None) -> Figure:
        """A step of a trial on the map: see glocal.plotting.plot_map()."""
        from glocal import plotting

        return plotting.plot_map(self._only(), trial, step, axes=axes)

    def plot_curves(self, trial: int = 0) -> Figure:
        """What changes from step to step of a trial, of each variant: see glocal.plotting.plot_curves()."""
        from glocal import plotting

        return plotting.plot_curves(self._folders, trial)

    def plot_outcomes(self, *, axes: Axes | None = None) -> Figure:
        """Right and wrong starts on the map: see glocal.plotting.plot_outcomes()."""
        from glocal import plotting

        return plotting.plot_outcomes(self._only(), axes=axes)

    def plot_sweep(self) -> Figure:
        """Effects of parameters, and a map of two: see glocal.plotting.plot_sweep()."""
        from glocal import plotting

        return plotting.plot_sweep(self.sweep())

    def __repr__(self) -> str:
        several = "" if self._is_one else f", {len(self._folders)} variants"
        return f"<Results: {self.folder}{several}>"


class Comparison(dict[str, Any]):
    """Methods on the same starts, compared with one of them: what `glocal compare --json` prints.

    print() tells it in short; `full` has all tests, as --full shows them, and `markdown` the same for notebooks.
    """

    def __init__(self, text: str, full: str, markdown: str, csv: str, numbers: str) -> None:
        super().__init__(json.loads(numbers))
        self.text, self.full, self.markdown, self.csv = text, full, markdown, csv

    def __str__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return self.markdown


class Sweep(dict[str, Any]):
    """What was learned from many settings: what `glocal sweep --json` prints. print() tells it."""

    def __init__(self, text: str, numbers: str) -> None:
        super().__init__(json.loads(numbers))
        self.text = text

    def __str__(self) -> str:
        return self.text


def load_results(folder: PathLike) -> Results:
    """What `run()`, or `glocal run`, left in a folder. Raises ConfigError where it left nothing there."""
    return Results(folder)


def compare(runs: Sequence[Results | PathLike], *, baseline: str = "", times: bool = True) -> Comparison:
    """Compares methods on the same starts with one of them, with the statistics of `glocal compare`.

    runs: results, or folders of them. baseline: name of a method (default: the first). times: whether to
    compare times, which no two runs have in common.
    """
    folders = [str(run._place if isinstance(run, Results) else run) for run in runs]
    return Comparison(*_core.compare(folders, baseline, times))
