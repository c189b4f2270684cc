// A drive with a 3-D lidar in a simulated hall, seen in space.
import assert from "node:assert/strict";
import { cpSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { assertAccessibleInBoth } from "./accessible.mjs";
import { assertTablesExplained } from "./meanings.mjs";
import { assertQuiet, coloursAt, drag, drawn, hashOf, mapView, moveSlider, open, painted, pixelsOf, skip, slide, testsOn } from "./open.mjs";
import { glocal, readPcd, report, runExperiment, stepsOf, trialsOf, workFolder } from "./runs.mjs";
import { viridisAt } from "./viridis.mjs";

const canvas = ".space .stage canvas";

const work = workFolder();
let folder, file, steps, page;

testsOn(async () => {
  glocal("run", "--method", "lidar_upright", "--case", "workshop_lidar", "--out", join(work, "space"), "--quiet",
    "--set", "localizer.local_mapper=odometry", "--set", "trials.every_m=80", "--set", "output.maps=all");
  folder = join(work, "space", "lidar_upright_workshop_lidar");
  file = report(join(work, "report.html"), folder);
  steps = stepsOf(folder, 0);
  return ({ page } = await open(file));
});

const pointsOf = (name) => readPcd(name).map(({ x, y, z }) => [x, y, z]);

async function showOnly(...layers) {
  for (const box of await page.locator("input[data-space-layer]").all())
    await box.setChecked(layers.includes(await box.getAttribute("data-space-layer")));
  await drawn(page);
}

async function look(view) {
  await page.locator(`[data-view=${view}]`).click();
  await drawn(page);
}

/** Up to so many percent of them. */
const showHeights = (percent) => slide(page, ".cut input", percent);

/** The share of places, of those inside the view, that are painted. */
async function share(places) {
  const view = await mapView(page, canvas);
  const onScreen = places.map(([x, y]) => view.toScreen({ x, y })).filter(
    ({ x, y }) => x > view.box.left + 2 && x < view.box.left + view.box.width - 2 && y > view.box.top + 2 && y < view.box.top + view.box.height - 2,
  );
  assert.ok(onScreen.length > 0.9 * places.length, `${onScreen.length} of ${places.length} are in view`);
  const found = await painted(page, onScreen, canvas);
  return found.filter(Boolean).length / found.length;
}

/** By a unit quaternion, as Hamilton has it: p + 2w (v × p) + 2 v × (v × p). */
function rotated([x, y, z], { qx, qy, qz, qw }) {
  const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
  const v = [qx, qy, qz];
  const once = cross(v, [x, y, z]);
  const twice = cross(v, once);
  return [x, y, z].map((value, i) => value + 2 * qw * once[i] + 2 * twice[i]);
}
const moved = (point, pose) => rotated(point, pose).map((value, i) => value + [pose.x, pose.y, pose.z][i]);
const back = (point, pose) =>
  rotated(point.map((value, i) => value - [pose.x, pose.y, pose.z][i]), { ...pose, qx: -pose.qx, qy: -pose.qy, qz: -pose.qz });

test("only reports of runs in space carry what draws them", { skip }, () => {
  const planar = report(join(work, "planar.html"), runExperiment("paper_lab", join(work, "planar")));
  assert.ok(!readFileSync(planar, "utf8").includes("WebGL2"));
  assert.ok(readFileSync(file, "utf8").includes("WebGL2"));
  assert.ok(statSync(file).size < 20e6);
});

test("seen from above, each point of the map is where it belongs", { skip }, async () => {
  await look("above");
  await showHeights(100);
  await showOnly("map");
  const map = pointsOf(join(folder, "maps", "global.pcd"));
  const drawnThere = await share(map);
  // A point that was thinned out lies beside the one that stands for it.
  assert.ok(drawnThere > 0.97, String(drawnThere));
  await showOnly();
  assert.equal(await share(map), 0);
});

test("points have the colour of their height", { skip }, async () => {
  await look("above");
  await showHeights(100);
  await showOnly("map");
  const map = pointsOf(join(folder, "maps", "global.pcd"));
  const heights = map.map(([, , z]) => z).sort((a, b) => a - b);
  const [low, high] = [heights[Math.round(0.005 * (heights.length - 1))], heights[Math.round(0.995 * (heights.length - 1))]];
  const view = await mapView(page, canvas);
  // What is seen from above is the highest point of each place, and of all that are drawn over it.
  const cell = 0.3;
  const key = (x, y) => `${Math.floor(x / cell)} ${Math.floor(y / cell)}`;
  const highest = new Map();
  for (const [x, y, z] of map) highest.set(key(x, y), Math.max(highest.get(key(x, y)) ?? -Infinity, z));
  const around = ([x, y]) => [-1, 0, 1].flatMap((dx) => [-1, 0, 1].map((dy) => highest.get(key(x + dx * cell, y + dy * cell)) ?? -Infinity));
  const onTop = map.filter((point) => point[2] >= Math.max(...around(point)) - 1e-6);
  const colours = await coloursAt(page, onTop.map(([x, y]) => view.toScreen({ x, y })), canvas);
  let [same, opaque] = [0, 0];
  onTop.forEach(([, , z], i) => {
    // Edges are blended, and the floor has gaps.
    if (colours[i][3] < 255) return;
    ++opaque;
    const expected = viridisAt(0.86 * Math.min(Math.max((z - low) / (high - low), 0), 1));
    if (expected.every((value, c) => Math.abs(value - colours[i][c]) <= 8)) ++same;
  });
  assert.ok(opaque > 1000 && same > 0.9 * opaque, `${same} of ${opaque}`);
});

test("local map and scan lie under the estimate, and arrows at their poses", { skip }, async () => {
  const k = steps.length - 1;
  const { estimate, reference, local_from_robot: local } = steps[k];
  await look("above");
  await showHeights(100);
  await moveSlider(page, k);
  const recorded = (kind) => pointsOf(join(folder, "maps", "trial_0000", `${kind}_${String(k).padStart(4, "0")}.pcd`));
  await showOnly("local_map");
  assert.ok((await share(recorded("step").map((point) => moved(back(point, local), estimate)))) > 0.99);
  await showOnly("scan");
  assert.ok((await share(recorded("scan").map((point) => moved(point, estimate)))) > 0.97);
  for (const [layer, pose] of Object.entries({ estimate, reference })) {
    // Half way along the arrow of 40 px.
    const view = await mapView(page, canvas);
    const middle = [pose.x + (Math.cos(pose.theta) * 20) / view.scale, pose.y + (Math.sin(pose.theta) * 20) / view.scale];
    await showOnly(layer);
    assert.equal(await share([middle]), 1, layer);
    await showOnly();
    assert.equal(await share([middle]), 0, layer);
  }
});

test("in space the view turns by dragging, and heights can be cut", { skip }, async () => {
  await look("orbit");
  await showHeights(100);
  await showOnly("map");
  const picture = () => page.locator(canvas).evaluate((element) => element.toDataURL());
  /** Of the colours that high points have: viridis is green from its middle on. */
  const highPixels = async () => (await pixelsOf(page, canvas)).data.filter((value, i) => i % 4 === 1 && value > 140).length;
  const [before, all] = [await picture(), await highPixels()];
  assert.ok(all > 3000, `${all} pixels`);
  const box = await page.locator(canvas).boundingBox();
  await drag(page, { x: box.x + 200, y: box.y + 200 }, 100, 40);
  assert.notEqual(await picture(), before);
  await page.keyboard.press("0");
  await drawn(page);
  assert.equal(await picture(), before);
  await showHeights(0);
  assert.ok((await highPixels()) < 0.05 * all);
});

test("the slider of heights has its keys for itself", { skip }, async () => {
  await moveSlider(page, 1);
  await showHeights(100);
  await page.locator(".cut input").focus();
  await page.keyboard.press("ArrowLeft");
  assert.equal(await page.locator(".cut input").inputValue(), "99");
  await page.keyboard.press("Home");
  assert.equal(await page.locator(".cut input").inputValue(), "0");
  assert.equal(await page.evaluate(() => document.body.dataset.step), "1");
  await showHeights(100);
});

test("a page without steps says so in space", { skip }, async () => {
  const bare = join(work, "bare");
  cpSync(folder, bare, { recursive: true });
  rmSync(join(bare, "steps.jsonl"));
  const settings = readFileSync(join(bare, "effective.yaml"), "utf8");
  writeFileSync(join(bare, "effective.yaml"), settings.replace("steps: true", "steps: false"));
  const opened = await open(report(join(work, "bare.html"), bare));
  assert.ok(await opened.page.locator(canvas).isVisible());
  assert.match(await opened.page.locator(".space .note").innerText(), /no steps \(output\.steps: false\)/);
  assertQuiet(opened);
  await opened.page.close();
});

test("a step shows the map as a new drawing of it does, wherever it is seen from", { skip }, async (t) => {
  const picture = () => page.locator(canvas).evaluate((element) => element.toDataURL());
  const box = page.locator("input[data-space-layer=map]");
  const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];
  for (const view of ["orbit", "above"]) {
    await look(view);
    await showHeights(100);
    for (const other of await page.locator("input[data-space-layer]").all()) await other.check();
    await page.keyboard.press("+");
    await drawn(page);
    const times = [];
    for (let k = 0; k < 20; ++k) {
      const begin = performance.now();
      await moveSlider(page, k % steps.length);
      times.push(performance.now() - begin);
    }
    t.diagnostic(`${view}: ${Math.round(median(times))} ms from one step to another, drawn`);
    const pictures = [];
    for (let k = 0; k < steps.length; ++k) {
      await moveSlider(page, k);
      pictures.push(await picture());
      await box.uncheck();
      await drawn(page);
      assert.notEqual(await picture(), pictures[k], `${view}, step ${k}`);
      await box.check();
      await drawn(page);
      assert.ok((await picture()) === pictures[k], `${view}, step ${k}`);
    }
    assert.equal(new Set(pictures).size, steps.length);
  }
});

test("a link leads to what is seen, and from where", { skip }, async () => {
  const eyeOf = (page) => page.locator(canvas).evaluate((element) => [element.dataset.camera, element.dataset.x, element.dataset.y, element.dataset.scale, element.toDataURL()]);
  for (const view of ["above", "orbit"]) {
    await look(view);
    await page.keyboard.press("0");
    await page.locator("input[data-space-layer=scan]").setChecked(view === "above");
    await page.locator(".cut input").fill(view === "above" ? "100" : "55");
    const box = await page.locator(canvas).boundingBox();
    await drag(page, { x: box.x + 200, y: box.y + 200 }, 60, 30);
    await page.mouse.move(box.x + box.width / 2, box.y + 5);
    await drawn(page);
    const hash = await hashOf(page);
    const said = new URLSearchParams(hash.slice(1));
    assert.deepEqual([said.get("view"), said.get("hide_in_space")], view === "above" ? ["above", null] : [null, "scan"]);
    const other = await open(`${file}${hash}`);
    await drawn(other.page);
    const [expected, found] = [await eyeOf(page), await eyeOf(other.page)];
    assert.equal(found[0], view);
    for (const k of [1, 2, 3]) assert.ok(Math.abs(found[k] - expected[k]) < 2e-3 * Math.max(1, Math.abs(expected[k])), `${view}: ${found[k]} for ${expected[k]}`);
    assert.equal(await other.page.locator(".cut input").inputValue(), await page.locator(".cut input").inputValue());
    assert.equal(await other.page.locator("input[data-space-layer=scan]").isChecked(), view === "above");
    assertQuiet(other);
    await other.page.close();
  }
  await look("plan");
  const other = await open(`${file}${await hashOf(page)}`);
  assert.equal(await other.page.locator(canvas).isVisible(), false);
  assert.equal(await other.page.locator("[data-view=plan]").getAttribute("aria-pressed"), "true");
  // Without a word of it the run is seen as at first.
  await other.page.evaluate(() => (location.hash = "step=0"));
  await other.page.waitForFunction(() => document.querySelector("[data-view=orbit]").getAttribute("aria-pressed") === "true");
  assert.equal(await other.page.locator("input[data-space-layer=scan]").isChecked(), true);
  assertQuiet(other);
  await other.page.close();
  await look("orbit");
});

test("a cluster is chosen by a click, and the plan is still there", { skip }, async () => {
  await moveSlider(page, 0);
  await look("above");
  await showOnly("clusters");
  const view = await mapView(page, canvas);
  const places = steps[0].best.map(({ pose }) => view.toScreen(pose));
  const alone = places.findIndex((at, i) => places.every((other, k) => k === i || Math.hypot(at.x - other.x, at.y - other.y) > 20));
  assert.ok(alone >= 0);
  await page.mouse.click(places[alone].x, places[alone].y);
  assert.equal(await page.locator(".hypotheses table [aria-pressed=true]").getAttribute("data-hypothesis"), String(alone));
  await look("plan");
  assert.ok(await page.locator(".map:not(.space) canvas[data-scale]").isVisible());
  assert.equal(await page.locator(canvas).isVisible(), false);
});

test("clusters are told with their heights", { skip }, async () => {
  await moveSlider(page, 0);
  const texts = (selector) => page.locator(`.hypotheses ${selector}`).evaluateAll((cells) => cells.map(({ textContent }) => textContent));
  const column = (await texts("thead th")).indexOf("z, m");
  const heights = await texts(`tbody tr > :nth-child(${column + 1})`);
  assert.ok(heights.length > 0);
  heights.forEach((height, i) => assert.equal(height, steps[0].best[i].pose.z.toFixed(2)));
});

test("the certificate is told in a sentence with its numbers", { skip }, async () => {
  const certified = steps.findIndex((step) => step.verification?.certificate);
  assert.ok(certified >= 0);
  const { contact, at_most, distance_m, rotation_deg } = steps[certified].verification.certificate;
  await moveSlider(page, certified);
  // Folded, the number is told; its meaning when asked for.
  assert.match(await page.locator(".certificate").innerText(), /[+−]\d+\.\d points$/);
  await page.locator(".certificate summary").click();
  const text = await page.locator(".certificate").innerText();
  const percent = (part) => `${(100 * part).toFixed(1)} %`;
  assert.ok(text.includes(`${percent(contact)} of the local map's points are in contact`), text);
  assert.ok(text.includes(`no pose more than ${distance_m} m or ${Math.round(rotation_deg)}° away has more than ${percent(at_most)}`), text);
  assert.ok(text.includes(`${Math.abs(100 * (contact - at_most)).toFixed(1)} points`), text);
  const without = steps.findIndex((step) => !step.verification);
  await moveSlider(page, without);
  assert.match(await page.locator(".certificate").innerText(), /certificate of the trial, of step \d+/);
  const rows = page.locator("#trials tbody tr");
  for (const [i, { certificate }] of trialsOf(folder).entries())
    if (certificate) assert.ok((await rows.nth(i).innerText()).includes(`${percent(certificate.contact)}, elsewhere ≤ ${percent(certificate.at_most)}`));
});

test("with a graphics card the same is drawn, without keeping the map", { skip }, async () => {
  /** Cells of 6 px in which anything is painted: smooth edges change single pixels. */
  const cells = async (page) => {
    const { data, width } = await pixelsOf(page, canvas);
    const painted = new Set();
    for (let i = 3; i < data.length; i += 4) {
      const at = (i - 3) / 4;
      if (data[i] > 127) painted.add(1000 * Math.floor(at / width / 6) + Math.floor((at % width) / 6));
    }
    return [...painted];
  };
  const isSmooth = (page) =>
    page.locator(canvas).evaluate((element) => element.getContext("webgl2").getContextAttributes().antialias);
  const kept = await open(file);
  await drawn(kept.page);
  const context = await page.context().browser().newContext({ viewport: { width: 1366, height: 768 } });
  // The page is not told what draws it.
  await context.addInitScript(() => {
    const original = WebGL2RenderingContext.prototype.getExtension;
    WebGL2RenderingContext.prototype.getExtension = function (name) {
      return name === "WEBGL_debug_renderer_info" ? null : original.call(this, name);
    };
  });
  const direct = await context.newPage();
  await direct.goto(`file://${file}`);
  await direct.waitForSelector(`${canvas}[data-scale]`);
  await drawn(direct);
  const [a, b] = [await cells(kept.page), await cells(direct)];
  assert.deepEqual([await isSmooth(kept.page), await isSmooth(direct)], [false, true]);
  const missing = (from, all) => from.filter((cell) => !all.includes(cell)).length;
  const differing = missing(a, b) + missing(b, a);
  assert.ok(a.length > 1500 && differing < 0.02 * a.length, `${differing} of ${a.length}`);
  await kept.page.close();
  await context.close();
});

test("without WebGL the plan is shown, and the page says so", { skip }, async () => {
  const context = await page.context().browser().newContext();
  await context.addInitScript(() => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith("webgl") ? null : original.call(this, kind, ...rest);
    };
  });
  const plain = await context.newPage();
  const errors = [];
  plain.on("pageerror", (error) => errors.push(String(error)));
  await plain.goto(`file://${file}`);
  await plain.waitForSelector("canvas[data-scale]");
  assert.match(await plain.locator(".views .note").first().innerText(), /WebGL is missing.*plan/);
  assert.equal(await plain.locator("[data-view]").count(), 0);
  assert.deepEqual(errors, []);
});

test("the headings of curves have room for their numbers", { skip }, async () => {
  const panels = await page.locator(".panel[data-curve]").evaluateAll((all) =>
    all.map((panel) => {
      const [number, box] = ["output", "label"].map((part) => panel.querySelector(part).getBoundingClientRect());
      return { text: panel.querySelector("output").textContent, isClear: number.right <= box.left || number.top >= box.bottom };
    }),
  );
  assert.ok(panels.some(({ text }) => text.includes("score (dashed)")));
  assert.deepEqual(panels.filter(({ isClear }) => !isClear), []);
});

test("under a cluster that a step lacks nothing is laid, though the next step has more", { skip }, async () => {
  const of = (trial) => stepsOf(folder, trial).map(({ best }) => best.length);
  const trial = trialsOf(folder).findIndex(({ trial }) => of(trial).some((n, k, all) => n + 1 < all[k + 1]));
  const step = of(trial).findIndex((n, k, all) => n + 1 < all[k + 1]);
  await page.evaluate((hash) => (location.hash = hash), `trial=${trial}&step=${step}&pose=${of(trial)[step] + 1}`);
  await page.waitForFunction(([trial, step]) => document.body.dataset.trial === trial && document.body.dataset.step === step, [trial, step].map(String));
  await look("above");
  await showOnly("local_map", "scan");
  const { data } = await pixelsOf(page, canvas);
  assert.ok(data.every((value, i) => i % 4 !== 3 || value === 0), "something is drawn");
  assert.match(await page.locator(".space .note").innerText(), /no such pose/);
});

test("what is missing is told beside what else is, as on the plan", { skip }, async () => {
  const bare = join(work, "without_maps");
  cpSync(folder, bare, { recursive: true });
  rmSync(join(bare, "maps"), { recursive: true });
  const file = report(join(work, "one_map.html"), folder, bare, "--clusters", "3");
  const opened = await open(`${file}#run=without_maps&step=1`);
  const note = await opened.page.locator(".space .note").innerText();
  assert.match(note, /no global map.*The 3 best of 10 clusters.*Local maps of this trial were not recorded/);
  await opened.page.locator("[data-view=plan]").click();
  await drawn(opened.page);
  assert.ok((await opened.page.locator(".map:not(.space) .note").innerText()).startsWith(note));
  assertQuiet(opened);
  await opened.page.close();
});

test("every column of a table tells what it is", { skip }, () => assertTablesExplained(page, 20));

test("axe finds nothing serious", { skip }, () => assertAccessibleInBoth(page, "space"));
