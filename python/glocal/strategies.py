"""Strategies in Python: a class with a name, and a dataclass of parameters.

    @glocal.register("cells")
    class Cells(glocal.Clusterer):
        \"\"\"Joins hypotheses whose robot poses lie in the same cell.\"\"\"

        @dataclass
        class Params:
            side: float = glocal.param(0.5, "Side of a cell.", unit="m", above=0)

        def cluster(self, hypotheses, rng):
            cells = np.floor(hypotheses.map_from_robot[:, :2] / self.params.side)
            return np.unique(cells, axis=0, return_inverse=True)[1]

From then on "cells" is a clusterer like any other: in YAML, in `with_()`, in `list_strategies()`. What a method is
handed is lent for the call: keep arrays of it, not the objects. The contracts of C++ strategies hold for these, too.
"""

from __future__ import annotations

import collections.abc
import dataclasses
import hashlib
import importlib.util
import inspect
import itertools
import math
import pathlib
import sys
import types
import typing
from dataclasses import dataclass
from typing import Any, Callable, ClassVar, Literal, Sequence, TypeVar, Union

from glocal._core import (
    GlobalMap,
    Hypotheses,
    LocalMap,
    MatchResult,
    Observation,
    Pose,
    PoseGate,
    Rng,
    Sample,
    SourceSetup,
    StageSetup,
    StepResult,
    Clusters,
    Verdict,
    Verification,
)
from glocal.errors import ConfigError


_MOTIONS = ("planar", "upright", "free")


class _Strategy:
    """What all strategies have in common."""

    kind: ClassVar[str]
    abstract: ClassVar[tuple[str, ...]]
    #: Which motions it can work with: "planar", "upright", "free".
    motions: ClassVar[tuple[str, ...]] = ("planar",)

    def __init__(self, params: Any, setup: Any) -> None:
        self.params = params
        self.setup = setup


class MapSource(_Strategy):
    """Delivers the known map."""

    kind = "map_source"
    abstract = ("load",)
    setup: SourceSetup

    def load(self) -> GlobalMap:
        """The map; the same each time."""
        raise NotImplementedError


class ObservationSource(_Strategy):
    """Delivers a drive, one sample after the other."""

    kind = "observation_source"
    abstract = ("next",)
    setup: SourceSetup

    def next(self) -> Sample | None:
        """The next sample; None at the end, and ever after."""
        raise NotImplementedError


class _Stage(_Strategy):
    setup: StageSetup


class _Remembering(_Stage):
    def reset(self) -> None:
        """Forgets all earlier steps: a trial begins, or contact is judged anew because scans are noisy."""


class LocalMapper(_Remembering):
    """Joins observations into a local map."""

    kind = "local_mapper"
    abstract = ("add", "map")

    def reset(self) -> None:
        """Forgets all earlier steps: a trial begins."""

    def add(self, observation: Observation) -> None:
        """Takes in an observation; one without hits only moves the robot."""
        raise NotImplementedError

    def map(self) -> LocalMap:
        """The map after the last add(). Its first observation lies at the origin, not turned."""
        raise NotImplementedError


class Matcher(_Remembering):
    """Proposes poses of the local map in the global map."""

    kind = "matcher"
    abstract = ("match",)

    def match(
        self, local: LocalMap, latest: Observation, omega_max: float, rng: Rng
    ) -> Hypotheses | MatchResult:
        """Hypotheses with a score of at least omega_max. The quality is Omega (eq. 4)."""
        raise NotImplementedError

    def restrict_to(self, gate: PoseGate) -> None:
        """Which poses count in match() from now on. All others are dropped after it anyway."""

    def rescore(self, found: Hypotheses, local: LocalMap) -> Hypotheses:
        """Judges poses that a verifier found by contact, as match() judges its own."""
        return found


class Clusterer(_Stage):
    """Groups hypotheses that mean the same robot pose."""

    kind = "clusterer"
    abstract = ("cluster",)

    def cluster(self, hypotheses: Hypotheses, rng: Rng) -> Any:
        """An integer for each hypothesis, the same for those of one cluster: N integers."""
        raise NotImplementedError


class Rater(_Stage):
    """Says how much each cluster deserves trust."""

    kind = "rater"
    abstract = ("rate",)

    def rate(self, clusters: Clusters, hypotheses: Hypotheses) -> Any:
        """r of each cluster, in [0, 1]: N numbers."""
        raise NotImplementedError


class ThresholdPolicy(_Remembering):
    """Says which score a hypothesis must reach."""

    kind = "threshold_policy"
    abstract = ("omega_max", "update")

    def omega_max(self) -> float:
        """In [0, 1]; changes only in update() and reset()."""
        raise NotImplementedError

    def update(self, hypotheses: Hypotheses) -> None:
        """Takes in the hypotheses of one step, perhaps none."""
        raise NotImplementedError


class VerdictRule(_Remembering):
    """Says whether the answer can be trusted."""

    kind = "verdict_rule"
    abstract = ("judge",)

    def judge(self, step: StepResult) -> Verdict:
        """Sees clusters and ratings, best first, and not the step's own verdict."""
        raise NotImplementedError

    def least_steps(self) -> int:
        """In which step of a trial it can declare a pose at the earliest, counted from 1."""
        return 1

    def refute(self, verification: Verification) -> None:
        """The pose that judge() has just declared has a rival, or lacks its certificate."""

    def withhold(self) -> None:
        """It is not told, for what the rule does not know of: the robot's set-up, or that it is off the map."""


class Verifier(_Remembering):
    """Looks on the whole map for rivals of a pose that is about to be declared."""

    kind = "verifier"
    abstract = ("verify",)

    def reset(self) -> None:
        """Forgets an answer that goes on: nothing is to be declared any more."""

    def verify(self, local: LocalMap, map_from_local: Pose, gate: PoseGate) -> Verification:
        """What speaks against the pose of a local map with points; poses that the gate does not allow are no rivals."""
        raise NotImplementedError


@dataclass(frozen=True)
class _Field:
    """A parameter as the core reads it: what param() says of it, then what its class does."""

    doc: str
    unit: str
    min: float
    max: float
    above: float
    choices: list[str]
    min_items: int
    max_items: int | None
    is_folder: bool
    name: str = ""
    type: str = ""
    default: Any = None
    required: bool = False


def param(
    default: Any = dataclasses.MISSING,
    doc: str = "",
    *,
    unit: str = "",
    min: float = -math.inf,
    max: float = math.inf,
    above: float = -math.inf,
    choices: Sequence[str] = (),
    min_items: int = 0,
    max_items: int | None = None,
    is_folder: bool = False,
) -> Any:
    """A field of a strategy's `Params`: its default (none: the file must give it), what it is for, and its bounds.

    unit: "m", "rad", "deg", "s"; empty for a plain number. min, max: inclusive; above: exclusive. choices: of a str.
    Bounds of a list hold for each number in it; min_items and max_items for its length.
    """
    facts = _Field(doc, unit, min, max, above, list(choices), min_items, max_items, is_folder)
    if isinstance(default, (list, dict, set)):
        copied = default
        return dataclasses.field(default_factory=lambda: type(copied)(copied), metadata={"glocal": facts})
    return dataclasses.field(default=default, metadata={"glocal": facts})


# Names that the core knows the types by.
_TYPES: dict[Any, str] = {bool: "bool", int: "int", float: "float", str: "str", pathlib.Path: "path"}
_LISTS: dict[Any, str] = {float: "floats", str: "strs", pathlib.Path: "paths"}


@dataclass(frozen=True)
class _Registered:
    """A strategy as the core reads it."""

    kind: str
    name: str
    doc: str
    motions: tuple[str, ...]
    fields: list[_Field]
    make: Callable[[dict[str, Any], Any], Any]
    make_params: Callable[..., Any] | None
    source: str  # the file that it is written in, or what it is called
    hash: str  # of that file, or of what it does


def _core_type(hint: Any) -> tuple[str, list[str]]:
    """The core's name of a type, and the choices that it leaves. Raises TypeError."""
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if hint in _TYPES:
        return _TYPES[hint], []
    if origin is Literal and all(isinstance(choice, str) for choice in arguments):
        return "str", list(arguments)
    if origin in (Union, types.UnionType) and set(arguments) == {float, type(None)}:
        return "float or None", []
    if origin in (list, collections.abc.Sequence) and arguments[0] in _LISTS:
        return _LISTS[arguments[0]], []
    raise TypeError(
        f"{hint} is no type of a parameter; there are bool, int, float, float | None, str, Literal of str, pathlib.Path "
        "and lists of float, str and pathlib.Path"
    )


def _field_of(field: dataclasses.Field[Any], hint: Any) -> _Field:
    facts: _Field | None = field.metadata.get("glocal")
    if facts is None or not facts.doc.strip():
        raise TypeError(f"the parameter '{field.name}' has no sentence that says what it is for; give it with glocal.param()")
    kind, choices = _core_type(hint)
    choices = facts.choices or choices
    default = field.default if field.default_factory is dataclasses.MISSING else field.default_factory()
    required = default is dataclasses.MISSING
    default = None if required else default
    if default is None and not required and kind != "float or None":
        raise TypeError(f"the default of the parameter '{field.name}', None, is no {kind}")
    for value in default if isinstance(default, (list, tuple)) else [default]:
        within = not isinstance(value, (int, float)) or (math.isfinite(value) and facts.min <= value <= facts.max and value > facts.above)
        if not within or (choices and isinstance(value, str) and value not in choices):
            raise TypeError(f"the default of the parameter '{field.name}', {value!r}, is none that a file may give")
    return dataclasses.replace(facts, name=field.name, type=kind, default=default, required=required, choices=choices)


def _fields_of(params: type | None) -> list[_Field]:
    if params is None:
        return []
    if not dataclasses.is_dataclass(params):
        raise TypeError(f"{params.__qualname__} must be a dataclass: its fields are the strategy's parameters")
    # Names of types that are written as text are those of the module, and of the class.
    hints = typing.get_type_hints(params, localns=vars(sys.modules[params.__module__]))
    return [_field_of(field, hints[field.name]) for field in dataclasses.fields(params)]


def _file_of(strategy: type) -> pathlib.Path | None:
    try:
        file = pathlib.Path(inspect.getfile(strategy)).resolve()
    except (TypeError, OSError):  # of a notebook, or typed in
        return None
    return file if file.is_file() else None


def _told(value: Any) -> str:
    """What a function does, with the values that it has in it; of others what they are."""
    function = getattr(value, "__func__", getattr(value, "fget", value))
    code = value if isinstance(value, types.CodeType) else getattr(function, "__code__", None)
    if code is not None:
        return repr((code.co_code, code.co_names, [_told(constant) for constant in code.co_consts]))
    return repr(sorted(value, key=repr)) if isinstance(value, frozenset) else repr(value)


def _hash_of(strategy: type, fields: list[_Field]) -> str:
    """Of its methods, its values and its parameters."""
    members = {name: _told(member) for name, member in vars(strategy).items() if callable(member) or not name.startswith("__")}
    return hashlib.sha256(repr((sorted(members.items()), fields)).encode()).hexdigest()


def _first_paragraph(text: str | None) -> str:
    paragraph = (text or "").strip().split("\n\n")[0]
    return " ".join(paragraph.split())


def _registered_as(name: str, strategy: type[_Strategy]) -> _Registered:
    if not getattr(strategy, "kind", None):
        raise TypeError(f"{strategy.__qualname__} must be a subclass of glocal.Matcher, glocal.Clusterer, ...")
    missing = [method for method in strategy.abstract if _is_abstract(strategy, method)]
    if missing:
        raise TypeError(f"{strategy.__qualname__} lacks the method {', '.join(missing)}() that each {strategy.kind} must have")
    if hasattr(strategy, "reset") and not issubclass(strategy, _Remembering):
        raise TypeError(f"{strategy.__qualname__} has reset(), which is never called: a {strategy.kind} keeps nothing of earlier steps")
    if not strategy.motions or not set(strategy.motions) <= set(_MOTIONS):
        raise TypeError(f"{strategy.__qualname__}.motions is {strategy.motions!r}; it must be a tuple of some of {_MOTIONS}")
    doc = _first_paragraph(strategy.__dict__.get("__doc__"))
    if not doc:
        raise TypeError(f"{strategy.__qualname__} needs a docstring: its first paragraph tells users what it does")
    params: type | None = getattr(strategy, "Params", None)
    fields = _fields_of(params)
    file = _file_of(strategy)

    def make_params(**values: Any) -> Any:
        paths = {f.name for f in fields if f.type in ("path", "paths")}
        for key in paths & values.keys():
            value = values[key]
            values[key] = [pathlib.Path(p) for p in value] if isinstance(value, list) else pathlib.Path(value)
        return params(**values) if params else None

    def make(values: dict[str, Any], setup: Any) -> Any:
        return strategy(make_params(**values), setup)

    return _Registered(
        kind=strategy.kind,
        name=name,
        doc=doc,
        motions=tuple(strategy.motions),
        fields=fields,
        make=make,
        make_params=make_params if hasattr(params, "__post_init__") else None,
        source=str(file or f"the {strategy.kind} '{name}'"),
        hash=hashlib.sha256(file.read_bytes()).hexdigest() if file else _hash_of(strategy, fields),
    )


def _is_abstract(strategy: type[_Strategy], method: str) -> bool:
    """Whether it has only the method of this file, which raises."""
    return bool(getattr(strategy, method).__module__ == __name__)


_registered: dict[tuple[str, str], _Registered] = {}
_plugin_files: list[str] = []
_of_plugin: dict[tuple[str, str], _Registered] | None = None  # while one is executed
_executed: dict[str, tuple[str, list[_Registered]]] = {}  # of each plugin file: its hash, and what it registered
_versions = itertools.count()
_version = next(_versions)

_S = TypeVar("_S", bound=type[_Strategy])


def register(name: str) -> Callable[[_S], _S]:
    """Makes a class a strategy of that name. Its kind is that of its base class.

    A class that is registered again, as a cell of a notebook does, takes the place of the one before. Experiments and
    localizers that are there keep what they had.
    """
    if not name.isidentifier():
        raise ValueError(f"'{name}' cannot be a strategy's name: letters, digits and underscores make one up")

    def decorate(strategy: _S) -> _S:
        entry = _registered_as(name, strategy)
        if _of_plugin is None:
            _take(lambda: _registered.update({(entry.kind, name): entry}))
        else:
            _of_plugin[entry.kind, name] = entry
        return strategy

    return decorate


def load_plugin(file: str | pathlib.Path) -> None:
    """Loads the strategies of a plugin, a shared object or a Python file, as the program's --plugin does.

    Results of runs name it, so that the program can load it again. A Python file that is loaded again is executed again
    if it has changed.
    """
    path = str(pathlib.Path(file).resolve())
    _take(lambda: None if path in _plugin_files else _plugin_files.append(path))


def _take(add: Callable[[], None]) -> None:
    """Adds something, if the core takes it."""
    global _version
    from glocal import _core

    before = dict(_registered), list(_plugin_files), _version
    add()
    _version = next(_versions)
    try:
        _core.list_strategies()
    except BaseException:  # Ctrl-C is one, too
        _registered.clear()
        _registered.update(before[0])
        _plugin_files[:] = before[1]
        _version = before[2]  # what the core has from then is still good, and no file is executed for it
        raise


# What the core asks for.


def version() -> int:
    """Another number each time that something is registered."""
    return _version


def registered() -> list[_Registered]:
    return list(_registered.values())


def plugin_files() -> list[str]:
    return list(_plugin_files)


def sources() -> list[tuple[str, str, str]]:
    """Of each registered class: its name, the file that it is written in or else what it is called, and the hash of that."""
    return [(entry.name, entry.source, entry.hash) for entry in _registered.values()]


def execute(file: str) -> list[_Registered]:
    """Runs a Python file, unless it has not changed since, and returns the strategies that it registers."""
    global _of_plugin
    digest = hashlib.sha256(pathlib.Path(file).read_bytes()).hexdigest()
    if file in _executed and _executed[file][0] == digest:
        # Modules that it imports would not register theirs again.
        return _executed[file][1]
    name = "glocal_plugin_" + pathlib.Path(file).stem
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"{file} is no Python file")
    module = importlib.util.module_from_spec(spec)
    before, _of_plugin = _of_plugin, {}
    sys.modules[name] = module  # dataclasses look up their types there
    try:
        spec.loader.exec_module(module)
        found = list(_of_plugin.values())
    finally:
        _of_plugin = before
    if not found:
        raise ImportError(f"{file} registers no strategy; decorate a class with @glocal.register(\"name\")")
    _executed[file] = digest, found
    return found
