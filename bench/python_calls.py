"""Strategies that do nothing: what is left of a call's time is the way between C++ and Python."""
import numpy as np

import glocal

LABELS = np.zeros(1000, int)
RATINGS = np.ones(100)
NO_POSES = glocal.Hypotheses(np.empty((0, 3)), [])
SEARCHING = glocal.Verdict("searching")


@glocal.register("idle")
class IdleThreshold(glocal.ThresholdPolicy):
    """Asks for nothing."""

    def omega_max(self):
        return 0.0

    def update(self, hypotheses):
        pass


@glocal.register("idle")
class IdleMatcher(glocal.Matcher):
    """Finds nothing."""

    def match(self, local, latest, omega_max, rng):
        return NO_POSES


@glocal.register("idle")
class IdleClusterer(glocal.Clusterer):
    """Joins all."""

    def cluster(self, hypotheses, rng):
        return LABELS


@glocal.register("idle")
class IdleRater(glocal.Rater):
    """Rates all alike."""

    def rate(self, clusters, hypotheses):
        return RATINGS


@glocal.register("idle")
class IdleRule(glocal.VerdictRule):
    """Says nothing."""

    def judge(self, step):
        return SEARCHING
