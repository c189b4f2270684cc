"""A particle filter for suites in the plane: particle_filter.py DIR POSES.csv [EVERY]

DIR is what `glocal leaderboard export SUITE --out DIR` has written. POSES.csv is for `glocal leaderboard import`. With EVERY only every n-th
start is tried; the others count as undecided. Nothing of glocal is needed here.
"""
import csv
import pathlib
import sys

import numpy as np

PARTICLES, BEAMS, REACH, SIGMA = 20_000, 40, 0.6, 0.15  # number, number, m, m


def read_map(folder):
    """Resolution, origin, distance of each cell to the next occupied one (m, at most REACH), and the free cells."""
    values = dict(line.split(": ", 1) for line in (folder / "map.yaml").read_text().splitlines())
    resolution, origin = float(values["resolution"]), np.array(values["origin"].strip("[]").split(","), float)[:2]
    _, size, _, pixels = (folder / "map.pgm").read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    cells = np.frombuffer(pixels, np.uint8).reshape(height, width)[::-1]  # the first row is the lowest
    far = np.where(cells == 0, 0.0, REACH)
    for _ in range(int(REACH / resolution)):  # one cell farther from each wall in every round
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            far = np.minimum(far, np.roll(far, step, axis) + resolution)
    return resolution, origin, far, np.argwhere(cells == 254)


def read_drive(folder):
    """Odometry as x, y, yaw, and the points of each scan in the robot's frame."""
    rows = [line.split() for line in (folder / "scans/odometry.tum").read_text().splitlines()]
    odometry = [(float(r[1]), float(r[2]), 2 * np.arctan2(float(r[6]), float(r[7]))) for r in rows]
    files = ((folder / f"scans/{r[0]}.pcd").read_bytes() for r in rows)
    return np.array(odometry), [np.frombuffer(f.split(b"DATA binary\n", 1)[1], np.float32).reshape(-1, 3)[:, :2] for f in files]


def localize(world, odometry, scans, rng):
    """Yields for each step where the robot is, and whether that is sure."""
    resolution, origin, far, free = world
    places = free[rng.integers(len(free), size=PARTICLES)]
    x, y = ((places[:, ::-1] + rng.random((PARTICLES, 2))) * resolution + origin).T
    yaw, sure = rng.uniform(-np.pi, np.pi, PARTICLES), 0
    for step, (pose, points) in enumerate(zip(odometry, scans)):
        if step:
            dx, dy, dyaw = pose - odometry[step - 1]
            c, s, way = np.cos(odometry[step - 1][2]), np.sin(odometry[step - 1][2]), np.hypot(dx, dy)
            ahead = c * dx + s * dy + rng.normal(0, 0.02 + 0.1 * way, PARTICLES)
            left = c * dy - s * dx + rng.normal(0, 0.02 + 0.1 * way, PARTICLES)
            x, y = x + np.cos(yaw) * ahead - np.sin(yaw) * left, y + np.sin(yaw) * ahead + np.cos(yaw) * left
            yaw = yaw + dyaw + rng.normal(0, 0.02 + 0.1 * abs(np.angle(np.exp(1j * dyaw))), PARTICLES)
        fit = np.zeros(PARTICLES)
        for px, py in points[:: max(1, len(points) // BEAMS)]:
            column = ((x + np.cos(yaw) * px - np.sin(yaw) * py - origin[0]) / resolution).astype(int)
            row = ((y + np.sin(yaw) * px + np.cos(yaw) * py - origin[1]) / resolution).astype(int)
            inside = (row >= 0) & (row < far.shape[0]) & (column >= 0) & (column < far.shape[1])
            fit += np.exp(-0.5 * (np.where(inside, far[row * inside, column * inside], REACH) / SIGMA) ** 2)
        weights = np.exp(0.3 * (fit - fit.max()))
        weights /= weights.sum()
        best = np.argmax(weights)
        near = (np.hypot(x - x[best], y - y[best]) < 0.5) & (np.cos(yaw - yaw[best]) > np.cos(np.radians(10)))
        share, mean_yaw = weights[near].sum(), np.angle((weights[near] * np.exp(1j * yaw[near])).sum())
        sure = sure + 1 if share > 0.9 else 0
        yield (weights[near] @ x[near]) / share, (weights[near] @ y[near]) / share, np.degrees(mean_yaw), int(sure >= 3)
        drawn = np.searchsorted(np.cumsum(weights), (np.arange(PARTICLES) + rng.random()) / PARTICLES).clip(max=PARTICLES - 1)
        x, y, yaw = x[drawn], y[drawn], yaw[drawn]


def main(folder, poses, every=1):
    folder, known = pathlib.Path(folder), {}
    with open(folder / "starts.csv") as starts, open(poses, "w", newline="") as out:
        table = csv.writer(out)
        table.writerow("case seed start step x y yaw_deg declared".split())
        for at in list(csv.DictReader(starts))[:: int(every)]:
            if at["folder"] not in known:
                known = {at["folder"]: (read_map(folder / at["folder"]), *read_drive(folder / at["folder"]))}
            world, odometry, scans = known[at["folder"]]
            first, last = int(at["scan"]), int(at["scan"]) + int(at["steps"])
            for step, pose in enumerate(localize(world, odometry[first:last], scans[first:last], np.random.default_rng(1))):
                table.writerow([at["case"], at["seed"], at["start"], step, *pose])
                if pose[-1]:
                    break


main(*sys.argv[1:])
