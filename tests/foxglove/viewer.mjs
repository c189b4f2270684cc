// Viewers of a live localization, with Foxglove's own client and decoder.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createRequire } from "node:module";
import { createInterface } from "node:readline";

const packages = createRequire(`${process.env.GLOCAL_FOXGLOVE_PACKAGES}/package.json`);
const { FoxgloveClient } = packages("@foxglove/ws-protocol");
const { parse } = packages("@foxglove/rosmsg");
const { MessageReader } = packages("@foxglove/rosmsg2-serialization");
export const WebSocket = packages("ws");

/** Starts glocal live for viewers; where they connect, and its exit code when it has ended. */
export async function shownRun(...options) {
  const run = spawn(process.env.GLOCAL_PROGRAM, ["live", ...options, "--foxglove", "--port", "0"], {
    stdio: ["ignore", "ignore", "pipe"],
  });
  const ended = new Promise((resolve) => run.on("exit", resolve));
  let said = "";
  for await (const line of createInterface({ input: run.stderr })) {
    said += `${line}\n`;
    const address = /ws:\/\/127\.0\.0\.1:\d+/.exec(line);
    if (address) {
      run.stderr.resume();
      return { run, ended, address: address[0] };
    }
  }
  throw new Error(`glocal told no address: ${said}`);
}

/** A viewer that subscribes to all that there is. `messages` are those of each topic, decoded, with the time of their receipt. */
export function view(address, protocol = FoxgloveClient.SUPPORTED_SUBPROTOCOL) {
  const client = new FoxgloveClient({ ws: new WebSocket(address, [protocol]) });
  const viewer = { client, info: null, channels: [], messages: {}, statuses: [], news: 0 };
  const decoders = new Map();
  viewer.closed = new Promise((resolve) => client.on("close", (event) => resolve(event.code)));
  client.on("serverInfo", (info) => (viewer.info = info));
  client.on("status", (status) => viewer.statuses.push(status));
  client.on("advertise", (channels) => {
    for (const channel of channels) {
      assert.equal(channel.encoding, "cdr");
      assert.equal(channel.schemaEncoding, "ros2msg");
      viewer.channels.push(channel);
      const reader = new MessageReader(parse(channel.schema, { ros2: true }));
      decoders.set(client.subscribe(channel.id), { topic: channel.topic, reader });
    }
  });
  client.on("message", ({ subscriptionId, timestamp, data }) => {
    const { topic, reader } = decoders.get(subscriptionId);
    // The decoder's arrays lie in the message, which the client may use again.
    (viewer.messages[topic] ??= []).push({ time: timestamp, ...structuredClone(reader.readMessage(data)) });
  });
  viewer.until = async (topic, n = 1) => {
    while ((viewer.messages[topic]?.length ?? 0) < n) await new Promise((resolve) => setTimeout(resolve, 20));
  };
  return viewer;
}

export const secondsOf = ({ sec, nanosec }) => sec + nanosec / 1e9;

/** x, y and heading of a pose or transform. */
export function planar({ position, translation, orientation, rotation }) {
  const [p, q] = [position ?? translation, orientation ?? rotation];
  return { x: p.x, y: p.y, theta: 2 * Math.atan2(q.z, q.w) };
}

/** a_from_c of a_from_b and b_from_c. */
export function composed(a, b) {
  const [c, s] = [Math.cos(a.theta), Math.sin(a.theta)];
  return { x: a.x + c * b.x - s * b.y, y: a.y + s * b.x + c * b.y, theta: a.theta + b.theta };
}
