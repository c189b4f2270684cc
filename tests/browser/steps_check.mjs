// Compares what a page shows of a step with the step's line in steps.jsonl.
import assert from "node:assert/strict";
import { colourAt, drawn, mapView, moveSlider, showOnly } from "./open.mjs";
import { viridisAt } from "./viridis.mjs";

const fact = (page, name) => page.locator(`.details dt:text-is("${name}") + dd`).innerText();
const told = (page, curve) => page.locator(`[data-curve=${curve}] output`).innerText();
const number = (text) => Number(text.replaceAll(",", ""));

/** Numbers are shown with three digits. */
function assertShown(text, value, what) {
  if (value === undefined || value === null) assert.equal(text, "–", what);
  else assert.ok(Math.abs(number(text) - value) <= 0.0051 * Math.abs(value) + 1e-12, `${what}: ${text} for ${value}`);
}

export async function checkNumbers(page, step) {
  const at = `step ${step.step}`;
  assertShown(await fact(page, "Ω best"), step.omega_best, `${at} omega_best`);
  assertShown(await fact(page, "Ω max"), step.omega_max, `${at} omega_max`);
  assertShown(await fact(page, "Ω′"), step.omega_place, `${at} omega_place`);
  assert.equal(number(await fact(page, "clusters")), step.clusters, at);
  assert.equal(number(await fact(page, "hypotheses")), step.hypotheses, at);
  assert.equal(number(await fact(page, "proposals")), step.proposals, at);
  assertShown((await told(page, "match_ms")).replace(" ms", ""), step.stage_ms.match, `${at} match_ms`);
  const [omega, score] = (await told(page, "omega_best")).split(", score (dashed) ");
  assertShown(omega, step.omega_best, `${at} curve of omega_best`);
  if (Math.abs(step.score_best - step.omega_best) > 1e-3) {
    assertShown(score, step.score_best, `${at} curve of score_best`);
    assertShown(await fact(page, "score best"), step.score_best, `${at} score_best`);
  }
  assert.equal(number(await told(page, "clusters")), step.clusters, at);
  assertShown((await told(page, "translation")).replace(" m", ""), step.translation_error_m, `${at} translation error`);
  assertShown((await told(page, "rotation")).replace(" °", ""), step.rotation_error_deg, `${at} rotation error`);
  const verdict = await page.locator(".verdict").innerText();
  assert.ok(verdict.startsWith(step.verdict.replace("_", " ")) && verdict.endsWith(step.why), verdict);
  // The ten best, and up to the chosen one or all where that was asked for.
  const rows = await page.locator(".hypotheses tbody tr").count();
  assert.ok(rows >= Math.min(step.best.length, 10) && rows <= step.best.length, `${at}: ${rows} of ${step.best.length} clusters`);
}

const distance = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);

/** Clusters that no other one lies on, or shares a cell of 16 px with: their colour is that of r, and pointing at them tells r̄. */
export async function checkClusters(page, step) {
  await showOnly(page, "clusters");
  const view = await mapView(page);
  const places = step.best.map((cluster) => view.toScreen(cluster.pose));
  const inside = (at) =>
    at.x > view.box.left + 20 && at.x < view.box.left + view.box.width - 60 &&
    at.y > view.box.top + 20 && at.y < view.box.top + view.box.height - 50;
  const alone = places.map((at, i) => i).filter((i) => inside(places[i]) && places.every((other, k) => k === i || distance(other, places[i]) > 23));
  for (const i of alone.slice(0, 5)) {
    const cluster = step.best[i];
    const [red, green, blue, opacity] = await colourAt(page, places[i]);
    const expected = viridisAt(cluster.r);
    const isWeak = cluster.r < 0.95 * step.best[0].r;
    // Weak ones are faint, and a faint colour is less exact.
    [red, green, blue].forEach((value, k) => assert.ok(Math.abs(value - expected[k]) <= (isWeak ? 8 : 3), `cluster ${i}: ${[red, green, blue]} for ${expected}`));
    assert.ok(isWeak ? opacity < 255 && opacity >= 50 : opacity === 255, `cluster ${i}: opacity ${opacity}`);
    await page.mouse.move(places[i].x, places[i].y);
    const tip = await page.locator(".map:not(.space) .tip").innerText();
    assertShown(/r̄ = (\S+)/.exec(tip)[1], cluster.r_normalised, "normalised rating");
    assertShown(/· r = (\S+)/.exec(tip)[1], cluster.r, "rating");
    assert.match(tip, new RegExp(`cluster ${i + 1}, ${cluster.size} `));
    // A triangle points where the robot looks: paint ahead of the middle is farther out than behind it.
    const along = (length) => ({
      x: places[i].x + Math.cos(cluster.pose.theta) * length,
      y: places[i].y - Math.sin(cluster.pose.theta) * length,
    });
    assert.equal((await colourAt(page, along(8)))[3] > 0, true, "ahead");
    assert.equal((await colourAt(page, along(-8)))[3], 0, "behind");
  }
  await page.mouse.move(5, 5);
  return alone.length;
}

/** Paint of a layer at a pose's outline, and none there without the layer. */
export async function checkRobot(page, layer, pose) {
  const view = await mapView(page);
  const middle = view.toScreen(pose);
  // The foremost corner of the outline, and a little back from it where the two sides meet.
  const tip = { x: middle.x + Math.cos(pose.theta) * 14, y: middle.y - Math.sin(pose.theta) * 14 };
  await showOnly(page, layer);
  assert.ok((await colourAt(page, tip))[3] > 0, `${layer} is drawn`);
  await showOnly(page);
  assert.equal((await colourAt(page, tip))[3], 0, `${layer} is not drawn`);
}

/** Shows one step after the other and checks the numbers of each. */
export async function checkSteps(page, steps, numbers) {
  for (const k of numbers) {
    await moveSlider(page, k);
    await checkNumbers(page, steps[k]);
  }
  await drawn(page);
}
