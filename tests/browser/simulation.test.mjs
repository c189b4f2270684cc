// The paper's simulation: one trial of 136 steps with its maps.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { colourAt, drag, drawn, isTaken, mapView, moveSlider, open, painted, showOnly, skip, testsOn } from "./open.mjs";
import { readPcd, report, runExperiment, stepsOf, trialsOf, workFolder } from "./runs.mjs";
import { saved } from "./saved.mjs";
import { checkClusters, checkNumbers, checkRobot, checkSteps } from "./steps_check.mjs";

const work = workFolder();
let folder, file, steps, page;

testsOn(async () => {
  folder = runExperiment("paper_simulation", join(work, "simulation"));
  file = report(join(work, "report.html"), folder);
  steps = stepsOf(folder, 0);
  return ({ page } = await open(file));
});

test("is one file of less than 1 MB", { skip }, () => {
  assert.ok(statSync(file).size < 1e6);
  assert.equal(steps.length, 136);
});

test("opens at the declaration, under the numbers of the run", { skip }, async () => {
  const declared = steps.findIndex(({ verdict }) => verdict === "localized");
  assert.equal(await page.evaluate(() => document.body.dataset.step), String(declared));
  const [trial] = trialsOf(folder);
  assert.equal(trial.outcome, "right");
  const answer = await page.locator("#figures .answer").innerText();
  for (const part of ["right", `after ${trial.steps} steps`, `${trial.translation_error_m.toFixed(3)} m`, `${trial.rotation_error_deg.toFixed(2)}°`]) assert.ok(answer.includes(part), answer);
  const box = await page.locator("#figures .answer").boundingBox();
  assert.ok(box.y < 120, `the verdict is at the top: ${box.y}`);
});

test("nothing in the page scrolls for itself, on any screen", { skip }, async () => {
  for (const width of [1366, 800, 390]) {
    await page.setViewportSize({ width, height: 768 });
    await drawn(page);
    const boxes = await page.evaluate(() =>
      [...document.querySelectorAll("body *")].filter((e) => {
        const { overflowX, overflowY } = getComputedStyle(e);
        const scrolls = (overflow, all, shown) => ["auto", "scroll"].includes(overflow) && all > shown + 1;
        return scrolls(overflowX, e.scrollWidth, e.clientWidth) || scrolls(overflowY, e.scrollHeight, e.clientHeight);
      }).map((e) => `${e.tagName}.${e.className}`),
    );
    assert.deepEqual(boxes, [], `${width} px`);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
  }
  await page.setViewportSize({ width: 1366, height: 768 });
  await drawn(page);
});

test("axes are words", { skip }, async () => {
  const svg = await saved(page, page.locator("[data-curve=rotation] [data-save=svg]"));
  for (const word of ["step", "error, °"]) assert.ok(svg.content.toString().includes(`>${word}</text>`), word);
});

test("of clusters that overlap the best are drawn, and the others as one zooms in", { skip }, async () => {
  await moveSlider(page, 0);
  await showOnly(page, "clusters");
  const hidden = async () => Number(/(\d+) more clusters as you zoom in/.exec(await page.locator(".map .note").innerText())?.[1] ?? 0);
  const counts = [await hidden()];
  const best = steps[0].best[0].pose;
  // The best one is always drawn.
  assert.ok((await colourAt(page, (await mapView(page)).toScreen(best)))[3] === 255);
  while (counts.at(-1) > 0 && counts.length < 30) {
    await page.keyboard.press("+");
    await drawn(page);
    counts.push(await hidden());
  }
  assert.ok(counts[0] > 5, String(counts));
  assert.equal(counts.at(-1), 0);
  assert.ok(counts.every((n, i) => i === 0 || n <= counts[i - 1]), String(counts));
  await page.locator(".hypotheses .all").click();
  assert.equal(await page.locator(".hypotheses tbody tr").count(), steps[0].best.length);
  await page.keyboard.press("0");
});

test("numbers are those of steps.jsonl", { skip }, async () => {
  await checkSteps(page, steps, [0, 1, 27, 45, 86, 87, 88, 135]);
});

test("clusters are drawn where they are, in the colour of r, and tell their normalised rating", { skip }, async () => {
  let checked = 0;
  for (const k of [0, 6, 12]) {
    await moveSlider(page, k);
    checked += await checkClusters(page, steps[k]);
  }
  assert.ok(checked >= 3, `${checked} clusters lie alone`);
});

test("zooming keeps the place under the pointer, and what is drawn stays where it is on the map", { skip }, async () => {
  const k = 20; // two clusters, far apart
  await moveSlider(page, k);
  const before = await mapView(page);
  const at = before.toScreen(steps[k].best[0].pose);
  await page.mouse.move(at.x, at.y);
  await page.mouse.wheel(0, -400);
  await drawn(page);
  const after = await mapView(page);
  assert.ok(Math.abs(after.scale / before.scale - Math.E) < 0.01, `${before.scale} to ${after.scale}`);
  const now = after.toScreen(steps[k].best[0].pose);
  assert.ok(Math.hypot(now.x - at.x, now.y - at.y) < 1.5);
  assert.ok((await checkClusters(page, steps[k])) >= 1);
  await drag(page, now, 50, 30);
  const dragged = (await mapView(page)).toScreen(steps[k].best[0].pose);
  assert.ok(Math.abs(dragged.x - now.x - 50) < 1.5 && Math.abs(dragged.y - now.y - 30) < 1.5);
  await page.keyboard.press("0");
  await drawn(page);
  assert.equal((await mapView(page)).scale, before.scale);
});

test("estimate and reference are drawn at their poses", { skip }, async () => {
  await moveSlider(page, 100);
  await checkRobot(page, "estimate", steps[100].estimate);
  await checkRobot(page, "reference", steps[100].reference);
});

test("the local map lies on the map under the estimate, and the scan under the robot", { skip }, async () => {
  const k = 100;
  await moveSlider(page, k);
  const { estimate, local_from_robot: local } = steps[k];
  const turn = estimate.theta - local.theta;
  const rotated = (p, angle) => ({ x: Math.cos(angle) * p.x - Math.sin(angle) * p.y, y: Math.sin(angle) * p.x + Math.cos(angle) * p.y });
  const share = async (points, place) => {
    const view = await mapView(page);
    const found = await painted(page, points.map((point) => view.toScreen(place(point))));
    return found.filter(Boolean).length / points.length;
  };
  const inMap = (point) => {
    const p = rotated({ x: point.x - local.x, y: point.y - local.y }, turn);
    return { x: estimate.x + p.x, y: estimate.y + p.y };
  };
  const ofScan = (point) => {
    const p = rotated(point, estimate.theta);
    return { x: estimate.x + p.x, y: estimate.y + p.y };
  };
  const maps = join(folder, "maps", "trial_0000");
  const localMap = readPcd(join(maps, "step_0100.pcd"));
  const scan = readPcd(join(maps, "scan_0100.pcd"));
  await showOnly(page, "local_map");
  assert.equal(await share(localMap, inMap), 1);
  await showOnly(page, "scan");
  assert.equal(await share(scan, ofScan), 1);
  await showOnly(page);
  assert.equal(await share(localMap, inMap), 0);
  await showOnly(page, "map");
  const global = readPcd(join(folder, "maps", "global.pcd"));
  assert.equal(await share(global, (p) => p), 1);
});

test("another hypothesis can be chosen by its button and by a click on the map", { skip }, async () => {
  await moveSlider(page, 0);
  await page.locator("[data-hypothesis='3']").click();
  assert.equal(await page.locator("[data-hypothesis='3']").getAttribute("aria-pressed"), "true");
  await showOnly(page, "clusters");
  const view = await mapView(page);
  const at = view.toScreen(steps[0].best[1].pose);
  await page.mouse.click(at.x, at.y);
  const chosen = Number(await page.locator(".hypotheses table [aria-pressed=true]").getAttribute("data-hypothesis"));
  const place = view.toScreen(steps[0].best[chosen].pose);
  assert.ok(Math.hypot(place.x - at.x, place.y - at.y) < 2, "the nearest cluster is chosen");
});

test("keys move the step, and play goes on by itself", { skip }, async () => {
  await page.locator(".stage canvas").focus();
  const step = () => page.evaluate(() => Number(document.body.dataset.step));
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowLeft");
  assert.equal(await step(), 1);
  await page.keyboard.press("Control+ArrowRight");
  assert.equal(await step(), 11);
  await page.keyboard.press("End");
  assert.equal(await step(), 135);
  await checkNumbers(page, steps[135]);
  // With Ctrl they are the browser's, which has its own sizes and ends.
  for (const key of ["0", "+", "-", "Home", "f"]) assert.equal(await isTaken(page, { key, ctrlKey: true }), false, key);
  assert.equal(await step(), 135);
  await page.keyboard.press("Home");
  await page.keyboard.press("Space");
  await page.waitForFunction(() => Number(document.body.dataset.step) >= 3);
  await page.keyboard.press("Space");
  const stopped = await step();
  await page.waitForTimeout(300);
  assert.equal(await step(), stopped);
});

test("a click in a curve chooses the step, and the cursor of all curves follows the slider", { skip }, async () => {
  const over = page.locator("[data-curve=omega_max] .u-over");
  const box = await over.boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  const step = await page.evaluate(() => Number(document.body.dataset.step));
  assert.ok(Math.abs(step - 135 / 2) <= 1.5, `step ${step}`);
  await checkNumbers(page, steps[step]);
  await moveSlider(page, 135);
  for (const curve of ["match_ms", "omega_best", "omega_max", "omega_place", "translation", "rotation", "clusters"]) {
    const at = await page.locator(`[data-curve=${curve}] .u-over`).evaluate((plot) => {
      const line = plot.querySelector(".step-line").getBoundingClientRect();
      const all = plot.getBoundingClientRect();
      return (line.left + line.width / 2 - all.left) / all.width;
    });
    assert.ok(Math.abs(at - 1) < 0.01, `${curve}: ${at}`);
  }
});

test("light, dark and paper", { skip }, async () => {
  const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const theme = page.locator("header button", { hasText: "theme" });
  await theme.click();
  const light = await paper();
  await theme.click();
  assert.notEqual(await paper(), light);
  await theme.click();
  await page.emulateMedia({ colorScheme: "dark" });
  await page.waitForFunction((colour) => getComputedStyle(document.body).backgroundColor !== colour, light);
  await page.emulateMedia({ colorScheme: null });
  const pdf = await page.pdf();
  assert.equal(pdf.subarray(0, 5).toString(), "%PDF-");
});
