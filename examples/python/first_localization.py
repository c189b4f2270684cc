# %% [markdown]
# # A first localization
#
# A robot wakes up in a laboratory. It has a map, a laser and odometry, and no idea where it is. This notebook lets it
# find out, step by step; then it lets glocal do the same for a whole drive.
#
# Each `# %%` begins a cell in VS Code, Spyder and Jupytext. As a script: `python3 first_localization.py`.

# %%
import os
import pathlib

import numpy as np

import glocal

ROOT = pathlib.Path(globals().get("__file__", "first_localization.py")).resolve().parents[2]
OUT = pathlib.Path(os.environ.get("GLOCAL_EXAMPLES_OUT", "results/python")) / "first_localization"

# %% [markdown]
# ## Map and drive
#
# An experiment is a YAML file. This one is simulated: it has desks that were moved since the map was made, and people
# who walk about. Maps, scans and hypotheses are numpy arrays, without a copy.

# %%
experiment = glocal.Experiment.load(ROOT / "configs/experiments/paper_lab.yaml")
map = experiment.load_map()
samples = experiment.load_samples()
hits = samples[0].observation.hits
print(map)
print(f"{len(samples)} observations; the first has {len(hits)} hits, up to {np.hypot(hits.x, hits.y).max():.1f} m away")

# %% [markdown]
# ## Step by step
#
# The localizer takes one observation after the other. Each step says what it thinks of the robot's place, and why. The
# reference pose of a sample is the truth, which the localizer never sees.

# %%
localizer = experiment.localizer(map)
for sample in samples:
    step = localizer.step(sample.observation)
    while step.goes_on:  # until the next scan comes: here the robot waits
        step = localizer.go_on()
    print(f"step {step.step}: {step.verdict.kind}: {step.verdict.why}")
    if step.verdict.kind == "localized":
        break

declared, reference = step.verdict.map_from_robot, sample.map_from_robot
turned = np.degrees(declared.rotation_to(reference))
print(f"declared {declared}, reference {reference}")
print(f"{100 * declared.distance_to(reference):.1f} cm and {turned:.2f} degrees apart")

# %% [markdown]
# What led to the verdict is there, too: proposed poses with their scores, best first, clusters of them, and how much
# each cluster deserves trust.

# %%
print(f"{len(step.hypotheses)} hypotheses in {len(step.clusters)} clusters, rated {np.round(step.ratings.r, 2)}")
print("the best three (x, y):", np.round(step.hypotheses.map_from_robot[:3, :2], 2).tolist())
print("their scores:", np.round(step.hypotheses.score[:3], 2).tolist())

# %% [markdown]
# ## Observations of your own
#
# An observation can come from anywhere: a driver, a bag, or numpy. Here a made-up laser looks along rays through the
# occupied cells of the map. The robot stands somewhere else now, and turns on the spot. Its odometry begins at 0.

# %%
ANGLES = np.radians(np.arange(-90.0, 91.0))  # a beam for each degree
MAX_RANGE = 15.0  # m


def ranges_at(map_from_robot):
    """What the laser would measure there, m."""
    grid = map.grid
    along = np.arange(0.0, MAX_RANGE, grid.resolution)
    points = np.column_stack([np.outer(np.cos(ANGLES), along).ravel(), np.outer(np.sin(ANGLES), along).ravel()])
    in_grid = (grid.map_from_grid.inverse() * map_from_robot).transform(points)[:, :2]
    column, row = np.floor(in_grid / grid.resolution).astype(int).T
    height, width = grid.cells.shape
    is_occupied = grid.cells[row.clip(0, height - 1), column.clip(0, width - 1)] == 2
    is_occupied = is_occupied.reshape(len(ANGLES), len(along))
    return np.where(is_occupied.any(axis=1), along[is_occupied.argmax(axis=1)], MAX_RANGE)


start = glocal.Pose(6.0, 5.6, 0.5)
localizer.reset()  # forgets the drive so far
for turn in np.radians(np.arange(0.0, 360.0, 10.0)):
    odom_from_robot = glocal.Pose(0.0, 0.0, turn)
    ranges = ranges_at(start * odom_from_robot)
    step = localizer.step(glocal.observation_from_ranges(ranges, ANGLES, MAX_RANGE, odom_from_robot))
    while step.goes_on:
        step = localizer.go_on()
    print(f"step {step.step}: {step.verdict.kind}: {step.verdict.why}")
    if step.verdict.kind == "localized":
        break

apart = step.verdict.map_from_robot.distance_to(start * odom_from_robot)
print(f"own observations: {step.verdict.map_from_robot}, {100 * apart:.1f} cm from the truth")

# %% [markdown]
# ## The whole drive
#
# `run()` does what `glocal run` does, with the same results on disk. They come back as tables; `results.steps` is a
# DataFrame where pandas is installed.

# %%
results = experiment.run(OUT / "run", force=True)
print(results.summary())
table = results.step_table
is_localized = table["verdict"] == "localized"
errors = table["translation_error_m"][is_localized]
print(f"localized in {len(errors)} of {table.rows} steps; largest error then {100 * errors.max():.1f} cm")

# %% [markdown]
# The step in which the pose was declared, on the map: what the robot had seen by then is black.

# %%
figure = results.plot_map()
figure.savefig(OUT / "map.png")
figure

# %% [markdown]
# And what changed from step to step: time, scores, errors, clusters. At the end the robot drives into a room that is
# not on the map: Ω′ falls to 0, and no pose is declared any more.

# %%
figure = results.plot_curves()
figure.savefig(OUT / "curves.png")
figure
