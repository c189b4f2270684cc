"""Values of the core as Python sees them: numbers by hand, and the memory that they lie in."""
import gc
import math
import resource

import numpy as np
import pytest

import glocal


# Poses.


def test_a_pose_in_the_plane_moves_points():
    pose = glocal.Pose(1.0, 2.0, math.pi / 2)
    assert np.allclose(pose.transform([[1, 0], [0, 1]]), [[1, 3, 0], [0, 2, 0]], atol=1e-6)
    assert np.allclose(pose.matrix() @ [1, 0, 0, 1], [1, 3, 0, 1])
    assert pose.is_planar
    assert pose.heading == pytest.approx(math.pi / 2)


def test_poses_multiply_as_their_matrices_do():
    a = glocal.Pose([1, 2, 3, 0.5, 0.5, 0.5, 0.5])
    b = glocal.Pose(-1.0, 0.25, 2.0)
    assert np.allclose((a * b).matrix(), a.matrix() @ b.matrix())
    assert np.allclose((a * a.inverse()).matrix(), np.eye(4))
    assert not a.is_planar
    assert glocal.Pose(a.matrix()).rotation_to(a) == pytest.approx(0, abs=1e-7)


def test_equal_poses_are_equal_and_hash_alike():
    assert glocal.Pose(1, 2, 0.5) == glocal.Pose(1, 2, 0.5)
    assert hash(glocal.Pose(1, 2, 0.5)) == hash(glocal.Pose(1, 2, 0.5))
    assert glocal.Pose(1, 2, 0.5) != glocal.Pose(1, 2, 0.6)
    assert glocal.Pose(1, 2, 0.5) != "a pose"


@pytest.mark.parametrize("wrong", [[1, 2], [[1, 2], [3, 4]], "here", [1, 2, 3, 1, 1, 0, 0], [0, 0, 0, math.nan, 0, 0, 0],
                                   np.diag([2.0, 2, 2, 1]), np.diag([1.0, -1, 1, 1]), np.zeros((4, 4)), np.diag([1.0, 1, 1, 2])])
def test_what_is_no_pose_is_refused(wrong):
    with pytest.raises(ValueError, match="pose"):
        glocal.Pose(wrong)


# Points.


def address(array):
    return array.__array_interface__["data"][0]


def test_points_are_views_of_one_memory():
    points = glocal.Points(np.arange(12, dtype=np.float32).reshape(4, 3))
    assert address(points.x) == address(points.x)
    assert points.x.base is not None and not points.x.flags.owndata
    assert points.y.tolist() == [1, 4, 7, 10]
    assert np.asarray(points).tolist() == np.arange(12).reshape(4, 3).tolist()
    assert len(points) == 4


def test_points_become_arrays_as_copies_alone():
    points = glocal.Points([[1, 2], [3, 4]])
    assert np.array(points, dtype=np.float64).tolist() == [[1, 2, 0], [3, 4, 0]]
    # As NumPy 2 asks for them.
    assert points.__array__(copy=True).tolist() == points.__array__(copy=None).tolist() == [[1, 2, 0], [3, 4, 0]]
    assert points.__array__(np.dtype(np.float64), copy=True).dtype == np.float64
    with pytest.raises(ValueError, match="only as a copy"):
        points.__array__(copy=False)


def test_a_view_keeps_its_memory():
    x = glocal.Points([[float(i), 0.0] for i in range(10000)]).x
    gc.collect()
    assert glocal.Points(np.full((10000, 2), -1.0)).x[0] == -1  # might take the memory over
    assert np.array_equal(x, np.arange(10000, dtype=np.float32))


def test_views_cannot_be_written_to():
    points = glocal.Points([[1, 2]])
    with pytest.raises(ValueError, match="read-only"):
        points.x[0] = 3
    with pytest.raises(ValueError):
        points.x.setflags(write=True)


def test_points_in_the_plane_have_no_height():
    assert glocal.Points([[1, 2], [3, 4]]).z.tolist() == [0, 0]
    assert len(glocal.Points(np.empty((0, 3)))) == 0


@pytest.mark.parametrize("wrong", [[1, 2, 3], [[1]], [[1, 2, 3, 4]], "points"])
def test_what_are_no_points_is_refused(wrong):
    with pytest.raises(ValueError, match="points"):
        glocal.Points(wrong)


# Maps.


def small_map():
    cells = np.ones((3, 4), np.uint8)
    cells[0, 1] = 2
    cells[2, 3] = 2
    cells[1, 0] = 0
    return glocal.GlobalMap(grid=glocal.OccupancyGrid(cells, 0.5, (10.0, 20.0, 0.0))), cells


def test_a_map_of_a_grid_has_points_at_the_centres_of_occupied_cells():
    made, cells = small_map()
    assert np.asarray(made.points).tolist() == [[10.75, 20.25, 0], [11.75, 21.25, 0]]
    assert made.resolution == 0.5
    assert np.array_equal(made.grid.cells, cells)
    assert made.grid.map_from_grid == glocal.Pose(10, 20, 0)


@pytest.mark.parametrize("wrong", [np.full((2, 2), 257), np.full((2, 2), -1), np.full((2, 2), 0.9)])
def test_cells_that_are_no_cells_are_refused(wrong):
    with pytest.raises(ValueError, match="cell"):
        glocal.OccupancyGrid(wrong, 0.5)


def test_points_of_a_map_are_views_that_keep_it():
    made, _ = small_map()
    x = made.points.x
    assert address(made.points.x) == address(x)
    del made
    gc.collect()
    assert x.tolist() == [10.75, 11.75]


def test_cells_of_a_map_are_a_copy_that_nobody_takes_for_the_map():
    made, cells = small_map()
    assert np.array_equal(made.grid.cells, cells)
    with pytest.raises(ValueError, match="read-only"):
        made.grid.cells[0, 0] = 1


def test_the_path_of_a_map_has_its_poses():
    path = [glocal.Pose(1, 2, math.pi), glocal.Pose([3, 4, 5, 0.5, 0.5, 0.5, 0.5])]
    made = glocal.GlobalMap([[0, 0]], path=path, resolution=0.1)
    assert made.path.shape == (2, 7)
    assert np.allclose(made.path, [[1, 2, 0, 0, 0, 0, 1], [3, 4, 5, 0.5, 0.5, 0.5, 0.5]])


def test_a_map_far_away_has_an_origin():
    made = glocal.GlobalMap([[1, 2]], resolution=0.1, origin=(500000, 4649776.5, 0))
    assert made.origin == (500000, 4649776.5, 0)
    assert np.asarray(made.points).tolist() == [[1, 2, 0]]
    assert small_map()[0].origin == (0, 0, 0)
    with pytest.raises(ValueError, match="x, y and z .m. of the map's origin are wanted"):
        glocal.GlobalMap([[1, 2]], origin=(500000, 4649776.5))


def test_a_map_needs_points():
    with pytest.raises(ValueError, match="without any point"):
        glocal.GlobalMap(grid=glocal.OccupancyGrid(np.ones((2, 2)), 0.1))
    with pytest.raises(ValueError, match="0 .unknown., 1 .free. or 2"):
        glocal.OccupancyGrid(np.full((2, 2), 7), 0.1)


@pytest.mark.parametrize(
    "values, why",
    [
        ({"points": [[0, 0], [math.nan, 0], [1, 1]]}, "a value of the points is not finite"),
        ({"points": [[0, 0], [0, math.inf]]}, "a value of the points is not finite"),
        ({"points": [[0, 0]], "normals": [[math.nan, 0]]}, "a value of the normals is not finite"),
        ({"points": [[0, 0]], "path": [(math.nan, 0, 0)]}, "pose 0 of the path"),
        ({"points": [[0, 0]], "origin": (0, math.nan, 0)}, "the origin is not finite"),
        ({"points": [[0, 0]], "resolution": math.inf}, "the resolution is inf m"),
        ({"grid": glocal.OccupancyGrid(np.full((2, 2), 2), 0.1, (math.nan, 0, 0)), "points": [[0, 0]]}, "the grid"),
    ],
)
def test_numbers_that_are_none_make_no_map(values, why):
    with pytest.raises(ValueError, match="cannot be a map: " + why):
        glocal.GlobalMap(**values)


def test_a_map_may_be_far_away_without_an_origin():
    assert np.asarray(glocal.GlobalMap([[500_000, 1]], resolution=0.05).points).tolist() == [[500_000, 1, 0]]


def test_a_million_accesses_leave_no_memory_behind():
    """A single copy of the map that somebody kept would show: it has 4 MB."""
    made = glocal.GlobalMap(np.random.default_rng(1).random((333_333, 3)))
    hypotheses = glocal.Hypotheses(np.zeros((1000, 3)), np.linspace(0, 1, 1000))

    def access(times):
        for _ in range(times):
            made.points.x
            hypotheses.quality

    access(1000)
    before = resident()
    access(500_000)
    assert resident() - before < 4e6


def resident():
    with open("/proc/self/statm") as numbers:
        return int(numbers.read().split()[1]) * resource.getpagesize()


# Observations.


def test_an_observation_keeps_what_it_was_made_of():
    observation = glocal.Observation([[1, 2], [3, 4]], (1, 2, 0.5), stamp=7.0, free_ends=[[5, 6]], origin=(0.1, 0, 0.3), times=[0, 0.1])
    assert np.asarray(observation.hits).tolist() == [[1, 2, 0], [3, 4, 0]]
    assert np.asarray(observation.free_ends).tolist() == [[5, 6, 0]]
    assert observation.origin == pytest.approx((0.1, 0, 0.3))
    assert observation.times.tolist() == pytest.approx([0, 0.1])
    assert (observation.stamp, observation.odom_from_robot) == (7.0, glocal.Pose(1, 2, 0.5))
    with pytest.raises(ValueError, match="2 hits"):
        glocal.Observation([[1, 2], [3, 4]], (0, 0, 0), times=[1])


def test_ranges_become_hits_and_free_ends():
    ranges, angles = [2.0, 9.0, math.nan, 0.0, 1.0], [0, math.pi / 2, 0, 0, math.pi]
    observation = glocal.observation_from_ranges(ranges, angles, 8.0, (0, 0, 0), robot_from_laser=(0.5, 0, 0))
    assert np.allclose(np.asarray(observation.hits), [[2.5, 0, 0], [-0.5, 0, 0]], atol=1e-6)
    assert np.allclose(np.asarray(observation.free_ends), [[0.5, 8, 0]], atol=1e-6)
    assert observation.origin == (0.5, 0, 0)
    with pytest.raises(ValueError, match="angle"):
        glocal.observation_from_ranges(ranges, angles[:2], 8.0, (0, 0, 0))


# Hypotheses.


def test_hypotheses_are_sorted_and_seen_as_columns():
    h = glocal.Hypotheses([[0, 0, 0], [1, 2, 0], [3, 4, math.pi]], [0.2, 0.9, 0.5], support=[1, 2, 3])
    assert h.quality.tolist() == h.score.tolist() == [0.9, 0.5, 0.2]
    assert h.support.tolist() == [2, 3, 1]
    assert np.allclose(h.map_from_local[1], [3, 4, 0, 0, 0, 0, 1], atol=1e-12)
    assert address(h.quality) == address(h.quality)
    assert h.quality.strides == h.score.strides  # members of one struct
    with pytest.raises(ValueError, match="quality"):
        glocal.Hypotheses([[0, 0, 0]], [0.1, 0.2])
    for proposals in (0, 1.5, math.inf, math.nan):
        with pytest.raises(ValueError, match="whole number"):
            glocal.Hypotheses([[0, 0, 0]], [0.1], support=[proposals])


def test_no_hypotheses_are_columns_without_rows():
    h = glocal.Hypotheses(np.empty((0, 3)), [])
    assert h.map_from_local.shape == (0, 7)
    assert h.quality.shape == (0,)


# Contact, against distances computed here.


def test_contact_is_the_share_of_points_near_the_map():
    rng = np.random.default_rng(7)
    points = rng.random((400, 2)) * 10
    local = rng.random((200, 2)) * 4
    index = glocal.contact_index(glocal.GlobalMap(points, resolution=0.1), 0.3, "kd_tree")
    poses = np.column_stack([rng.random((5, 2)) * 6, rng.random(5)])
    shares = index.share(glocal.Points(local), poses)
    for (x, y, heading), share in zip(poses, shares):
        turn = np.array([[math.cos(heading), -math.sin(heading)], [math.sin(heading), math.cos(heading)]])
        moved = local @ turn.T + (x, y)
        nearest = np.linalg.norm(moved[:, None] - points[None], axis=2).min(axis=1)
        assert share == pytest.approx(np.mean(nearest <= 0.3), abs=0.006)  # single precision at the rim
    assert np.array_equal(shares, index.share(local, poses))
    with pytest.raises(ValueError, match="kd_tree"):
        glocal.contact_index(glocal.GlobalMap(points), 0.3, "octree")


# Random numbers.


def test_random_numbers_are_those_of_the_core():
    a, b = glocal.Rng(5), glocal.Rng(5)
    assert [a.uniform() for _ in range(3)] == b.uniform(size=3).tolist()
    assert 0 <= a.below(7) < 7
    assert set(glocal.Rng(1).below(3, size=100)) == {0, 1, 2}
    assert abs(glocal.Rng(2).normal(2.0, size=20000).std() - 2.0) < 0.05
    assert glocal.Rng(5).stream(1).next() == glocal.Rng(5).stream(1).next() != glocal.Rng(5).stream(2).next()
    # SplitMix64 with seed 0 (Vigna's reference implementation).
    assert glocal.Rng(0).next() == 0xE220A8397B1DCDAF
    with pytest.raises(ValueError):
        glocal.Rng(1).below(0)
