// What a page shows of all trials together: where they began, distributions side by side, and of very many.
import assert from "node:assert/strict";
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { assertQuiet, drawn, open, skip, testsOn } from "./open.mjs";
import { report, runExperiment, trialsOf, workFolder } from "./runs.mjs";

const variants = ["paper", "indexed"]; // in the order of the file
const work = workFolder();
let folder, page, trials;

testsOn(async () => {
  const only = variants.flatMap((name) => ["--only", name]);
  folder = runExperiment("paper_variants", join(work, "variants"), "--set", "output.maps=first_trial", "--set", "trials.every_m=1", ...only);
  trials = variants.map((name) => trialsOf(join(folder, name)));
  return ({ page } = await open(report(join(work, "report.html"), folder)));
});

const marks = (from) => from.locator(".starts-stage [data-trial]");
const runNames = () => page.locator("#run option").allInnerTexts();

/** Index of the trial, outcome and place on the drawing of each mark. */
function shown(from) {
  return marks(from).evaluateAll((all) =>
    all.map((mark) => {
      const [x, y] = /translate\(([-\d.]+) ([-\d.]+)\)/.exec(mark.getAttribute("transform")).slice(1).map(Number);
      return { trial: Number(mark.dataset.trial), outcome: mark.dataset.outcome, x, y };
    }),
  );
}

test("starts are where the trials began, and tell how they ended", { skip }, async () => {
  for (const [run, name] of (await runNames()).entries()) {
    await page.locator("#run").selectOption(String(run));
    await drawn(page);
    const expected = trials[variants.indexOf(name)];
    const found = (await shown(page)).sort((a, b) => a.trial - b.trial);
    assert.deepEqual(found.map(({ outcome }) => outcome), expected.map(({ outcome }) => outcome));
    // Two starts far apart tell the scale, and where all others must be.
    const places = expected.map(({ start }) => start.reference);
    const far = places.reduce((best, place, i) => (Math.abs(place.x - places[0].x) > Math.abs(places[best].x - places[0].x) ? i : best), 0);
    const scale = (found[far].x - found[0].x) / (places[far].x - places[0].x);
    assert.ok(scale > 1);
    for (const [i, place] of places.entries()) {
      assert.ok(Math.abs(found[0].x + scale * (place.x - places[0].x) - found[i].x) < 1, `x of trial ${i}`);
      assert.ok(Math.abs(found[0].y - scale * (place.y - places[0].y) - found[i].y) < 1, `y of trial ${i}`);
    }
    const legend = await page.locator(".starts .legend").innerText();
    for (const outcome of new Set(expected.map((trial) => trial.outcome)))
      assert.ok(legend.includes(`${outcome} ${expected.filter((trial) => trial.outcome === outcome).length}`), legend);
  }
});

test("a start opens its trial, by a click and by keys", { skip }, async () => {
  await page.locator("#run").selectOption("0");
  const last = (await marks(page).count()) - 1;
  await page.locator(`.starts-stage [data-trial="${last}"]`).click();
  await drawn(page);
  assert.equal(await page.locator("#trial").inputValue(), String(last));
  // A pointer that stays there would tell of this start whenever the page moves under it.
  await page.mouse.move(0, 0);
  // The tab key leads to the chosen one only.
  assert.equal(await page.locator('.starts-stage [tabindex="0"]').count(), 1);
  await page.locator('.starts-stage [tabindex="0"]').focus();
  const step = await page.evaluate(() => document.body.dataset.step);
  await page.keyboard.press("ArrowRight"); // from the last to the first
  await page.keyboard.press("ArrowRight");
  assert.match(await page.locator(".starts .tip").innerText(), /^trial 1: /);
  assert.equal(await page.evaluate(() => document.body.dataset.step), step, "arrow keys move among starts only");
  await page.keyboard.press("Enter");
  await drawn(page);
  assert.equal(await page.locator("#trial").inputValue(), "1");
  assert.equal(await page.locator(".starts-stage .chosen").getAttribute("data-trial"), "1");
});

test("by steps, fewer are brighter", { skip }, async () => {
  const [name] = await runNames();
  const expected = trials[variants.indexOf(name)];
  await page.locator("#run").selectOption("0");
  await page.locator(".starts .choices button", { hasText: "by steps" }).click();
  const fills = await marks(page).evaluateAll((all) => all.map((mark) => [Number(mark.dataset.trial), getComputedStyle(mark).fill]));
  const brightness = (colour) => colour.match(/[\d.]+/g).reduce((sum, part, i) => sum + part * [0.2126, 0.7152, 0.0722][i], 0);
  const right = fills.filter(([trial]) => expected[trial].outcome === "right").map(([trial, fill]) => [expected[trial].steps, brightness(fill)]);
  right.sort((a, b) => a[0] - b[0]);
  assert.ok(right[0][0] < right.at(-1)[0]);
  for (let i = 1; i < right.length; ++i) assert.ok(right[i][0] === right[i - 1][0] ? right[i][1] === right[i - 1][1] : right[i][1] < right[i - 1][1]);
  await page.locator(".starts .choices button", { hasText: "by outcome" }).click();
});

test("boxes have the quarters and the median of each variant's trials", { skip }, async () => {
  const quarterOf = (sorted, share) => {
    const at = share * (sorted.length - 1);
    const i = Math.floor(at);
    return sorted[i] + (at - i) * ((sorted[i + 1] ?? sorted[i]) - sorted[i]);
  };
  const chart = page.locator("[data-boxes=steps]");
  const ticks = await chart.locator(".tick").evaluateAll((all) =>
    all.map((tick) => [Number(tick.querySelector("text").textContent), Number(tick.querySelector("line").getAttribute("x1"))]),
  );
  const [first, last] = [ticks[0], ticks.at(-1)];
  const at = (value) => first[1] + ((value - first[0]) * (last[1] - first[1])) / (last[0] - first[0]);
  for (const [run, name] of (await runNames()).entries()) {
    const steps = trials[variants.indexOf(name)].filter(({ outcome }) => outcome === "right").map((trial) => trial.steps).sort((a, b) => a - b);
    assert.ok(steps.length >= 8, `${name}: ${steps.length} right trials`);
    const row = chart.locator(`[data-run="${run}"]`);
    assert.equal(Number(await row.locator(".value").textContent()), quarterOf(steps, 0.5));
    const [x, width] = await row.locator("rect").evaluate((box) => ["x", "width"].map((key) => Number(box.getAttribute(key))));
    assert.ok(Math.abs(x - at(quarterOf(steps, 0.25))) < 0.5, `${name}: ${x} for ${at(quarterOf(steps, 0.25))}`);
    assert.ok(Math.abs(x + width - at(quarterOf(steps, 0.75))) < 1.1, name);
  }
  // Without maps and steps of their own, too.
  assert.equal(await page.locator("[data-boxes]").count(), 5);
});

test("one trial has neither starts nor distributions", { skip }, async () => {
  const single = await open(report(join(work, "single.html"), runExperiment("paper_lab", join(work, "single"))));
  assert.equal(await single.page.locator("#distributions").count(), 0);
  assertQuiet(single);
});

/** The run's trials, over and over, at other places; without steps. */
function multiplied(source, out, count) {
  mkdirSync(join(out, "maps"), { recursive: true });
  for (const name of ["provenance.json", "maps/global.pcd"]) copyFileSync(join(source, name), join(out, name));
  writeFileSync(join(out, "effective.yaml"), readFileSync(join(source, "effective.yaml"), "utf8").replace(/^( *steps:) true$/m, "$1 false"));
  const all = trialsOf(source);
  const lines = Array.from({ length: count }, (_, k) => {
    const trial = all[k % all.length];
    const reference = { ...trial.start.reference, x: trial.start.reference.x + 0.002 * (k % 97), y: trial.start.reference.y + 0.002 * (k % 89) };
    return JSON.stringify({ ...trial, trial: k, start: { ...trial.start, sample: k, distance_m: k, reference } });
  });
  writeFileSync(join(out, "trials.jsonl"), `${lines.join("\n")}\n`);
  const summary = JSON.parse(readFileSync(join(source, "summary.json"), "utf8"));
  summary.trials.count = count;
  writeFileSync(join(out, "summary.json"), JSON.stringify(summary));
  return out;
}

test("5,000 trials can be looked at", { skip }, async (t) => {
  const many = multiplied(join(folder, "paper"), join(work, "many"), 5000);
  const begin = performance.now();
  const large = await open(report(join(work, "many.html"), many));
  t.diagnostic(`reported and opened after ${Math.round(performance.now() - begin)} ms`);
  assert.equal(await marks(large.page).count(), 5000);
  const clicked = performance.now();
  await large.page.locator('.starts-stage [data-trial="4321"]').evaluate((mark) => mark.dispatchEvent(new MouseEvent("click", { bubbles: true })));
  await drawn(large.page);
  t.diagnostic(`a trial opened after ${Math.round(performance.now() - clicked)} ms`);
  assert.equal(await large.page.locator("#trial").inputValue(), "4321");
  // Rows come in two goes, so that the page opens at once.
  const rows = large.page.locator("#trials tbody tr");
  assert.equal(await rows.count(), 50);
  await large.page.locator("#trials button", { hasText: "all 5,000 trials" }).click();
  assert.equal(await rows.count(), 5000);
  assertQuiet(large);
});
