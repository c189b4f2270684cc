"""What can go wrong, as exceptions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Sequence

if TYPE_CHECKING:
    from glocal.results import Results


@dataclass(frozen=True)
class Fault:
    """One fault: where it is, which rule it breaks, and what to do about it."""

    file: str
    line: int  #: From 1; 0 if the fault has no line.
    column: int  #: From 1; 0 if the fault has no column.
    message: str

    def __str__(self) -> str:
        place = self.file
        if self.line:
            place += f":{self.line}"
            if self.column:
                place += f":{self.column}"
        return f"{place}: {self.message}" if place else self.message


class ConfigError(ValueError):
    """Unusable configuration or input. Nothing has been written.

    `faults` has all that were found, sorted by place.
    """

    def __init__(self, faults: Sequence[Fault] | str) -> None:
        self.faults = [Fault("", 0, 0, faults)] if isinstance(faults, str) else list(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))


class RunError(RuntimeError):
    """Something failed while running: a disk is full, a folder cannot be written to."""


class StrategyError(RunError):
    """A strategy raised an exception or broke its contract; the message names it and the step."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a run in good order.

    `results` has the trials that are finished. The same run into the same folder goes on with the others.
    """

    def __init__(self, results: Results) -> None:
        super().__init__(f"interrupted: finished trials are in {results.folder}, and the same run goes on there")
        self.results = results
