// Three variants on the same starts.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { assertQuiet, closeBrowser, drawn, open, skip } from "./open.mjs";
import { glocal, report, runExperiment, stepsOf, trialsOf, workFolder } from "./runs.mjs";
import { checkSteps } from "./steps_check.mjs";

const variants = ["paper", "fewer_draws", "indexed"]; // in the order of the file
let folder, opened, page, comparison;

before(async () => {
  if (skip) return;
  const work = workFolder();
  const only = variants.flatMap((name) => ["--only", name]);
  folder = runExperiment("paper_variants", join(work, "variants"), "--set", "output.maps=first_trial", ...only);
  const compared = join(work, "comparison.json");
  glocal("compare", folder, "-o", compared);
  comparison = JSON.parse(readFileSync(compared, "utf8"));
  opened = await open(report(join(work, "report.html"), folder));
  page = opened.page;
});
after(async () => {
  if (!skip) assertQuiet(opened);
  await closeBrowser();
});

test("each run can be chosen, and goes on showing the same trial", { skip }, async () => {
  assert.deepEqual(await page.locator("#run option").allInnerTexts(), variants);
  await page.locator("#trial").selectOption("2");
  for (const [i, name] of variants.entries()) {
    await page.locator("#run").selectOption(String(i));
    await drawn(page);
    assert.equal(await page.locator("#trial").inputValue(), "2");
    const steps = stepsOf(join(folder, name), 2);
    await checkSteps(page, steps, [0, steps.length - 1]);
  }
});

test("the page begins with what came out of each run", { skip }, async () => {
  assert.match(await page.locator("h1").innerText(), /^paper_variants\s+3 runs$/);
  for (const [i, name] of variants.entries()) {
    const summary = JSON.parse(readFileSync(join(folder, name, "summary.json"), "utf8"));
    const row = page.locator(`#figures tr[data-run="${i}"]`);
    assert.equal(await row.locator("th").innerText(), name);
    for (const outcome of ["right", "wrong", "undecided"])
      assert.equal(await row.locator(`[data-figure=${outcome}]`).innerText(), String(summary.trials[outcome]));
    assert.equal(await row.locator("[data-figure=error]").innerText(), `${summary.translation_error_m.median.toFixed(3)} m`);
    const [bar, right] = await row.locator(".outcomes").evaluate((bar) => [bar, bar.querySelector(".right")].map((e) => e.getBoundingClientRect().width));
    assert.ok(Math.abs(right / bar - summary.success_rate.value) < 0.01);
  }
  await page.locator('#figures tr[data-run="1"] button').click();
  assert.equal(await page.locator("#run").inputValue(), "1");
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
  const tests = comparison.pairs.reduce((n, pair) => n + pair.outcomes.length + pair.measures.length, 0);
  assert.equal(await page.locator("#comparison tbody tr").count(), tests);
});

test("success and its interval are those of the summaries", { skip }, async () => {
  const row = page.locator("#summary tr", { has: page.locator("th", { hasText: /^success$/ }) });
  const cells = await row.locator("td").allInnerTexts();
  variants.forEach((name, i) => {
    const { value, low, high } = JSON.parse(readFileSync(join(folder, name, "summary.json"), "utf8")).success_rate;
    const parts = [value, low, high].map((share) => (100 * share).toFixed(1));
    for (const part of parts) assert.ok(cells[i].includes(part), `${name}: ${cells[i]} for ${parts}`);
    assert.equal(trialsOf(join(folder, name)).filter(({ outcome }) => outcome === "right").length, Math.round(value * trialsOf(join(folder, name)).length));
  });
  // Success, and what was localized by steps and by distance.
  assert.equal(await page.locator("#distributions .plot canvas").count(), 3);
});

test("what differs in the configuration comes first, marked, and the rest on demand", { skip }, async () => {
  const rows = page.locator("#configuration tbody tr");
  const different = await rows.count();
  assert.ok(different >= 2);
  const draws = rows.filter({ has: page.locator("th", { hasText: /matcher\.ransam\.iterations$/ }) });
  assert.ok((await draws.locator("mark").allInnerTexts()).includes("25000"));
  await page.locator("#configuration input[type=checkbox]").uncheck();
  assert.ok((await rows.count()) > different);
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
