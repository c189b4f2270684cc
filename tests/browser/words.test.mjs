// What words and symbols mean, and the layout of trials of one step.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { assertTablesExplained } from "./meanings.mjs";
import { assertQuiet, moveSlider, open, painted, mapView, showOnly, skip, testsOn } from "./open.mjs";
import { pageModule } from "./page_module.mjs";
import { report, runExperiment, stepsOf, workFolder } from "./runs.mjs";

const work = workFolder();
let folder, page;

testsOn(async () => {
  folder = runExperiment("paper_simulation", join(work, "simulation"));
  return ({ page } = await open(report(join(work, "report.html"), folder)));
});

test("words mean what the glossary says", async () => {
  const { ofGlossary } = await pageModule("words");
  const glossary = readFileSync(join(process.env.GLOCAL_SOURCE_DIR, "docs/glossary.md"), "utf8").replace(/[*`\\]/g, "");
  assert.ok(Object.keys(ofGlossary).length > 20);
  for (const [word, text] of Object.entries(ofGlossary)) assert.ok(glossary.includes(text), `${word}: ${text}`);
});

test("every number of the step, of the clusters and of the header tells what it is", { skip }, async () => {
  for (const part of [".details dt", ".hypotheses thead th span", "#figures strong", ".panel[data-curve] h3 > span"]) {
    const bare = await page.locator(part).evaluateAll((all) => all.filter((e) => !e.dataset.meaning).map((e) => e.textContent));
    assert.ok((await page.locator(part).count()) > 0, part);
    assert.deepEqual(bare, [], part);
  }
  const bare = await page.locator(".map .legend label:has([data-layer])").evaluateAll((all) => all.filter((e) => !e.dataset.meaning).map((e) => e.textContent));
  assert.deepEqual(bare, []);
});

test("every column of a table tells what it is", { skip }, () => assertTablesExplained(page, 20));

test("meanings are told to pointer and keyboard", { skip }, async () => {
  const tip = page.locator("#meaning");
  assert.equal(await tip.isVisible(), false);
  const word = page.locator('.details dt:text-is("Ω′")');
  await word.hover();
  assert.match(await tip.innerText(), /^Mean, over the last τ′ scans/);
  assert.equal(await word.getAttribute("aria-describedby"), "meaning");
  await page.keyboard.press("Escape");
  assert.equal(await tip.isVisible(), false);
  await page.locator(".hypotheses thead span", { hasText: "r̄" }).focus();
  assert.match(await tip.innerText(), /divides r by the sum over all clusters/);
  const box = await tip.boundingBox();
  assert.ok(box.x >= 0 && box.x + box.width <= 1366);
  await page.keyboard.press("Escape");
});

test("the legend has the strip of verdicts and the circles of candidates", { skip }, async () => {
  const legend = await page.locator(".map .legend").innerText();
  for (const word of ["searching", "ambiguous", "localized", "unknown place", "candidates"]) assert.ok(legend.includes(word), word);
  const steps = stepsOf(folder, 0);
  const ambiguous = steps.findIndex(({ candidates }) => candidates?.length > 1);
  await moveSlider(page, ambiguous);
  await showOnly(page, "candidates");
  const view = await mapView(page);
  const circle = steps[ambiguous].candidates.map((pose) => view.toScreen(pose)).map(({ x, y }) => ({ x: x + 15, y }));
  assert.deepEqual(await painted(page, circle), circle.map(() => true));
  await showOnly(page);
  await page.evaluate(() => window.scrollTo(0, 0));
  assert.deepEqual(await painted(page, circle), circle.map(() => false));
});

test("a trial of one step has neither slider nor curves", { skip }, async () => {
  const single = runExperiment("paper_variants", join(work, "single"), "--set", "variants={}", "--set", "trials.max_steps=1", "--set", "trials.min_steps=1", "--set", "output.maps=all");
  const other = await open(report(join(work, "single.html"), single));
  for (const part of [".player", ".curves", ".border.vertical"]) assert.equal(await other.page.locator(part).isVisible(), false, part);
  const [map, details] = [await other.page.locator("figure.map").boundingBox(), await other.page.locator(".details").boundingBox()];
  assert.ok(details.x >= map.x + map.width && Math.abs(details.y - map.y) < 5, "the numbers are beside the map");
  assertQuiet(other);
});
