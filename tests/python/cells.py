"""A plugin: what the tests load as users do."""
from dataclasses import dataclass

import numpy as np

import glocal


@glocal.register("cells")
class Cells(glocal.Clusterer):
    """Joins hypotheses whose robot poses lie in the same cell."""

    @dataclass
    class Params:
        side: float = glocal.param(0.5, "Side of a cell.", unit="m", above=0)
        angle_deg: float = glocal.param(10.0, "Angle of a cell.", unit="deg", above=0, max=360)

    def cluster(self, hypotheses, rng):
        place = hypotheses.map_from_robot[:, :2] / self.params.side
        turn = np.degrees(hypotheses.heading)[:, None] / self.params.angle_deg
        return np.unique(np.floor(np.hstack([place, turn])), axis=0, return_inverse=True)[1]
