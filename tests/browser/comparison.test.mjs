// Three variants on the same starts.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { drawn, open, skip, testsOn } from "./open.mjs";
import { glocal, report, runExperiment, stepsOf, workFolder } from "./runs.mjs";
import { checkSteps } from "./steps_check.mjs";

const variants = ["paper", "fewer_draws", "indexed"]; // in the order of the file
const work = workFolder();
let folder, page, comparison, best;

const summaryOf = (name) => JSON.parse(readFileSync(join(folder, name, "summary.json"), "utf8"));

testsOn(async () => {
  const only = variants.flatMap((name) => ["--only", name]);
  folder = runExperiment("paper_variants", join(work, "variants"), "--set", "output.maps=first_trial", ...only);
  const compared = join(work, "comparison.json");
  glocal("compare", folder, "-o", compared);
  comparison = JSON.parse(readFileSync(compared, "utf8"));
  const score = (name) => summaryOf(name).trials.right - summaryOf(name).trials.wrong;
  best = [...variants].sort((a, b) => score(b) - score(a) || summaryOf(a).steps_to_localize.median - summaryOf(b).steps_to_localize.median);
  return ({ page } = await open(report(join(work, "report.html"), folder)));
});

test("each run can be chosen, and goes on showing the same trial", { skip }, async () => {
  assert.deepEqual(await page.locator("#run option").allInnerTexts(), best);
  await page.locator("#trial").selectOption("2");
  for (const [i, name] of best.entries()) {
    await page.locator("#run").selectOption(String(i));
    await drawn(page);
    assert.equal(await page.locator("#trial").inputValue(), "2");
    const steps = stepsOf(join(folder, name), 2);
    await checkSteps(page, steps, [0, steps.length - 1]);
  }
});

const rows = () => page.locator("#figures tbody tr:not(.unfolded)");
const names = () => rows().locator("[data-run]").allInnerTexts();

test("the page begins with what came out of each run, the best first", { skip }, async () => {
  assert.match(await page.locator("h1").innerText(), /^paper_variants\s+3 runs$/);
  assert.deepEqual(await names(), best);
  const heads = await page.locator("#figures thead th").allInnerTexts();
  assert.deepEqual(heads.slice(0, 4), ["name", "right", "wrong", "steps"]);
  for (const [i, name] of best.entries()) {
    const summary = summaryOf(name);
    const cells = await rows().nth(i).locator("td").allInnerTexts();
    const told = (head) => cells[heads.indexOf(head) - 1];
    for (const outcome of ["right", "wrong", "undecided"]) assert.equal(told(outcome), String(summary.trials[outcome]));
    assert.equal(told("steps"), summary.steps_to_localize.median.toFixed(1).replace(".0", ""));
    assert.equal(told("error, m"), summary.translation_error_m.median.toFixed(3));
    const [bar, right] = await rows().nth(i).locator(".outcomes").evaluate((bar) => [bar, bar.querySelector(".right")].map((e) => e.getBoundingClientRect().width));
    assert.ok(Math.abs(right / bar - summary.success_rate.value) < 0.01);
  }
  await rows().nth(1).locator("[data-run]").click();
  assert.equal(await page.locator("#run").inputValue(), "1");
});

test("rows are sorted by a click on a head, the best first and then the other way round", { skip }, async () => {
  const head = page.locator("#figures thead .sort", { hasText: /^time, ms$/ });
  const times = async () => {
    const heads = await page.locator("#figures thead th").allInnerTexts();
    return Promise.all((await rows().all()).map(async (row) => Number((await row.locator("td").allInnerTexts())[heads.findIndex((text) => text.startsWith("time")) - 1])));
  };
  await head.click();
  const ascending = await times();
  assert.deepEqual(ascending, [...ascending].sort((a, b) => a - b));
  assert.equal(await page.locator("#figures th[aria-sort]").getAttribute("aria-sort"), "ascending");
  await page.locator("#figures th[aria-sort] .sort").click();
  assert.deepEqual(await times(), [...ascending].reverse());
  await page.locator("#figures th[aria-sort] .sort").click();
  assert.deepEqual(await names(), best);
});

test("runs are found by words of their names and of what they set otherwise", { skip }, async () => {
  const search = page.locator("#figures input[type=search]");
  await search.fill("iterations=25000");
  assert.deepEqual(await names(), ["fewer_draws"]);
  assert.match(await page.locator("#figures output").innerText(), /1 of 3 runs/);
  // What is looked at together is what was found.
  await drawn(page);
  assert.equal(await page.locator("#distributions [data-boxes]").count(), 0);
  await search.fill("RANSAM paper");
  assert.deepEqual(await names(), best.filter((name) => name !== "indexed" && name !== "fewer_draws"));
  await search.fill("");
  assert.deepEqual(await names(), best);
});

test("on a telephone a row has its name, right, wrong and steps, and the rest below it when asked for", { skip }, async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  await drawn(page);
  const cells = rows().first().locator("td:visible");
  assert.equal(await cells.count(), 3);
  await rows().first().locator(".unfold").click();
  const told = await page.locator("#figures .unfolded").innerText();
  for (const part of ["undecided", "time, ms", "error, m", summaryOf(best[0]).translation_error_m.median.toFixed(3)]) assert.ok(told.includes(part), told);
  await rows().first().locator(".unfold").click();
  assert.equal(await page.locator("#figures .unfolded").count(), 0);
  await page.setViewportSize({ width: 1366, height: 768 });
  await drawn(page);
  assert.ok((await cells.count()) > 8);
});

test("curves of runs can be hidden and shown", { skip }, async () => {
  const boxes = page.locator(".curves .runs input");
  assert.equal(await boxes.count(), 3);
  await page.locator("#run").selectOption("0");
  await boxes.nth(1).uncheck();
  await drawn(page);
  assert.equal(await page.locator("[data-curve=clusters] canvas").count(), 1);
  await page.locator(".curves .runs input").nth(1).check();
});

test("the comparison is that of glocal compare", { skip }, async () => {
  const text = await page.locator("#comparison").innerText();
  for (const pair of comparison.pairs) assert.ok(text.includes(pair.conclusion), pair.conclusion);
  // Where no start differs, there is nothing to test.
  const differs = ({ differing_places: places }) => places > 0;
  const tests = comparison.pairs.flatMap((pair) => [...pair.outcomes, ...pair.measures]);
  assert.equal(await page.locator("#comparison .tests tbody tr").count(), tests.filter(differs).length);
  assert.equal(await page.locator("#comparison tbody tr").count(), tests.filter(differs).length + comparison.methods.length);
  assert.ok(tests.some((test) => !differs(test)) === /no start differs in/.test(await page.locator("#comparison").evaluate((e) => e.textContent)));
});

test("what differs in the configuration comes first, marked, and the rest on demand", { skip }, async () => {
  const rows = page.locator("#configuration tbody tr");
  const [different, all] = /\((\d+) of (\d+)\)/.exec(await page.locator("#configuration label").innerText()).slice(1).map(Number);
  assert.equal(await rows.count(), Math.min(different, 40));
  if (different > 40) await page.locator("#configuration .all").click();
  assert.equal(await rows.count(), different);
  const draws = rows.filter({ has: page.locator("th", { hasText: /matcher\.ransam\.iterations$/ }) });
  assert.ok((await draws.locator("mark").allInnerTexts()).includes("25000"));
  await page.locator("#configuration input[type=checkbox]").uncheck();
  if (different <= 40) await page.locator("#configuration .all").click();
  assert.equal(await rows.count(), all);
  await page.locator("#configuration input[type=search]").fill("unknown_place");
  for (const text of await rows.allInnerTexts()) assert.ok(text.includes("unknown_place"));
  assert.equal(await page.locator("#configuration tbody tr mark").count(), 0);
});

test("on a telephone, headings of charts leave room for what stands beside them", { skip }, async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  await drawn(page);
  const covered = await page.locator(".panel h3").evaluateAll((all) =>
    all.flatMap((heading) => {
      const text = document.createRange();
      text.selectNodeContents(heading);
      const beside = [...heading.parentElement.querySelectorAll(".save summary, .choices button, :scope > label")].map((part) => part.getBoundingClientRect());
      const isOver = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
      return [...text.getClientRects()].some((line) => beside.some((box) => isOver(line, box))) ? [heading.textContent] : [];
    }),
  );
  assert.ok((await page.locator(".panel h3").count()) > 10);
  assert.deepEqual(covered, []);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
});
