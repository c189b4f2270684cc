"""Strategies in Python: each kind in an experiment, what of them is refused, and what the core says then."""
import hashlib
import json
import math
import os
import pathlib
import signal
import threading
import time
from dataclasses import dataclass
from typing import Literal, Optional

import numpy as np
import pytest

import glocal
from glocal import strategies


@pytest.fixture(autouse=True)
def forget():
    """Tests do not see each other's strategies."""
    before = dict(strategies._registered), list(strategies._plugin_files)
    yield
    strategies._registered.clear()
    strategies._registered.update(before[0])
    strategies._plugin_files[:] = before[1]
    strategies._version = next(strategies._versions)


def run(room, tmp_path, **changes):
    return glocal.Experiment.load(room).with_(**changes).run(tmp_path / "out", force=True)


def first_step(room, **changes):
    experiment = glocal.Experiment.load(room).with_(**changes)
    return experiment.localizer().step(experiment.load_samples()[0].observation)


def define(**members):
    return type("Made", (glocal.Clusterer,), {"__doc__": "Does something.", "cluster": lambda s, h, r: h, **members})


def numbers_of(table):
    """As text, in which NaN is NaN."""
    return repr({name: column.tolist() for name, column in table.items()})


# Each kind.


def test_a_clusterer(room, tmp_path):
    seen = []

    @glocal.register("one")
    class One(glocal.Clusterer):
        """Joins all."""

        def cluster(self, hypotheses, rng):
            seen.append((hypotheses.map_from_robot.copy(), hypotheses.heading, hypotheses.support.copy()))
            return np.zeros(len(hypotheses), int)

    steps = run(room, tmp_path, **{"localizer.clusterer": "one", "trials.every_scan": 1000}).step_table
    assert set(steps["clusters"]) == {1}
    # The mean pose of the only cluster, computed here (eq. 6).
    poses, headings, support = seen[-1]
    x, y = np.average(poses[:, :2], axis=0, weights=support)
    heading = math.atan2(np.average(np.sin(headings), weights=support), np.average(np.cos(headings), weights=support))
    last = steps.rows - 1
    if steps["verdict"][last] != "localized":
        found = steps["estimate.x"][last], steps["estimate.y"][last], steps["estimate.theta"][last]
        assert found == pytest.approx((x, y, heading))
    assert len(seen) == np.count_nonzero(steps["hypotheses"])


def test_labels_may_be_any_integers_and_clusters_have_the_members_they_name(room):
    @glocal.register("by_heading")
    class ByHeading(glocal.Clusterer):
        """Joins those that look the same way."""

        def cluster(self, hypotheses, rng):
            return np.where(hypotheses.heading > 0, 10**12, -5)

    step = first_step(room, **{"localizer.clusterer": "by_heading"})
    signs = [set(step.hypotheses.heading[cluster.members] > 0) for cluster in step.clusters]
    assert sorted(signs, key=list) == [{False}, {True}]
    assert sum(step.clusters.sizes) == len(step.hypotheses)


def test_a_rater(room, tmp_path):
    @glocal.register("by_size")
    class BySize(glocal.Rater):
        """Trusts large clusters."""

        def rate(self, clusters, hypotheses):
            sizes = clusters.sizes
            assert sum(sizes) == len(hypotheses)
            return sizes / sizes.max()

    step = first_step(room, **{"localizer.rater": "by_size"})
    sizes = step.clusters.sizes
    assert np.array_equal(step.ratings.r, sizes / sizes.max())
    assert np.allclose(step.ratings.r_normalised, sizes / sizes.sum())
    assert sizes.tolist() == sorted(sizes, reverse=True)


def test_a_threshold_policy(room, tmp_path):
    @glocal.register("rising")
    class Rising(glocal.ThresholdPolicy):
        """Asks for more from step to step."""

        @dataclass
        class Params:
            by: float = glocal.param(0.125, "How much more.", min=0, max=1)

        def reset(self):
            self.now = 0.25

        def omega_max(self):
            return self.now

        def update(self, hypotheses):
            assert all(hypotheses.score >= self.now)
            self.now = min(self.now + self.params.by, 0.75)

    steps = run(room, tmp_path, **{"localizer.threshold_policy.rising.by": 0.25}).step_table
    first = steps["step"] == 0
    assert set(steps["omega_max"][first]) == {0.25}
    assert set(steps["omega_max"][steps["step"] >= 2]) == {0.75}


def test_a_verdict_rule(room, tmp_path):
    @glocal.register("third_step")
    class ThirdStep(glocal.VerdictRule):
        """Declares the best cluster in the third step."""

        def reset(self):
            self.steps = 0

        def judge(self, step):
            self.steps += 1
            if self.steps < 3 or len(step.clusters) == 0:
                return glocal.Verdict("searching", why="too early", evidence={"steps": self.steps})
            best = step.clusters[0].map_from_robot
            return glocal.Verdict("localized", map_from_robot=best, why="three steps", estimate=best, confidence=0.5)

    # A doubt of the set-up would hold some declarations back.
    results = run(room, tmp_path, **{"localizer.verdict_rule": "third_step", "localizer.setup_check.enabled": False})
    assert set(results.trial_table["steps"]) == {3}
    assert set(results.trial_table["why"]) == {"three steps"}
    assert set(results.trial_table["confidence"]) == {0.5}
    assert results.step_table["evidence.steps"][0] == 1


def test_a_matcher_with_the_cores_contact(room, tmp_path):
    @glocal.register("random_poses")
    class RandomPoses(glocal.Matcher):
        """Tries poses on the path of the map's free cells."""

        @dataclass
        class Params:
            poses: int = glocal.param(4000, "How many.", min=1)

        def __init__(self, params, setup):
            super().__init__(params, setup)
            self.contact = glocal.contact_index(setup.map, setup.contact_epsilon)
            rows, columns = np.nonzero(setup.map.grid.cells == 1)
            self.free = (np.column_stack([columns, rows]) + 0.5) * setup.map.grid.resolution

        def match(self, local, latest, omega_max, rng):
            assert len(latest.hits) > 0 and local.ends[-1] == len(local.points)
            places = self.free[rng.below(len(self.free), size=self.params.poses)]
            headings = rng.uniform(-math.pi, math.pi, size=self.params.poses)
            robots = np.column_stack([places, headings])
            back = local.local_from_robot.inverse()
            poses = [glocal.Pose(*robot) * back for robot in robots]
            omega = self.contact.share(local.points, poses)
            good = np.flatnonzero(omega >= omega_max)
            found = glocal.Hypotheses([poses[i] for i in good], omega[good])
            return glocal.MatchResult(found, proposals=len(poses), points_tested=len(poses) * len(local.points))

    changes = {"localizer.matcher.random_poses.poses": 500, "localizer.threshold_policy": {"fixed": {"omega_max": 0.2}}}
    step = first_step(room, **changes)
    assert step.proposals == 500
    assert len(step.hypotheses) > 0
    assert step.hypotheses.quality.min() >= 0.2
    assert np.array_equal(step.hypotheses.map_from_local, first_step(room, **changes).hypotheses.map_from_local)


def test_a_local_mapper_that_trusts_odometry(room, tmp_path):
    @glocal.register("odometry_alone")
    class OdometryAlone(glocal.LocalMapper):
        """Puts scans where odometry has them."""

        def reset(self):
            self.points, self.ends, self.start = np.empty((0, 3)), [], None

        def add(self, observation):
            self.start = self.start or observation.odom_from_robot
            self.robot = self.start.inverse() * observation.odom_from_robot
            if not self.ends:
                self.robot = glocal.Pose()
            self.points = np.vstack([self.points, self.robot.transform(np.asarray(observation.hits))])
            self.ends.append(len(self.points))

        def map(self):
            return glocal.LocalMap(self.points, self.robot, self.ends)

    experiment = glocal.Experiment.load(room)
    ours = experiment.with_(**{"localizer.local_mapper": "odometry_alone"}).localizer()
    samples = experiment.load_samples()
    for sample in samples[:4]:
        step = ours.step(sample.observation)
    assert step.local_map_points == sum(len(sample.observation.hits) for sample in samples[:4])
    moved = samples[0].observation.odom_from_robot.inverse() * samples[3].observation.odom_from_robot
    assert step.local_from_robot.distance_to(moved) < 1e-9
    assert np.array_equal(ours.local_map.points.x[: len(samples[0].observation.hits)], samples[0].observation.hits.x)


def test_a_verifier_takes_back_what_has_a_rival(room, tmp_path):
    @glocal.register("doubter")
    class Doubter(glocal.Verifier):
        """Finds a rival two metres away."""

        def verify(self, local, map_from_local, gate):
            assert gate.is_open and gate.allows(map_from_local)
            rival = glocal.Pose(2, 0, 0) * map_from_local
            found = glocal.Hypotheses([rival], [1.0])
            return glocal.Verification(rivals=found, certificate=glocal.Certificate(0.9, 1.0, 0.1))

    results = run(room, tmp_path, **{"localizer.verifier": "doubter"})
    assert "right" not in results.trial_table["outcome"]
    assert "ambiguous" in results.step_table["verdict"]


def test_sources(room, tmp_path):
    drive = glocal.Experiment.load(room).load_samples()
    known = glocal.Experiment.load(room).load_map()

    @glocal.register("kept_map")
    class KeptMap(glocal.MapSource):
        """A map that is there already."""

        def load(self):
            return known

    @glocal.register("kept_drive")
    class KeptDrive(glocal.ObservationSource):
        """A drive that is there already."""

        @dataclass
        class Params:
            first: int = glocal.param(0, "Number of the first sample.", min=0)

        def __init__(self, params, setup):
            super().__init__(params, setup)
            self.samples = iter(drive[params.first :])

        def next(self):
            return next(self.samples, None)

    plain = run(room, tmp_path, **{"observations": "kept_drive", "map": "kept_map"}).trial_table
    wanted = run(room, tmp_path).trial_table
    assert numbers_of(plain) == numbers_of(wanted)
    assert run(room, tmp_path, **{"observations.kept_drive.first": 5}).trial_table["start.stamp"][0] == drive[5].observation.stamp


# Parameters.


def test_parameters_of_every_type_are_keys(room, tmp_path):
    (tmp_path / "list.txt").write_text("one")
    made = []

    @glocal.register("full")
    class Full(glocal.Clusterer):
        """Has a parameter of every type.

        And more to tell.
        """

        @dataclass
        class Params:
            file: pathlib.Path = glocal.param(doc="A file.")
            flag: bool = glocal.param(False, "A truth value.")
            count: int = glocal.param(3, "A whole number.", min=1)
            size: float = glocal.param(0.5, "A number.", unit="m", max=2)
            perhaps: Optional[float] = glocal.param(None, "A number, or not.")
            name: str = glocal.param("x", "A text.")
            mode: Literal["fast", "good"] = glocal.param("fast", "One of two.")
            sizes: list[float] = glocal.param([1.0, 2.0], "Numbers.", min=0, min_items=1, max_items=3)
            names: list[str] = glocal.param([], "Texts.")

        def __init__(self, params, setup):
            super().__init__(params, setup)
            made.append(params)

        def cluster(self, hypotheses, rng):
            return np.zeros(len(hypotheses), int)

    described = glocal.describe("full")
    for text in ["Has a parameter of every type.", "full (clusterer, from Python, experimental)", "count: whole number (>= 1), default 3", "(fast, good)", "A file."]:
        assert text in described
    assert "And more" not in described

    room.write_text(
        room.read_text()
        + "  clusterer:\n    full: {flag: true, count: 5, size: 1.5, perhaps: 2, name: y, mode: good,\n"
        + "           sizes: [4], names: [a, b], file: list.txt}\n"
    )
    experiment = glocal.Experiment.load(room)
    experiment.localizer()
    wanted = Full.Params(tmp_path / "list.txt", True, 5, 1.5, 2.0, "y", "good", [4.0], ["a", "b"])
    assert made == [wanted]
    assert isinstance(made[0].file, pathlib.Path)
    experiment.with_(**{"localizer.clusterer.full.perhaps": "auto"}).localizer()
    assert made[1].perhaps is None
    for path, value, rule in [("count", 0, "out of range"), ("size", 3, "out of range"), ("mode", "slow", "fast"),
                              ("sizes", [], "item"), ("cuont", 1, "did you mean 'count'"), ("file", "none.txt", "none.txt")]:
        with pytest.raises(glocal.ConfigError, match=rule):
            experiment.with_(**{f"localizer.clusterer.full.{path}": value})


def test_rules_that_span_parameters_are_faults_with_a_place(room):
    @dataclass
    class Range:
        low: float = glocal.param(0.0, "Low end.")
        high: float = glocal.param(1.0, "High end.")

        def __post_init__(self):
            if self.low >= self.high:
                raise ValueError("low must be less than high")

    glocal.register("ranged")(define(Params=Range))
    with pytest.raises(glocal.ConfigError, match="low must be less than high"):
        glocal.Experiment.load(room).with_(**{"localizer.clusterer.ranged.low": 2})
    glocal.Experiment.load(room).with_(**{"localizer.clusterer.ranged.low": -2})


def test_parameters_that_cannot_be_made_are_faults_with_a_place_and_defaults_need_not_be_any(room):
    @dataclass
    class Scale:
        side: float = glocal.param(doc="Side of a cell.")

        def __post_init__(self):
            self.per_m = 1.0 / self.side

    glocal.register("scaled")(define(Params=Scale))
    assert "Side of a cell." in glocal.describe("scaled")
    experiment = glocal.Experiment.load(room)
    with pytest.raises(glocal.ConfigError, match="scaled.side=0: localizer.clusterer.scaled: side: ZeroDivisionError: float division") as caught:
        experiment.with_(**{"localizer.clusterer.scaled.side": 0})
    assert "self.per_m = 1.0 / self.side" in caught.value.faults[0].message
    experiment.with_(**{"localizer.clusterer.scaled.side": 2})


@dataclass
class NoDoc:
    size: float = 1.0


@dataclass
class BadType:
    size: complex = glocal.param(1j, "No number of ours.")


@dataclass
class BadDefault:
    parts: int = glocal.param(0.5, "How many.")


@dataclass
class DefaultOutOfBounds:
    parts: int = glocal.param(0, "How many.", min=1)


@dataclass
class DefaultThatIsNone:
    parts: int = glocal.param(None, "How many.", min=1)


@dataclass
class DefaultThatIsNoNumber:
    sizes: list[float] = glocal.param([1.0, math.inf], "Of parts.", unit="m")


@dataclass
class DefaultThatIsNoChoice:
    mode: str = glocal.param("quick", "How.", choices=["fast", "good"])


@pytest.mark.parametrize(
    "made, error",
    [
        (lambda: define(__doc__=None), "docstring"),
        (lambda: define(Params=NoDoc), "size.*what it is for"),
        (lambda: define(Params=BadType), "no type of a parameter"),
        (lambda: define(Params=BadDefault), "default of the parameter 'parts', 0.5, is no int"),
        (lambda: define(Params=DefaultOutOfBounds), "default of the parameter 'parts', 0, is none that a file may give"),
        (lambda: define(Params=DefaultThatIsNone), "default of the parameter 'parts', None, is no int"),
        (lambda: define(Params=DefaultThatIsNoNumber), "default of the parameter 'sizes', inf, is none"),
        (lambda: define(Params=DefaultThatIsNoChoice), "default of the parameter 'mode', 'quick', is none"),
        (lambda: define(Params=int), "dataclass"),
        (lambda: define(motions=("planar", "freely")), r"motions is \('planar', 'freely'\); it must be a tuple of some of .*'free'"),
        (lambda: define(motions="planar"), "motions is 'planar'; it must be a tuple"),
        (lambda: define(motions=()), r"motions is \(\); it must be a tuple"),
        (lambda: type("Made", (glocal.Rater,), {"__doc__": "Lacks all."}), "lacks the method rate"),
        (lambda: type("Made", (), {"__doc__": "Is none."}), "subclass"),
        (lambda: define(reset=lambda self: None), r"reset\(\), which is never called: a clusterer keeps nothing of earlier steps"),
    ],
)
def test_classes_that_cannot_be_strategies_are_refused(made, error):
    with pytest.raises(TypeError, match=error):
        glocal.register("made")(made())
    assert "made" not in glocal.list_strategies("clusterer")


def test_a_name_must_be_one_and_free(room):
    with pytest.raises(ValueError, match="two words"):
        glocal.register("two words")
    with pytest.raises(Exception, match="dbscan.*already registered"):
        glocal.register("dbscan")(define())
    assert glocal.Experiment.load(room).name


def test_a_strategy_that_asks_the_localizer_it_works_for_is_told_so(room):
    class Asks(glocal.Clusterer):
        """Asks for what the localizer has."""

        def cluster(self, hypotheses, rng):
            return np.zeros(len(hypotheses)) if localizer.local_map else None

    glocal.register("asks")(Asks)
    experiment = glocal.Experiment.load(room).with_(**{"localizer.clusterer": "asks"})
    localizer = experiment.localizer()
    with pytest.raises(RuntimeError, match="cannot ask the localizer that it works for"):
        localizer.step(experiment.load_samples()[0].observation)
    assert len(localizer.local_map.points) > 0


def test_a_class_that_is_registered_again_takes_the_place(room):
    for n in (1, 2):
        glocal.register("parts")(define(cluster=lambda self, h, rng, n=n: np.arange(len(h)) % n))
        assert len(first_step(room, **{"localizer.clusterer": "parts"}).clusters) == n


# What goes wrong.


def failing(room, tmp_path, cluster):
    glocal.register("failing")(define(cluster=cluster))
    return run(room, tmp_path, **{"localizer.clusterer": "failing", "trials.every_scan": 1000})


def test_an_exception_fails_its_trial_with_the_traceback(room, tmp_path):
    def cluster(self, hypotheses, rng):
        return divided_by_zero(len(hypotheses))

    def divided_by_zero(n):
        return n / 0

    results = failing(room, tmp_path, cluster)
    assert results.summary()["trials"]["failed"] == 1
    why = results.trial_table["why"][0]
    assert why.startswith("clusterer 'failing' threw an exception in step 0: ZeroDivisionError: division by zero")
    assert "in divided_by_zero" in why and "return n / 0" in why


def test_ctrl_c_in_a_strategy_is_no_fault_of_it(room):
    @glocal.register("patient")
    class Patient(glocal.Clusterer):
        """Is interrupted once."""

        is_first = True

        def cluster(self, hypotheses, rng):
            if Patient.is_first:
                Patient.is_first = False
                os.kill(os.getpid(), signal.SIGINT)
                time.sleep(10)
            return np.zeros(len(hypotheses), int)

    experiment = glocal.Experiment.load(room).with_(**{"localizer.clusterer": "patient"})
    localizer, sample = experiment.localizer(), experiment.load_samples()[0]
    with pytest.raises(KeyboardInterrupt):
        localizer.step(sample.observation)
    localizer.reset()
    assert localizer.step(sample.observation).step == 0


def interrupted(*_, **__):
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(10)


def test_ctrl_c_while_a_strategy_is_made_is_no_fault_of_it(room):
    glocal.register("patient")(define(__init__=interrupted))
    experiment = glocal.Experiment.load(room).with_(**{"localizer.clusterer": "patient"})
    with pytest.raises(KeyboardInterrupt):
        experiment.localizer()


def test_ctrl_c_while_parameters_are_checked_is_no_fault_of_them(room):
    params = dataclass(type("Params", (), {"__annotations__": {"n": int}, "n": glocal.param(1, "A number."), "__post_init__": interrupted}))
    glocal.register("patient")(define(Params=params))
    with pytest.raises(KeyboardInterrupt):
        glocal.Experiment.load(room).with_(**{"localizer.clusterer": "patient"})


def test_ctrl_c_while_a_plugin_is_executed_is_no_fault_of_it(tmp_path):
    plugin = tmp_path / "patient.py"
    plugin.write_text("import os, signal, time\nos.kill(os.getpid(), signal.SIGINT)\ntime.sleep(10)\n")
    with pytest.raises(KeyboardInterrupt):
        glocal.load_plugin(plugin)
    assert "dbscan" in glocal.list_strategies("clusterer")
    assert str(plugin) not in strategies.plugin_files()


def test_a_return_that_is_forgotten_is_told(room, tmp_path):
    @glocal.register("asks_nothing")
    class AsksNothing(glocal.ThresholdPolicy):
        """Forgets to return its threshold."""

        def omega_max(self):
            pass

        def update(self, hypotheses):
            pass

    @glocal.register("at_some_time")
    class AtSomeTime(glocal.VerdictRule):
        """Forgets to return its number."""

        def judge(self, step):
            return glocal.Verdict("searching")

        def least_steps(self):
            pass

    why = run(room, tmp_path, **{"localizer.threshold_policy": "asks_nothing"}).trial_table["why"][0]
    assert "omega_max() returns a number, and not None" in why
    with pytest.raises(ValueError, match=r"least_steps\(\) returns the number of a step, and not None"):
        run(room, tmp_path, **{"localizer.verdict_rule": "at_some_time"})


@pytest.mark.parametrize(
    "answer, why",
    [
        (lambda h: np.zeros(len(h) + 1, int), "an integer for each of"),
        (lambda h: np.zeros(len(h)), "an integer for each of"),
        (lambda h: None, "an integer for each of"),
        (lambda h: "ab", "an integer for each of"),
    ],
)
def test_wrong_answers_fail_the_trial_and_say_what_is_wanted(room, tmp_path, answer, why):
    results = failing(room, tmp_path, lambda self, h, rng: answer(h))
    assert why in results.trial_table["why"][0]


def test_contracts_hold(room, tmp_path):
    @glocal.register("too_sure")
    class TooSure(glocal.Rater):
        """Rates above one."""

        def rate(self, clusters, hypotheses):
            return np.full(len(clusters), 1.5)

    why = run(room, tmp_path, **{"localizer.rater": "too_sure"}).trial_table["why"][0]
    assert why.startswith("rater 'too_sure' breaks its contract in step 0")


def test_an_exception_while_it_is_made_is_an_error_of_the_configuration(room, tmp_path):
    def init(self, params, setup):
        raise RuntimeError("no such model")

    glocal.register("failing")(define(__init__=init))
    with pytest.raises(glocal.ConfigError, match="clusterer 'failing' cannot be made: RuntimeError: no such model"):
        run(room, tmp_path, **{"localizer.clusterer": "failing"})
    assert not (tmp_path / "out").exists()


def test_what_was_lent_is_gone_after_the_call_and_arrays_of_it_stay(room, tmp_path):
    kept = []

    def cluster(self, hypotheses, rng):
        kept.append((hypotheses, hypotheses.quality, hypotheses.quality.copy()))
        return np.zeros(len(hypotheses), int)

    failing(room, tmp_path, cluster)
    assert len(kept) > 1
    for lent, column, copy in kept:
        assert np.array_equal(column, copy)
        with pytest.raises(RuntimeError, match="lent for a call that is over"):
            lent.quality


def test_a_thread_that_is_left_behind_sees_whole_values_or_an_error(room, tmp_path):
    experiment = glocal.Experiment.load(room)
    contact = glocal.contact_index(experiment.load_map(), 0.1)
    readers, wrong = [], []

    def read(local, points, share):
        try:
            while True:
                now = np.asarray(local.points)  # raises once the loan is over
                if not np.array_equal(now, points) or contact.share(local.points, [(0, 0, 0)]) != share:
                    wrong.append(now)
        except RuntimeError as over:
            assert "lent for a call that is over" in str(over)

    @glocal.register("leaving")
    class Leaving(glocal.Verifier):
        """Leaves a thread behind."""

        def verify(self, local, map_from_local, gate):
            points = np.asarray(local.points)
            readers.append(threading.Thread(target=read, args=(local, points, contact.share(points, [(0, 0, 0)]))))
            readers[-1].start()
            return glocal.Verification()

    experiment.with_(**{"localizer.verifier": "leaving"}).run(tmp_path / "out")
    for reader in readers:
        reader.join(60)
        assert not reader.is_alive()
    assert readers and not wrong


def test_a_setup_can_be_kept_and_does_nothing_once_the_work_is_over(room, tmp_path):
    kept = []

    @glocal.register("keeping")
    class Keeping(glocal.MapSource):
        """A wall, and the setup."""

        def load(self):
            self.setup.note_input(str(room))
            self.setup.note_input(room)
            kept.append(self.setup)
            return glocal.GlobalMap(np.column_stack([np.linspace(0, 9, 100), np.ones(100)]))

    glocal.Experiment.load(room).with_(map="keeping").load_map()
    for use in (lambda: kept[0].note_input("table.csv"), lambda: kept[0].warn("Too late.")):
        with pytest.raises(ValueError, match="its work is over"):
            use()


def test_parts_of_what_was_lent_are_gone_too(room, tmp_path):
    kept = []

    @glocal.register("keeper")
    class Keeper(glocal.VerdictRule):
        """Keeps what it should not."""

        def judge(self, step):
            kept.append((step, step.clusters, step.clusters[0] if len(step.clusters) else step.ratings))
            return glocal.Verdict("searching")

    run(room, tmp_path, **{"localizer.verdict_rule": "keeper", "trials.every_scan": 1000})
    for step, clusters, cluster in kept:
        for use in (lambda: step.step, lambda: len(clusters), lambda: len(cluster)):
            with pytest.raises(RuntimeError, match="lent"):
                use()


def test_trials_side_by_side_give_the_same_results(room, tmp_path):
    glocal.load_plugin(pathlib.Path(__file__).parent / "cells.py")
    experiment = glocal.Experiment.load(room).with_(**{"localizer.clusterer.cells.side": 0.3, "trials.every_scan": 3})
    one = experiment.run(tmp_path / "one").trial_table
    many = experiment.run(tmp_path / "many", jobs=4).trial_table
    assert numbers_of(one) == numbers_of(many)


# Plugin files.

CELLS = pathlib.Path(__file__).parent / "cells.py"


def test_a_plugin_file_is_named_by_results_and_read_again(room, tmp_path):
    glocal.load_plugin(CELLS)
    assert "(clusterer, from cells.py, experimental)" in glocal.describe("cells")
    results = run(room, tmp_path, **{"localizer.clusterer": "cells"})
    assert f'plugins: ["{CELLS}"]' in (results.folder / "effective.yaml").read_text()


def test_a_plugin_file_is_executed_once(room, tmp_path):
    plugin, executed = tmp_path / "cells.py", tmp_path / "executed"
    plugin.write_text(CELLS.read_text() + f"\nwith open({str(executed)!r}, 'a') as file:\n    file.write('.')\n")
    glocal.load_plugin(plugin)
    for _ in range(3):
        glocal.list_strategies()
        glocal.Experiment.load(room).with_(**{"localizer.clusterer": "cells"})
    assert executed.read_text() == "."


def test_a_plugin_file_is_executed_once_whatever_is_registered_and_whoever_names_it(room, tmp_path, monkeypatch):
    """Here it could not be executed again: its strategies are in a module that it imports."""
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "cells_of_a_module.py").write_text(CELLS.read_text())
    (tmp_path / "plugin.py").write_text("import cells_of_a_module\n")
    room.write_text("plugins: [plugin.py]\n" + room.read_text())
    for parts in (1, 2):
        glocal.register("parts")(define())
        glocal.Experiment.load(room).with_(**{"localizer.clusterer.cells.side": 0.1 * parts}).localizer()
    glocal.load_plugin(tmp_path / "plugin.py")
    glocal.register("others")(define())
    assert "from plugin.py" in glocal.describe("cells")


def test_a_plugin_file_that_cannot_be_loaded_again_leaves_what_it_was(room, tmp_path):
    plugin = tmp_path / "cells.py"
    plugin.write_text(CELLS.read_text())
    glocal.load_plugin(plugin)
    plugin.write_text("def (:\n")
    with pytest.raises(glocal.ConfigError, match="SyntaxError"):
        glocal.load_plugin(plugin)
    assert "cells" in glocal.list_strategies("clusterer")
    assert "Side of a cell" in glocal.describe("cells")
    glocal.Experiment.load(room).with_(**{"localizer.clusterer": "cells"}).localizer()
    plugin.write_text(CELLS.read_text())
    glocal.load_plugin(plugin)
    glocal.register("others")(define())


def test_a_plugin_file_that_changes_is_read_again_when_it_is_loaded_again(room, tmp_path):
    def text(r):
        return (
            "import glocal, numpy as np\n"
            "@glocal.register('edited')\n"
            "class Edited(glocal.Rater):\n"
            "    'Trusts all alike.'\n"
            f"    def rate(self, clusters, hypotheses):\n        return np.full(len(clusters), {r})\n"
        )

    def rating_and_hash():
        experiment = glocal.Experiment.load(room).with_(**{"localizer.rater": "edited"})
        step = experiment.localizer().step(experiment.load_samples()[0].observation)
        results = experiment.run(tmp_path / "out", force=True)
        inputs = json.loads((results.folder / "provenance.json").read_text())["inputs_sha256"]
        return step.ratings.r[0], inputs[str(plugin)]

    def hash_of(r):
        return hashlib.sha256(text(r).encode()).hexdigest()

    plugin = tmp_path / "edited.py"
    plugin.write_text(text(0.25))
    glocal.load_plugin(plugin)
    plugin.write_text(text(0.75))
    assert rating_and_hash() == (0.25, hash_of(0.25))
    glocal.load_plugin(plugin)
    assert rating_and_hash() == (0.75, hash_of(0.75))


def test_an_experiment_names_its_plugins_and_others_do_not(room, tmp_path):
    other = glocal.Experiment.load(room)
    (tmp_path / "cells.py").write_text(CELLS.read_text())
    room.write_text("plugins: [cells.py]\n" + room.read_text())
    experiment = glocal.Experiment.load(room).with_(**{"localizer.clusterer": "cells"})
    assert experiment.run(tmp_path / "out").summary()["complete"]
    assert "cells.py" in experiment.effective_yaml()
    assert "cells.py" not in other.run(tmp_path / "other").folder.joinpath("effective.yaml").read_text()
    assert "cells" not in glocal.list_strategies("clusterer")


TYPED_IN = """
import glocal, numpy as np
@glocal.register("typed")
class Typed(glocal.Clusterer):
    "Deals hypotheses out."
    def cluster(self, hypotheses, rng):
        return np.arange(len(hypotheses)) % {parts}
"""


def test_results_of_a_class_that_is_in_no_file_are_of_that_class(room, tmp_path, capfd):
    def run_with(parts):
        exec(TYPED_IN.format(parts=parts), {"__name__": "a_notebook"})
        experiment = glocal.Experiment.load(room).with_(variants={"grid": {"localizer.clusterer": ["typed"]}})
        return experiment.run(tmp_path / "out")

    first = run_with(2)
    inputs = json.loads(next(first.folder.rglob("provenance.json")).read_text())["inputs_sha256"]
    assert "the clusterer 'typed'" in inputs
    glocal.register("unused")(define())  # changes nothing
    run_with(2)
    with pytest.raises(glocal.ConfigError, match="another run: the clusterer 'typed' has changed since"):
        run_with(3)


@pytest.mark.parametrize(
    "text, error",
    [
        ("import glocal\n", "registers no strategy"),
        ("import no_such_module\n", "No module named 'no_such_module'"),
        ("def (:\n", "SyntaxError"),
    ],
)
def test_files_that_are_no_plugins_are_refused(tmp_path, text, error):
    (tmp_path / "wrong.py").write_text(text)
    with pytest.raises(glocal.ConfigError, match=error) as caught:
        glocal.load_plugin(tmp_path / "wrong.py")
    assert caught.value.faults[0].file.endswith("wrong.py")
    assert "dbscan" in glocal.list_strategies("clusterer")


def test_lists_know_kinds():
    with pytest.raises(ValueError, match="clusterer"):
        glocal.list_strategies("clusterers")
    with pytest.raises(ValueError, match="no_such"):
        glocal.describe("no_such")
