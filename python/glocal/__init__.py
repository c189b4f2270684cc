"""glocal finds out where a mobile robot is on a known map from range scans and odometry alone.

    results = glocal.Experiment.load("intel.yaml").with_(seed=2).run(jobs=2)
    print(results.summary())

docs/python.md tells the rest.
"""

from glocal import _core
from glocal._core import (
    Certificate,
    Cluster,
    Clusters,
    ContactIndex,
    GlobalMap,
    Hypotheses,
    LocalMap,
    MatchResult,
    Observation,
    OccupancyGrid,
    Points,
    Pose,
    PoseGate,
    Ratings,
    Rng,
    Sample,
    SourceSetup,
    StageSetup,
    StepResult,
    Verdict,
    Verification,
    contact_index,
    describe,
    list_strategies,
)
from glocal.errors import ConfigError, Fault, Interrupted, RunError, StrategyError
from glocal.experiments import Experiment, Localizer, TrialProgress
from glocal.results import Comparison, Results, Summary, Sweep, Table, compare, load_results
from glocal.strategies import (
    Clusterer,
    LocalMapper,
    MapSource,
    Matcher,
    ObservationSource,
    Rater,
    ThresholdPolicy,
    VerdictRule,
    Verifier,
    load_plugin,
    param,
    register,
)

__version__: str = _core.__version__

__all__ = [
    "Certificate",
    "Cluster",
    "Clusterer",
    "Clusters",
    "Comparison",
    "ConfigError",
    "ContactIndex",
    "Experiment",
    "Fault",
    "GlobalMap",
    "Hypotheses",
    "Interrupted",
    "LocalMap",
    "LocalMapper",
    "Localizer",
    "MapSource",
    "MatchResult",
    "Matcher",
    "Observation",
    "ObservationSource",
    "OccupancyGrid",
    "Points",
    "Pose",
    "PoseGate",
    "Rater",
    "Ratings",
    "Results",
    "Rng",
    "RunError",
    "Sample",
    "SourceSetup",
    "StageSetup",
    "StepResult",
    "StrategyError",
    "Summary",
    "Sweep",
    "Table",
    "ThresholdPolicy",
    "TrialProgress",
    "Verdict",
    "VerdictRule",
    "Verification",
    "Verifier",
    "compare",
    "contact_index",
    "describe",
    "list_strategies",
    "load_plugin",
    "load_results",
    "param",
    "register",
]
