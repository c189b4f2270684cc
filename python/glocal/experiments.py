"""Experiments: reading, changing and running them, and working with their parts."""

from __future__ import annotations

import json
import os
import pathlib
import sys
from dataclasses import dataclass
from typing import Any, Callable, Mapping, Sequence, Union

from glocal import _core, strategies
from glocal._core import GlobalMap, LocalMap, Observation, Sample, StepResult
from glocal.errors import Interrupted
from glocal.results import Results, load_results

PathLike = Union[str, "os.PathLike[str]"]


def _plain(value: Any) -> Any:
    """What JSON has in place of a value that it does not know."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):  # of numpy
        return value.tolist()
    raise TypeError(f"{value!r} is no value of an experiment; there are numbers, texts, True, paths, lists and dicts")


def _yaml(value: Any) -> str:
    """A value as it is given with --set. JSON is YAML, too, but for its surrogates of characters beyond 16 bits."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=_plain)


def _pairs(changes: Mapping[str, Any]) -> list[tuple[str, str]]:
    return [(path, _yaml(value)) for path, value in changes.items()]


@dataclass(frozen=True)
class TrialProgress:
    """A trial of a run is over."""

    variant: str  #: Empty for an experiment without variants.
    trial: int
    outcome: str  #: right, wrong, undecided, declared or failed.
    why: str  #: One sentence, or the traceback of a strategy that failed.
    finished: int  #: Trials of this variant that are over, with those of an earlier run.
    trials: int  #: Of this variant.


class _Progress:
    """Counts trials; tells whoever asked."""

    def __init__(self, tell: Callable[[TrialProgress], None] | None) -> None:
        self._tell = tell
        self._variant, self._finished, self._trials = "", 0, 0

    def begin(self, variant: str, trials: int, finished: int) -> None:
        self._variant, self._trials, self._finished = variant, trials, finished

    def trial(self, trial: int, outcome: str, why: str) -> None:
        self._finished += 1
        if self._tell:
            self._tell(TrialProgress(self._variant, trial, outcome, why, self._finished, self._trials))


def _print_progress(now: TrialProgress) -> None:
    name = f"{now.variant}: " if now.variant else ""
    end = "\n" if now.finished == now.trials else ""
    failure = f"\ntrial {now.trial} failed: {now.why}\n" if now.outcome == "failed" else ""
    print(f"\r{name}{now.finished} of {now.trials} trials{failure}", end=end, file=sys.stderr, flush=True)


class Experiment:
    """An experiment file, with what `with_()` changes of it. It never changes itself."""

    def __init__(self, file: PathLike, changes: Mapping[str, Any] | None = None) -> None:
        self._path = pathlib.Path(file).absolute()
        self._changes = dict(changes or {})
        self._file = _core.ExperimentFile(self._path, _pairs(self._changes))

    @classmethod
    def load(cls, file: PathLike) -> Experiment:
        """Reads a file and all its variants. Raises ConfigError with every fault of them."""
        return cls(file)

    def with_(self, **changes: Any) -> Experiment:
        """The same experiment with other values, by their paths: `with_(**{"localizer.matcher.ransam.iterations": 50_000})`.

        Values are as in YAML: numbers, texts, True, lists and dicts; paths and what is numpy's, too. Raises ConfigError as
        load() does.
        """
        # What is given last is said last: it may be a part of what was given before, or hold it.
        kept = {path: value for path, value in self._changes.items() if path not in changes}
        changed = Experiment(self._path, {**kept, **changes})
        changed._file.require_same_file(self._file)
        return changed

    @property
    def file(self) -> pathlib.Path:
        return self._path

    @property
    def changes(self) -> dict[str, Any]:
        """What differs from the file, by path."""
        return dict(self._changes)

    @property
    def name(self) -> str:
        return self._file.name

    @property
    def variants(self) -> list[str]:
        """Names of its variants; empty where it has none."""
        return self._file.variants

    def effective_yaml(self) -> str:
        """Every value, defaulted or not; of the first variant where there are some."""
        return self._file.effective()

    def run(
        self,
        out: PathLike | None = None,
        *,
        jobs: int = 1,
        progress: bool | Callable[[TrialProgress], None] = False,
        only: Sequence[str] = (),
        force: bool = False,
    ) -> Results:
        """Runs the experiment, or all its variants, as `glocal run` does, with the same bytes as results.

        out: folder of the results (default: results/NAME). What an earlier run has left unfinished there is gone on with;
        force replaces what is complete. jobs: trials that run side by side. progress: True for a line on stderr, or what is
        called with a TrialProgress. only: names of the variants to run.

        Raises ConfigError before anything is written, RunError if results cannot be written, and Interrupted after
        Ctrl-C; a second Ctrl-C ends the process. Where the run gets complete all the same, Ctrl-C is a KeyboardInterrupt. A
        strategy that raises lets its trial fail, not the run. Other threads of Python go on meanwhile.
        """
        if not 1 <= jobs <= 256:
            raise ValueError(f"jobs must be between 1 and 256, and not {jobs}")
        tell = _print_progress if progress is True else progress or None
        counted = _Progress(tell)

        def say(kind: str, text: str) -> None:
            if kind == "warning" or progress is not False:
                print(f"{kind}: {text}", file=sys.stderr, flush=True)

        folder, complete = self._file.run(
            os.fspath(out or ""),
            list(only),
            jobs,
            force,
            strategies.sources(),
            counted.begin,
            counted.trial,
            say,
        )
        if not complete:
            raise Interrupted(load_results(folder))
        return load_results(folder)

    def load_map(self) -> GlobalMap:
        """The known map, from its source."""
        return self._file.load_map()

    def load_samples(self) -> list[Sample]:
        """The whole drive: observations, with the reference poses that only the evaluation may see."""
        return self._file.load_samples()

    def localizer(self, map: GlobalMap | None = None) -> Localizer:
        """Its localizer, on its map or on another one."""
        return Localizer(map or self.load_map(), self)

    def __repr__(self) -> str:
        changed = f", {len(self._changes)} changed" if self._changes else ""
        return f"<Experiment {self.name}: {self._path}{changed}>"


class Localizer:
    """Finds out where a robot is, one observation after the other.

    map: the known map. config: an Experiment, whose localizer it is; or values by paths within a localizer's section,
    as in {"matcher.ransam.iterations": 50_000, "motion": "planar"}, of which all others are defaults (the paper's method).
    seed and threads are those of the experiment where there is one. The answer does not depend on threads.

    Raises ConfigError where a strategy cannot work with this map.
    """

    def __init__(
        self,
        map: GlobalMap,
        config: Experiment | Mapping[str, Any] | None = None,
        *,
        seed: int = 1,
        threads: int = 1,
    ) -> None:
        if isinstance(config, Experiment):
            self._core = config._file.localizer(map)
        else:
            self._core = _core.CoreLocalizer(map, _pairs(config or {}), seed, threads)

    def step(self, observation: Observation) -> StepResult:
        """Takes in an observation, and says what is known then.

        Raises StrategyError if a strategy fails or breaks its contract; only reset() makes it good again.
        """
        return self._core.step(observation)

    def go_on(self, looks: int | None = None) -> StepResult:
        """Goes on with the search that the last step has left open (StepResult.goes_on), without an observation.

        By so many looks at points, or to its end. The result is that of the step, with what is known by now. Raises RuntimeError if none is open,
        and StrategyError as step().
        """
        return self._core.go_on(looks)

    def reset(self, trial: int = 0) -> None:
        """Forgets everything; the steps that follow draw random numbers from a stream of the trial's own."""
        self._core.reset(trial)

    @property
    def local_map(self) -> LocalMap:
        """The local map after the last step: a copy, as the map changes with the next one."""
        return self._core.local_map

    @property
    def map(self) -> GlobalMap:
        return self._core.map


def broken_promises(kind: str, name: str, params: Mapping[str, Any] | None = None) -> list[str]:
    """Has a strategy work in a small room, and returns what of its kind's contract it does not keep, a sentence each.

    params: values of its parameters by paths; all others are defaults.
    """
    return _core.broken_promises(kind, name, _pairs(params or {}))


__all__ = ["Experiment", "Localizer", "TrialProgress", "broken_promises"]
