// Methods on cases with several seeds: what is asked first is which of them is best.
import assert from "node:assert/strict";
import { existsSync, statSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { assertAccessibleInBoth } from "./accessible.mjs";
import { assertTablesExplained } from "./meanings.mjs";
import { drawn, open, skip, testsOn } from "./open.mjs";
import { glocal, report, stepsOf, trialsOf, workFolder } from "./runs.mjs";

const [methods, cases, seeds] = [["paper", "indexed"], ["apartment", "office"], [1, 2]];
const work = workFolder();
const file = join(work, "report.html");
let page, folder;

/** Of the runs of a method, on some cases. */
const trials = (method, some = cases) => some.flatMap((name) => seeds.flatMap((seed) => trialsOf(join(folder, `${method}_${name}_seed-${seed}`))));
/** Of all its runs, of which some have many more steps than others, ascending. */
const stepTimes = (method) =>
  cases
    .flatMap((name) => seeds.map((seed) => join(folder, `${method}_${name}_seed-${seed}`)))
    .flatMap((run) => trialsOf(run).flatMap(({ trial }) => stepsOf(run, trial)))
    .map(({ stage_ms }) => Object.values(stage_ms).reduce((sum, ms) => sum + ms, 0))
    .sort((a, b) => a - b);
const counted = (all, outcome) => all.filter((trial) => trial.outcome === outcome).length;
const score = (all) => (counted(all, "right") - counted(all, "wrong")) / all.length;
const rows = () => page.locator("#figures tbody tr");
const names = () => rows().locator("[data-run]").allInnerTexts();

testsOn(async () => {
  folder = join(work, "results");
  const named = [...methods.flatMap((name) => ["--method", name]), ...cases.flatMap((name) => ["--case", name])];
  const set = ["trials.every_m=8", "trials.max_steps=6", "trials.min_steps=6", "observations.simulation.tour_legs=12"];
  glocal("run", ...named, "--seeds", "1..2", ...set.flatMap((text) => ["--set", text]), "--out", folder, "--quiet");
  return ({ page } = await open(report(file, folder)));
});

test("each method has a row over all cases and seeds, the best first", { skip }, async () => {
  const shown = await names();
  assert.deepEqual([...shown].sort(), [...methods].sort());
  const heads = await page.locator("#figures thead th").allInnerTexts();
  for (const [i, method] of shown.entries()) {
    const all = trials(method);
    const cells = await rows().nth(i).locator("td").allInnerTexts();
    assert.deepEqual(cells.slice(0, 2), ["right", "wrong"].map((outcome) => String(counted(all, outcome))));
    const time = Number(cells[heads.findIndex((head) => head.startsWith("time")) - 1]);
    const times = stepTimes(method);
    assert.ok(Math.abs(time / times[Math.floor(times.length / 2)] - 1) < 0.06, `${method}: ${time} ms`);
  }
  assert.ok(score(trials(shown[0])) >= score(trials(shown[1])));
  assert.equal(await page.locator("#run option").first().innerText().then((name) => name.startsWith(shown[0])), true);
});

test("rows can be of each case, or of single runs, and only of some", { skip }, async () => {
  await page.locator("#level").selectOption("case");
  assert.equal(await rows().count(), methods.length * cases.length);
  await page.locator("#figures [data-axis=case]").selectOption({ label: "office" });
  assert.deepEqual((await names()).sort(), methods.map((method) => `${method}, office`).sort());
  for (const [i, name] of (await names()).entries()) {
    const all = trials(name.replace(", office", ""), ["office"]);
    assert.equal((await rows().nth(i).locator("td").allInnerTexts())[0], String(counted(all, "right")));
  }
  await page.locator("#level").selectOption("run");
  assert.equal(await rows().count(), methods.length * seeds.length);
  await page.locator("#figures input[type=search]").fill("indexed");
  assert.equal(await rows().count(), seeds.length);
  await page.locator("#figures input[type=search]").fill("");
  await page.locator("#figures [data-axis=case]").selectOption({ label: "all" });
  await page.locator("#level").selectOption("setting");
  await drawn(page);
  assert.equal(await page.locator("[data-boxes=steps] [data-run]").count(), methods.length);
});

test("what differs in the configuration is told of methods and cases, not of each run", { skip }, async () => {
  await page.locator("#configuration input[type=search]").fill("iterations");
  const told = await page.locator("#configuration tbody").innerText();
  for (const method of methods) assert.ok(told.includes(method), told);
  assert.ok(!told.includes("seed-"), told);
  await page.locator("#configuration input[type=search]").fill("");
});

test("on a telephone tables fit, with a name, right, wrong and steps", { skip }, async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  await drawn(page);
  assert.equal(await rows().first().locator("td:visible").count(), 3);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  const wide = await page.locator("table").evaluateAll((tables) => tables.filter((table) => table.checkVisibility() && !table.closest(".scroll") && table.getBoundingClientRect().right > innerWidth).map((table) => table.closest("section")?.id));
  assert.deepEqual(wide, []);
  await page.setViewportSize({ width: 1366, height: 768 });
});

test("all is in one file of less than 3 MB", { skip }, () => {
  assert.ok(statSync(file).size < 3e6);
  assert.equal(existsSync(file.replace(".html", "_steps")), false);
});

test("every column of a table tells what it is", { skip }, () => assertTablesExplained(page, 30));

test("axe finds nothing serious", { skip }, () => assertAccessibleInBoth(page, "methods"));
