// Recordings of glocal read with MCAP's own library and Foxglove's decoder, and the other way.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";

const packages = createRequire(join(process.env.GLOCAL_MCAP_PACKAGES, "package.json"));
const { McapIndexedReader, McapStreamReader, McapWriter } = packages("@mcap/core");
const { parse } = packages("@foxglove/rosmsg");
const { MessageReader, MessageWriter } = packages("@foxglove/rosmsg2-serialization");
const { decompress } = packages("fzstd");

const folder = mkdtempSync(join(tmpdir(), "glocal_mcap_"));
after(() => rmSync(folder, { recursive: true }));
const file = (name) => join(folder, name);
const glocal = (...options) =>
  execFileSync(process.env.GLOCAL_PROGRAM, options, { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });

const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };
const seconds = ({ sec, nanosec }) => sec + nanosec / 1e9;

/** The scans of a CARMEN log that glocal wrote. */
function scansOf(log) {
  const lines = readFileSync(log, "utf8").trim().split("\n").map((line) => line.split(" "));
  return lines
    .filter(([tag]) => tag === "ROBOTLASER1")
    .map((fields) => {
      const n = Number(fields[8]);
      const numbers = fields.slice(9).map(Number);
      return {
        startAngle: Number(fields[2]),
        step: Number(fields[4]),
        maxRange: Number(fields[5]),
        ranges: numbers.slice(0, n),
        robot: numbers.slice(n + 4, n + 7),
        stamp: numbers[n + 12],
      };
    });
}

async function messagesOf(mcap) {
  const bytes = new Uint8Array(readFileSync(mcap));
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.slice(Number(offset), Number(offset + length)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const decoders = new Map();
  const byTopic = {};
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    if (!decoders.has(channel.id)) {
      const schema = reader.schemasById.get(channel.schemaId);
      assert.equal(schema.encoding, "ros2msg");
      decoders.set(channel.id, new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true })));
    }
    (byTopic[channel.topic] ??= []).push(decoders.get(channel.id).readMessage(message.data));
  }
  return { reader, byTopic };
}

test("what glocal writes is read by others", async () => {
  const experiment = join(process.env.GLOCAL_SOURCE_DIR, "configs/experiments/paper_lab.yaml");
  glocal("simulate", experiment, "--out", file("lab"));
  glocal("convert", file("lab/drive.log"), "-o", file("drive.mcap"));
  const scans = scansOf(file("lab/drive.log"));
  assert.ok(scans.length > 100);

  const { reader, byTopic } = await messagesOf(file("drive.mcap"));
  assert.deepEqual(Object.keys(byTopic).sort(), ["/reference", "/scan", "/tf", "/tf_static"]);
  assert.equal(reader.statistics.messageCount, BigInt(3 * scans.length + 1));
  assert.equal(byTopic["/scan"].length, scans.length);
  scans.forEach((scan, i) => {
    const message = byTopic["/scan"][i];
    assert.equal(message.header.frame_id, "laser");
    assert.ok(Math.abs(seconds(message.header.stamp) - scan.stamp) < 1e-6);
    assert.equal(message.range_max, Math.fround(scan.maxRange));
    assert.equal(message.angle_min, Math.fround(scan.startAngle));
    assert.equal(message.angle_increment, Math.fround(scan.step));
    const ranges = scan.ranges.map((range) => (range >= scan.maxRange ? Infinity : Math.fround(range)));
    assert.deepEqual([...message.ranges], ranges);
    const { transform, child_frame_id } = byTopic["/tf"][i].transforms[0];
    assert.equal(child_frame_id, "base_link");
    assert.ok(Math.abs(transform.translation.x - scan.robot[0]) < 1e-9);
    assert.ok(Math.abs(2 * Math.atan2(transform.rotation.z, transform.rotation.w) - scan.robot[2]) % (2 * Math.PI) < 1e-9);
  });

  const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  stream.append(readFileSync(file("drive.mcap")));
  while (stream.nextRecord()) continue;
  assert.ok(stream.done(), "the whole file, with right checksums");
});

test("what others write is read by glocal", async () => {
  glocal("simulate", join(process.env.GLOCAL_SOURCE_DIR, "configs/experiments/paper_lab.yaml"), "--out", file("other"));
  glocal("convert", file("other/drive.log"), "-o", file("definitions.mcap"));
  const { reader } = await messagesOf(file("definitions.mcap"));
  const written = [];
  const writer = new McapWriter({
    writable: { position: () => BigInt(written.length), write: async (bytes) => void written.push(...bytes) },
    chunkSize: 500,
  });
  await writer.start({ profile: "ros2", library: "test" });
  const channels = {};
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    channels[channel.topic] = {
      encoder: new MessageWriter(parse(new TextDecoder().decode(schema.data), { ros2: true })),
      id: await writer.registerChannel({
        topic: channel.topic,
        messageEncoding: "cdr",
        metadata: new Map(),
        schemaId: await writer.registerSchema(schema),
      }),
    };
  }
  const send = async (topic, sec, message) => {
    const time = BigInt(sec) * 1_000_000_000n;
    const { id, encoder } = channels[topic];
    const data = encoder.writeMessage(message);
    await writer.addMessage({ channelId: id, sequence: 0, logTime: time, publishTime: time, data });
  };
  const transform = (sec, parent, child, x) => ({
    header: { stamp: { sec, nanosec: 0 }, frame_id: parent },
    child_frame_id: child,
    transform: { translation: { x, y: 0, z: 0 }, rotation: { x: 0, y: 0, z: 0, w: 1 } },
  });
  await send("/tf_static", 10, { transforms: [transform(10, "base_link", "laser", 0.25)] });
  for (let i = 0; i < 20; ++i) {
    await send("/tf", 10 + i, { transforms: [transform(10 + i, "odom", "base_link", 0.5 * i)] });
    await send("/scan", 10 + i, {
      header: { stamp: { sec: 10 + i, nanosec: 0 }, frame_id: "laser" },
      angle_min: -0.5, angle_max: 0.5, angle_increment: 0.5, time_increment: 0, scan_time: 0,
      range_min: 0.25, range_max: 10, ranges: [1 + i, Infinity, 2.5], intensities: [],
    });
  }
  await writer.end();
  writeFileSync(file("theirs.mcap"), new Uint8Array(written));

  glocal("convert", file("theirs.mcap"), "-o", file("theirs.log"));
  const scans = scansOf(file("theirs.log"));
  assert.equal(scans.length, 20);
  scans.forEach((scan, i) => {
    assert.deepEqual(scan.ranges, [Math.min(1 + i, 10), 10, 2.5]);
    assert.deepEqual(scan.robot, [0.5 * i, 0, 0]);
    assert.equal(scan.stamp, 10 + i);
    assert.equal(scan.startAngle, -0.5);
  });
});
