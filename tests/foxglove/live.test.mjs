// A live localization as viewers get it, compared with what it writes down and with what it was made of.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { WebSocket, composed, planar, secondsOf, shownRun, view } from "./viewer.mjs";

const folder = mkdtempSync(join(tmpdir(), "glocal_foxglove_"));
after(() => rmSync(folder, { recursive: true }));
const file = (name) => join(folder, name);
const glocal = (...options) => execFileSync(process.env.GLOCAL_PROGRAM, options, { stdio: "ignore" });
const drive = (name) => [file("room/map.yaml"), "--recording", file("drive.mcap"), "--scans", "/scan", "--out", file(name)];

before(() => {
  writeFileSync(
    file("world.yaml"),
    "size: [12, 6]\nwalls:\n  - {points: [[0, 0], [12, 0], [12, 4], [7, 6], [0, 6]], closed: true}\n" +
      "  - {points: [[5, 0], [5, 2.4]]}\nfree_from: [[1, 1]]\nway_points: [[1, 3], [10, 3], [10, 1]]\n",
  );
  writeFileSync(
    file("room.yaml"),
    "schema: 1\nname: room\nmap:\n  simulation: {world: world.yaml, resolution: 0.05}\n" +
      "observations:\n  simulation: {world: world.yaml, laser: {fov_deg: 270}}\ntrials: {whole: true}\n",
  );
  glocal("simulate", file("room.yaml"), "--out", file("room"));
  glocal("convert", file("room/drive.log"), "-o", file("drive.mcap"));
});

/** Steps as they were told, without what differs from run to run. */
const toldIn = (name) =>
  readFileSync(file(`${name}.steps.jsonl`), "utf8")
    .trim()
    .split("\n")
    .map((line) => {
      const { stage_ms, stage_cpu_ms, ...step } = JSON.parse(line);
      return step;
    });

/** Ranges and odometry of the log's scans, by their stamps. */
function scansOf(log) {
  const lines = readFileSync(log, "utf8").split("\n").map((line) => line.split(" "));
  return new Map(
    lines
      .filter(([tag]) => tag === "ROBOTLASER1")
      .map((fields) => {
        const n = Number(fields[8]);
        const [x, y, theta] = fields.slice(n + 13, n + 16).map(Number);
        return [Number(fields[n + 21]), { ranges: fields.slice(9, n + 9).map(Number), maxRange: Number(fields[5]), robot: { x, y, theta } }];
      }),
  );
}

/** The map server's picture, from its lowest row on, as nav_msgs/OccupancyGrid has it. */
function gridOf(picture) {
  const bytes = readFileSync(picture);
  const head = /^P5\s+(?:#.*\s+)*(\d+)\s+(\d+)\s+255\s/.exec(bytes.toString("latin1"));
  const [width, height] = head.slice(1).map(Number);
  const meanings = new Map([[254, 0], [0, 100], [205, -1]]);
  const cells = [];
  for (let row = height - 1; row >= 0; --row) {
    for (let column = 0; column < width; ++column) cells.push(meanings.get(bytes[head[0].length + row * width + column]));
  }
  return { width, height, cells };
}

const assertNear = (pose, expected, tolerance = 1e-9) => {
  for (const key of ["x", "y"]) assert.ok(Math.abs(pose[key] - expected[key]) < tolerance, `${key}: ${pose[key]}, ${expected[key]}`);
  assert.ok(Math.abs(Math.sin((pose.theta - expected.theta) / 2)) < tolerance, `theta: ${pose.theta}, ${expected.theta}`);
};

test("viewers get what comes, what is told and the map, and change nothing", async () => {
  glocal("live", ...drive("alone"));
  const { ended, address } = await shownRun(...drive("shown"), "--real-time");
  const viewer = view(address);
  await viewer.until("/glocal/pose", 8);
  // Who comes late has what is kept at once.
  const late = view(address, "foxglove.sdk.v1");
  await Promise.all([late.until("/map"), late.until("/tf_static")]);
  assert.ok(!("/initialpose" in late.messages));
  late.client.close();

  assert.equal(await viewer.closed, 1001);
  assert.equal(await ended, 0);
  assert.deepEqual(viewer.statuses, []);
  assert.deepEqual(viewer.info.capabilities, []);
  const types = Object.fromEntries(viewer.channels.map(({ topic, schemaName }) => [topic, schemaName]));
  assert.deepEqual(types, {
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/initialpose": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "/glocal/pose": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "/glocal/candidates": "geometry_msgs/msg/PoseArray",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
  });

  // A step whose search goes on after its answer is told once more. The other run waits.
  const steps = toldIn("shown");
  assert.deepEqual(steps.filter(({ step }, i) => steps[i + 1]?.step !== step), toldIn("alone"));

  const expected = gridOf(file("room/map.pgm"));
  for (const [map, ...others] of [viewer.messages["/map"], late.messages["/map"]]) {
    assert.equal(others.length, 0);
    assert.equal(map.header.frame_id, "map");
    assert.equal(map.info.resolution, Math.fround(0.05));
    assertNear(planar(map.info.origin), { x: -0.025, y: -0.025, theta: 0 });
    assert.deepEqual([map.info.width, map.info.height], [expected.width, expected.height]);
    assert.deepEqual([...map.data], expected.cells);
  }
  assert.equal(late.messages["/tf_static"][0].transforms[0].child_frame_id, "laser");

  const log = scansOf(file("room/drive.log"));
  assert.ok(viewer.messages["/scan"].length > 10);
  for (const { header, ranges, range_max } of viewer.messages["/scan"]) {
    const scan = log.get(secondsOf(header.stamp));
    assert.equal(range_max, Math.fround(scan.maxRange));
    assert.deepEqual([...ranges], scan.ranges.map((range) => (range >= scan.maxRange ? Infinity : Math.fround(range))));
  }

  // The viewer may have missed what came before it; from then on it has all.
  const seen = (topic) => viewer.messages[topic].map(({ header }) => secondsOf(header.stamp));
  const stamps = steps.map(({ stamp }) => stamp);
  const first = stamps.indexOf(seen("/glocal/pose")[0]);
  assert.ok(first >= 0 && first < 8, `the first is of step ${first}`);
  const later = steps.slice(first);
  for (const topic of ["/glocal/pose", "/glocal/candidates", "/diagnostics"]) assert.deepEqual(seen(topic), stamps.slice(first));
  later.forEach((step, i) => {
    assertNear(planar(viewer.messages["/glocal/pose"][i].pose.pose), step.estimate);
    const [status] = viewer.messages["/diagnostics"][i].status;
    assert.equal(status.message, step.why);
    assert.equal(status.values.find(({ key }) => key === "verdict").value, step.verdict);
    assert.equal(status.level, step.verdict === "localized" ? 0 : 1);
  });

  // Without --tf, viewers alone get map to odom: where the robot is declared to be on the map.
  const declared = later.filter(({ verdict }) => verdict === "localized");
  assert.ok(declared.length > 5);
  const corrections = viewer.messages["/tf"].flatMap(({ transforms }) => transforms).filter(({ header }) => header.frame_id === "map");
  assert.deepEqual(corrections.map(({ header }) => secondsOf(header.stamp)), declared.map(({ stamp }) => stamp));
  corrections.forEach(({ child_frame_id, transform }, i) => {
    assert.equal(child_frame_id, "odom");
    assertNear(composed(planar(transform), log.get(declared[i].stamp).robot), declared[i].estimate, 1e-5);
  });

  for (const messages of Object.values(viewer.messages)) {
    messages.slice(1).forEach(({ time }, i) => assert.ok(time >= messages[i].time));
  }
});

test("candidates are those of the steps", async () => {
  glocal("simulate", join(process.env.GLOCAL_SOURCE_DIR, "configs/experiments/paper_symmetry.yaml"), "--out", file("corridor"));
  glocal("convert", file("corridor/drive.log"), "-o", file("corridor.mcap"));
  const { run, ended, address } = await shownRun(
    file("corridor/map.yaml"), "--recording", file("corridor.mcap"), "--scans", "/scan", "--real-time", "--out", file("symmetric"),
  );
  const viewer = view(address);
  await viewer.until("/glocal/candidates", 3);
  run.kill("SIGINT");
  assert.equal(await viewer.closed, 1001);
  assert.equal(await ended, 0);
  const byStamp = new Map(toldIn("symmetric").map((step) => [step.stamp, step]));
  for (const { header, poses } of viewer.messages["/glocal/candidates"]) {
    const { candidates } = byStamp.get(secondsOf(header.stamp));
    assert.ok(candidates.length > 1);
    assert.equal(poses.length, candidates.length);
    poses.forEach((pose, i) => assertNear(planar(pose), candidates[i]));
  }
});

test("rubbish is told, or closes the connection, and holds up nobody", async () => {
  const { run, ended, address } = await shownRun(...drive("rubbish"), "--real-time");
  const connection = async () => {
    const socket = new WebSocket(address, ["other", "foxglove.websocket.v1"]);
    const said = [];
    socket.on("message", (data, isBinary) => said.push(isBinary ? data : JSON.parse(data)));
    await once(socket, "open");
    return { socket, said };
  };

  const { socket, said } = await connection();
  assert.equal(socket.protocol, "foxglove.websocket.v1");
  const rubbish = [
    "", "x", "{", "[]", "null", "1", '"subscribe"', "{}", '{"op": 1}', '{"op": "advertise"}', '{"op": "\\u0000"}', "[".repeat(10_000),
    '{"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 999}]}',
    '{"op": "subscribe", "subscriptions": [1]}',
    '{"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 0}]}',
    '{"op": "subscribe", "subscriptions": [{"id": 1.5, "channelId": 0}]}',
    '{"op": "subscribe", "subscriptions": [{"id": 4294967296, "channelId": 0}]}',
    '{"op": "unsubscribe", "subscriptionIds": [5]}',
    '{"op": "unsubscribe", "subscriptionIds": ["5"]}',
    Buffer.from([1, 0, 0, 0, 0, 1]), Buffer.alloc(0),
  ];
  for (const text of rubbish) socket.send(text);
  // Lists that are none, or empty, ask for nothing.
  for (const list of ["{}", "1", "[]"]) socket.send(`{"op": "subscribe", "subscriptions": ${list}}`);
  const statuses = () => said.filter(({ op }) => op === "status");
  while (statuses().length < rubbish.length) await new Promise((resolve) => setTimeout(resolve, 10));
  await new Promise((resolve) => setTimeout(resolve, 200));
  assert.equal(statuses().length, rubbish.length);
  assert.ok(statuses().every(({ level, message }) => level === 2 && message.length > 10));
  assert.ok(said.every((message) => !Buffer.isBuffer(message)));

  for (const [message, code] of [["x".repeat(20_000), 1009], [Buffer.from([0xff]), 1007]]) {
    const { socket } = await connection();
    socket.send(message, { binary: false });
    assert.equal((await once(socket, "close"))[0], code);
  }

  const [error] = await once(new WebSocket(address, ["foxglove.websocket.v2"]), "error");
  assert.match(error.message, /no subprotocol/);
  assert.equal((await fetch(address.replace("ws:", "http:"))).status, 400);

  const viewer = view(address);
  await viewer.until("/glocal/pose");
  run.kill("SIGINT");
  assert.equal(await viewer.closed, 1001);
  assert.equal(await ended, 0);
});
