// Links to what is shown, and pictures and tables as files.
import assert from "node:assert/strict";
import { cpSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { assertTablesExplained } from "./meanings.mjs";
import { assertQuiet, drawn, hashOf, mapView, moveSlider, open, pixelsOf, skip, testsOn, themed } from "./open.mjs";
import { report, runExperiment, stepsOf, trialsOf, workFolder } from "./runs.mjs";
import { cellsOf, countColours, saved, seen } from "./saved.mjs";
import { checkNumbers } from "./steps_check.mjs";

const variants = ["paper", "fewer_draws"]; // in the order of the file
const work = workFolder();
let folder, file, page;

testsOn(async () => {
  folder = runExperiment("paper_variants", join(work, "variants"), "--set", "output.maps=first_trial", ...variants.flatMap((name) => ["--only", name]));
  file = report(join(work, "report.html"), folder);
  return ({ page } = await open(file));
});

const shown = (page) => page.evaluate(() => ({ ...document.body.dataset }));

test("a page that was just opened has a plain address", { skip }, async () => {
  assert.equal(await hashOf(page), "");
});

test("the address follows what is shown, and leads there again", { skip }, async () => {
  await page.locator("#run").selectOption("paper");
  await page.locator("#trial").selectOption("4");
  await moveSlider(page, 1);
  await page.locator("[data-hypothesis=reference]").click();
  await page.locator("[data-layer=scan]").uncheck();
  await page.keyboard.press("+");
  await drawn(page);
  const hash = await hashOf(page);
  const { zoom, ...said } = Object.fromEntries(new URLSearchParams(hash.slice(1)));
  assert.ok(Number(zoom) > 0);
  const expected = { run: "paper", trial: "4", step: "1", pose: "reference", hide: "scan" };
  for (const [name, value] of Object.entries(expected)) assert.equal(said[name], value, name);
  const view = await mapView(page);
  const other = await open(`${file}${hash}`);
  const { run, trial, step } = await shown(other.page);
  assert.deepEqual([run, trial, step], ["paper", "4", "1"]);
  await checkNumbers(other.page, stepsOf(join(folder, "paper"), 4)[1]);
  assert.equal(await other.page.locator("[data-hypothesis=reference]").getAttribute("aria-pressed"), "true");
  assert.equal(await other.page.locator("[data-layer=scan]").isChecked(), false);
  const again = await mapView(other.page);
  assert.ok(Math.abs(again.scale / view.scale - 1) < 1e-3 && Math.hypot(again.x - view.x, again.y - view.y) < 2e-3);
  assertQuiet(other);
  await other.page.close();
});

test("the address has the borders that were moved", { skip }, async () => {
  const size = async (page) => {
    const { width, height } = await page.locator(".stage").boundingBox();
    return [width, height];
  };
  const [upright, level] = [page.locator(".border.vertical"), page.locator(".border.horizontal")];
  const before = await size(page);
  await upright.focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowRight");
  await level.focus();
  for (let i = 0; i < 15; ++i) await page.keyboard.press("ArrowDown");
  const hash = await hashOf(page);
  const said = new URLSearchParams(hash.slice(1));
  assert.deepEqual([said.get("width"), said.get("height")], ["54", "860"]);
  const moved = await size(page);
  assert.ok(moved[0] > before[0] + 50 && Math.abs(moved[1] - 860) < 3, String(moved));
  const other = await open(`${file}${hash}`);
  (await size(other.page)).forEach((length, i) => assert.ok(Math.abs(length - moved[i]) < 2, `${length} for ${moved[i]}`));
  assert.equal(await other.page.locator(".border.vertical").getAttribute("aria-valuenow"), "54");
  // No border is moved so far that the map is gone.
  await other.page.evaluate(() => (location.hash = "width=1000&height=-5"));
  await other.page.waitForFunction(() => document.querySelector(".border.vertical").getAttribute("aria-valuenow") === "80");
  assert.equal(await other.page.locator(".border.horizontal").getAttribute("aria-valuenow"), "200");
  assertQuiet(other);
  await other.page.close();
  for (const border of [upright, level]) await border.dblclick();
  await page.waitForFunction(() => !location.hash.includes("height="));
  (await size(page)).forEach((length, i) => assert.ok(Math.abs(length - before[i]) < 2, `${length} for ${before[i]}`));
});

test("a changed address changes what is shown; what it leaves out is as at the start", { skip }, async () => {
  await page.evaluate(() => (location.hash = "run=fewer_draws&trial=2"));
  await page.waitForFunction(() => document.body.dataset.trial === "2");
  const { run, step } = await shown(page);
  const steps = stepsOf(join(folder, "fewer_draws"), 2);
  const declared = steps.findIndex(({ verdict }) => verdict === "localized");
  assert.deepEqual([run, step], ["fewer_draws", String(declared < 0 ? steps.length - 1 : declared)]);
  assert.equal(await page.locator("[data-layer=scan]").isChecked(), true);
});

test("an address that changes while the page writes its own is not lost", { skip }, async () => {
  // Both happen in one turn of the page: this timer and the page's own are due together.
  await page.evaluate(() => {
    setTimeout(() => (location.hash = "run=paper&trial=3&width=60"), 250);
    document.querySelector(".border.vertical").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
    for (const end = performance.now() + 300; performance.now() < end; );
  });
  await page.waitForFunction(() => document.querySelector(".border.vertical").getAttribute("aria-valuenow") === "60");
  await page.waitForFunction(() => document.body.dataset.trial === "3");
  await page.locator(".border.vertical").dblclick();
});

test("addresses of nothing, and of parts of the page, do no harm", { skip }, async () => {
  await page.evaluate(() => (location.hash = "run=no_such&trial=999&step=-7&pose=77777&zoom=nothing&x=1"));
  await page.waitForFunction(() => document.body.dataset.step === "0");
  const best = await page.locator("#run option").first().innerText();
  assert.deepEqual((await shown(page)).run, best);
  await page.evaluate(() => (location.hash = "trials"));
  assert.equal(await hashOf(page), "#trials");
  assert.equal((await shown(page)).run, best);
});

test("a link leads to a place on another run's map, whose steps are loaded only then", { skip }, async () => {
  const folders = ["paper_lab", "paper_simulation"].map((name) => runExperiment(name, join(work, name)));
  const both = report(join(work, "both.html"), ...folders);
  const first = await open(both);
  const run = await first.page.locator("#run option").last().innerText();
  await first.page.close();
  const other = await open(`${both}#run=${run}&x=1.25&y=-0.5&zoom=50`);
  assert.equal((await shown(other.page)).run, run);
  const { x, y, scale } = await mapView(other.page);
  assert.deepEqual([x, y, scale], [1.25, -0.5, 50]);
  for (const each of [first, other]) assertQuiet(each);
  await other.page.close();
});

test("every column of a table tells what it is", { skip }, () => assertTablesExplained(page, 40));

test("tables are saved as CSV", { skip }, async () => {
  await page.evaluate(() => (location.hash = "run=paper&trial=0&step=0"));
  await page.waitForFunction(() => document.body.dataset.run === "paper" && document.body.dataset.step === "0");
  const trials = await saved(page, page.locator("#trials .csv"));
  assert.equal(trials.name, "paper_trials.csv");
  const expected = trialsOf(join(folder, "paper"));
  const rows = cellsOf(trials.content.toString());
  assert.equal(rows.length, expected.length + 1);
  assert.deepEqual(rows[0].slice(0, 3), ["trial", "outcome", "steps"]);
  expected.forEach((trial, i) => {
    assert.deepEqual(rows[i + 1].slice(0, 3), [trial.trial, trial.outcome, trial.steps].map(String));
    assert.equal(rows[i + 1].at(-1), trial.why);
  });
  const clusters = await saved(page, page.locator(".hypotheses .csv"));
  assert.equal(clusters.name, "paper_trial-0_step-0_clusters.csv");
  const { best } = stepsOf(join(folder, "paper"), 0)[0];
  const sizes = cellsOf(clusters.content.toString()).slice(1).map((row) => Number(row[3]));
  assert.deepEqual(sizes, best.map(({ size }) => size));
  // Each table has its button.
  assert.equal(await page.locator(".table .csv").count(), await page.locator(".table table").count());
});

test("the map is saved as SVG and PNG, as it is shown", { skip }, async () => {
  // The scan would cover the local map.
  await page.locator("[data-layer=scan]").uncheck();
  await drawn(page);
  const svg = await saved(page, page.locator(".map [data-save=svg]"));
  assert.equal(svg.name, "paper_trial-0_step-0_map.svg");
  const png = await saved(page, page.locator(".map [data-save=png]"));
  assert.equal(png.name, "paper_trial-0_step-0_map.png");
  const { box } = await mapView(page);
  const drawing = await seen(page, svg.content, "image/svg+xml");
  assert.deepEqual([drawing.width, drawing.height], [Math.round(box.width), Math.round(box.height)]);
  const picture = await seen(page, png.content, "image/png");
  assert.deepEqual([picture.width, picture.height], [2 * drawing.width, 2 * drawing.height]);
  // Walls and the local map cover as much as on the page, twice as long and wide.
  const onPage = countColours(await pixelsOf(page, ".stage canvas"));
  for (const name of ["wall", "local-map"]) {
    const key = (await themed(page, name)).join(",");
    assert.ok(onPage[key] > 50, `${name}: ${onPage[key]}`);
    assert.ok(picture.colours[key] > 2 * onPage[key], `${name}: ${picture.colours[key]} for ${onPage[key]}`);
  }
});

test("curves are saved with their lines and the names of the runs", { skip }, async () => {
  const svg = await saved(page, page.locator("[data-curve=omega_best] [data-save=svg]"));
  assert.equal(svg.name, "paper_trial-0_step-0_best-quality-ω.svg");
  const text = svg.content.toString();
  for (const name of ["Best quality Ω", ...variants]) assert.ok(text.includes(`>${name}</text>`) || text.includes(`>${name}</title>`), name);
  // The line of the chosen run has a point for each step, at the height of its Ω.
  const steps = stepsOf(join(folder, "paper"), 0);
  const lines = [...text.matchAll(/<path d="([^"]+)" fill="none" stroke="[^"]+" stroke-width="2"\/>/g)].map(([, d]) =>
    d.match(/[ML][\d.-]+ [\d.-]+/g).map((part) => part.slice(1).split(" ").map(Number)),
  );
  const line = lines.find((points) => points.length === steps.length);
  assert.ok(line, "the line of the chosen run");
  const [a, b] = [0, steps.length - 1];
  for (let i = 1; i < steps.length - 1; ++i) {
    // Heights are linear in Ω, places in the step.
    assert.ok(Math.abs((line[i][0] - line[a][0]) / (line[b][0] - line[a][0]) - i / b) < 0.01);
  }
  const heights = steps.map(({ omega_best: omega }, i) => [omega, line[i][1]]);
  const [low, high] = [heights.reduce((x, y) => (x[0] < y[0] ? x : y)), heights.reduce((x, y) => (x[0] > y[0] ? x : y))];
  for (const [omega, v] of heights) {
    const expected = low[1] + ((omega - low[0]) / Math.max(high[0] - low[0], 1e-9)) * (high[1] - low[1]);
    assert.ok(Math.abs(v - expected) < 0.3, `${v} for ${expected}`);
  }
  const png = await saved(page, page.locator("[data-curve=omega_best] [data-save=png]"));
  const picture = await seen(page, png.content, "image/png");
  assert.ok(Object.keys(picture.colours).length > 10);
});

test("a picture that is too large for a PNG is told of", { skip }, async () => {
  const menu = page.locator("[data-curve=omega_best] .save");
  const picture = await page.evaluateHandle(() => Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, "toBlob"));
  await page.evaluate(() => (HTMLCanvasElement.prototype.toBlob = (done) => done(null)));
  await menu.locator("summary").click();
  await menu.locator("[data-save=png]").click();
  await menu.locator(".warning", { hasText: "No PNG: the picture is too large for a PNG file." }).waitFor();
  await page.evaluate((its) => Object.defineProperty(HTMLCanvasElement.prototype, "toBlob", its), picture);
  await menu.locator("summary").click();
});

test("curves of other runs are drawn though those of one cannot be loaded", { skip }, async () => {
  const third = join(work, "third");
  cpSync(join(folder, "fewer_draws"), third, { recursive: true });
  const damaged = report(join(work, "damaged.html"), ...variants.map((name) => join(folder, name)), third);
  // Chunks follow each other as the runs do.
  const chunks = [...readFileSync(damaged, "utf8").matchAll(/<script type="text\/plain" id="glocal-chunk-\d+">[^<]*<\/script>/g)].map(([chunk]) => chunk);
  writeFileSync(damaged, chunks.slice((chunks.length * 2) / 3).reduce((text, chunk) => text.replace(chunk, ""), readFileSync(damaged, "utf8")));
  const opened = await open(`${damaged}#run=paper&trial=0`);
  const svg = await saved(opened.page, opened.page.locator("[data-curve=omega_best] [data-save=svg]"));
  const names = [...svg.content.toString().matchAll(/>([a-z_]+)<\/text>/g)].map(([, name]) => name);
  assert.deepEqual(names.filter((name) => [...variants, "third"].includes(name)).sort(), [...variants].sort());
  assertQuiet(opened);
  await opened.page.close();
});
