// Draws what viewers got: node picture.mjs OUT.png [MESSAGES and options of glocal live]...; each panel shows what was there after so many
// messages on /glocal/pose, and all that is in it has come by WebSocket.
import { createRequire } from "node:module";
import { shownRun, secondsOf, view } from "./viewer.mjs";

const { chromium } = createRequire(`${process.env.GLOCAL_BROWSER_PACKAGES}/package.json`)("playwright-core");

const rotated = ({ x, y, z, w }, v) => {
  const t = [2 * (y * v.z - z * v.y), 2 * (z * v.x - x * v.z), 2 * (x * v.y - y * v.x)];
  return {
    x: v.x + w * t[0] + y * t[2] - z * t[1],
    y: v.y + w * t[1] + z * t[0] - x * t[2],
    z: v.z + w * t[2] + x * t[1] - y * t[0],
  };
};

/** A point of a frame on the map, by the transforms whose stamps are nearest; none if they do not lead there. */
function onMap(transforms, frame, stamp, point) {
  while (frame !== "map") {
    const own = transforms.filter(({ child_frame_id }) => child_frame_id === frame);
    if (own.length === 0) return null;
    const away = ({ header }) => Math.abs(secondsOf(header.stamp) - stamp);
    const { header, transform } = own.reduce((best, other) => (away(other) < away(best) ? other : best));
    const turned = rotated(transform.rotation, point);
    point = { x: turned.x + transform.translation.x, y: turned.y + transform.translation.y, z: turned.z + transform.translation.z };
    frame = header.frame_id;
  }
  return point;
}

/** The last scan that was made when a pose was told, on the map. */
function scanOf(viewer, stamp) {
  const transforms = [...viewer.messages["/tf"], ...(viewer.messages["/tf_static"] ?? [])].flatMap(({ transforms }) => transforms);
  const { topic } = viewer.channels.find(({ schemaName }) => schemaName === "sensor_msgs/msg/LaserScan");
  const scan = viewer.messages[topic].find(({ header }) => secondsOf(header.stamp) === stamp);
  if (!scan) return [];
  // One look-up for each axis tells where all readings are.
  const ends = [{ x: 0, y: 0, z: 0 }, { x: 1, y: 0, z: 0 }, { x: 0, y: 1, z: 0 }].map((point) => onMap(transforms, scan.header.frame_id, stamp, point));
  if (ends.includes(null)) return [];
  const [origin, x, y] = ends;
  return [...scan.ranges].flatMap((range, i) => {
    if (!(range >= scan.range_min && range < scan.range_max)) return [];
    const angle = scan.angle_min + i * scan.angle_increment;
    const [a, b] = [range * Math.cos(angle), range * Math.sin(angle)];
    return [{ x: origin.x + a * (x.x - origin.x) + b * (y.x - origin.x), y: origin.y + a * (x.y - origin.y) + b * (y.y - origin.y) }];
  });
}

async function panel(messages, options) {
  const { run, ended, address } = await shownRun(...options);
  const viewer = view(address);
  await viewer.until("/diagnostics", messages);
  // Its transform follows.
  await new Promise((resolve) => setTimeout(resolve, 300));
  const at = messages - 1;
  const poses = viewer.messages["/glocal/pose"].slice(0, messages);
  const { info, data } = viewer.messages["/map"][0];
  const { level, message, values } = viewer.messages["/diagnostics"][at].status[0];
  run.kill("SIGINT");
  await ended;
  return {
    map: { ...info, data: [...data] },
    poses: poses.map(({ pose }) => pose.pose),
    candidates: viewer.messages["/glocal/candidates"][at].poses,
    scan: scanOf(viewer, secondsOf(poses[at].header.stamp)),
    verdict: values.find(({ key }) => key === "verdict").value,
    level,
    why: message,
  };
}

/** In the browser. */
function draw(panels) {
  const colours = { map: "#333333", free: "#ffffff", unknown: "#e4e4e4", scan: "#d55e00", candidate: "#009e73", pose: "#0072b2" };
  for (const { map, poses, candidates, scan, verdict, level, why } of panels) {
    const figure = document.body.appendChild(document.createElement("figure"));
    const canvas = figure.appendChild(document.createElement("canvas"));
    [canvas.width, canvas.height] = [540, 420];
    const pen = canvas.getContext("2d");
    const { resolution, width, height, origin } = map;
    // The part that is known.
    const known = { x: [width, 0], y: [height, 0] };
    map.data.forEach((cell, i) => {
      if (cell < 0) return;
      const [column, row] = [i % width, Math.floor(i / width)];
      known.x = [Math.min(known.x[0], column), Math.max(known.x[1], column + 1)];
      known.y = [Math.min(known.y[0], row), Math.max(known.y[1], row + 1)];
    });
    const scale = Math.min(canvas.width / (known.x[1] - known.x[0]), canvas.height / (known.y[1] - known.y[0])) * 0.96;
    const screen = (x, y) => [
      canvas.width / 2 + ((x - origin.position.x) / resolution - (known.x[0] + known.x[1]) / 2) * scale,
      canvas.height / 2 - ((y - origin.position.y) / resolution - (known.y[0] + known.y[1]) / 2) * scale,
    ];
    pen.fillStyle = colours.unknown;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    for (const [value, colour] of [[0, colours.free], [100, colours.map]]) {
      pen.fillStyle = colour;
      map.data.forEach((cell, i) => {
        if (cell !== value) return;
        const [x, y] = screen(origin.position.x + (i % width) * resolution, origin.position.y + Math.floor(i / width) * resolution);
        pen.fillRect(x, y - scale, Math.max(scale + 0.5, 1.3), Math.max(scale + 0.5, 1.3));
      });
    }
    pen.fillStyle = colours.scan;
    for (const { x, y } of scan) {
      const [u, v] = screen(x, y);
      pen.fillRect(u - 1.5, v - 1.5, 3, 3);
    }
    pen.strokeStyle = colours.pose;
    pen.lineWidth = 2;
    if (candidates.length === 0) {
      pen.beginPath();
      for (const { position } of poses) pen.lineTo(...screen(position.x, position.y));
      pen.stroke();
    }
    const arrow = ({ position, orientation }, colour) => {
      pen.save();
      pen.translate(...screen(position.x, position.y));
      pen.rotate(-2 * Math.atan2(orientation.z, orientation.w));
      pen.fillStyle = colour;
      pen.beginPath();
      for (const [x, y] of [[16, 0], [-9, 9], [-4, 0], [-9, -9]]) pen.lineTo(x, y);
      pen.fill();
      pen.restore();
    };
    for (const candidate of candidates) arrow(candidate, colours.candidate);
    if (candidates.length === 0) arrow(poses.at(-1), colours.pose);
    const caption = figure.appendChild(document.createElement("figcaption"));
    const title = caption.appendChild(document.createElement("b"));
    title.textContent = verdict.replace("_", " ");
    title.style.color = level === 0 ? "#00694d" : "#9a4400";
    caption.append(` ${why}`);
  }
  const legend = document.body.appendChild(document.createElement("footer"));
  for (const [colour, text] of [
    [colours.candidate, "/glocal/candidates"],
    [colours.pose, "/glocal/pose"],
    [colours.scan, "scan, by /tf"],
    [colours.map, "/map"],
  ]) {
    const entry = legend.appendChild(document.createElement("span"));
    entry.appendChild(document.createElement("i")).style.background = colour;
    entry.append(text);
  }
}

const [out, ...words] = process.argv.slice(2);
const panels = [];
while (words.length > 0) {
  const end = words.indexOf("--and");
  const [messages, ...options] = words.splice(0, end < 0 ? words.length : end + 1).filter((word) => word !== "--and");
  panels.push(await panel(Number(messages), options));
}
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium-headless-shell", args: ["--no-sandbox", "--disable-gpu"] });
const page = await browser.newPage({ viewport: { width: 1120, height: 530 } });
await page.setContent(`<style>
  body { margin: 10px; font: 15px "DejaVu Sans"; display: flex; flex-wrap: wrap; gap: 10px; background: white; }
  figure { margin: 0; width: 540px } canvas { display: block; margin-bottom: 6px }
  figcaption { height: 38px; overflow: hidden } footer { width: 100%; color: #444 }
  i { display: inline-block; width: 12px; height: 12px; margin: 0 6px 0 18px } span:first-child i { margin-left: 0 }
</style>`);
await page.evaluate(draw, panels);
await page.screenshot({ path: out });
await browser.close();
