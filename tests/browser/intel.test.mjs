// A real log: 42 trials of a few steps each.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { assertAccessibleInBoth } from "./accessible.mjs";
import { drawn, moveSlider, open, skip as noBrowser, testsOn } from "./open.mjs";
import { report, runExperiment, stepsOf, trialsOf, workFolder } from "./runs.mjs";
import { checkClusters, checkSteps } from "./steps_check.mjs";

const skip = noBrowser || (process.env.GLOCAL_DATASETS ? false : "GLOCAL_DATASETS is not set");
const work = workFolder();
let folder, trials, page;

testsOn(async () => {
  folder = runExperiment("intel", join(work, "intel"), "--jobs", "2");
  trials = trialsOf(folder);
  return ({ page } = await open(report(join(work, "report.html"), folder)));
}, skip);

test("every trial can be chosen, and shows its own steps", { skip }, async () => {
  assert.equal(await page.locator("#trial option").count(), trials.length);
  for (const { trial, outcome } of [trials[0], trials[7], trials.at(-1)]) {
    await page.locator("#trial").selectOption(String(trial));
    await drawn(page);
    const steps = stepsOf(folder, trial);
    assert.match(await page.locator("#trial option:checked").innerText(), new RegExp(outcome));
    assert.equal(await page.locator("input[type=range]").getAttribute("max"), String(steps.length - 1));
    await checkSteps(page, steps, [0, steps.length >> 1, steps.length - 1]);
  }
});

test("clusters of a real log are drawn where they are", { skip }, async () => {
  await page.locator("#trial").selectOption("0");
  await moveSlider(page, 0);
  assert.ok((await checkClusters(page, stepsOf(folder, 0)[0])) >= 1);
});

test("a trial opens at its first declaration, or else at its last step", { skip }, async () => {
  for (const { trial } of [trials[1], trials[7]]) {
    await page.locator("#trial").selectOption(String(trial));
    const steps = stepsOf(folder, trial);
    const declared = steps.findIndex(({ verdict }) => verdict === "localized");
    assert.equal(await page.evaluate(() => document.body.dataset.step), String(declared < 0 ? steps.length - 1 : declared));
  }
});

test("the list of trials tells what trials.jsonl does, and leads to a trial", { skip }, async () => {
  const rows = page.locator("#trials tbody tr");
  assert.equal(await rows.count(), trials.length);
  const trial = trials[3];
  const text = await rows.nth(3).innerText();
  for (const part of [trial.outcome, String(trial.steps), trial.translation_error_m.toFixed(3)]) assert.ok(text.includes(part), text);
  await rows.nth(3).locator("[data-trial]").click();
  await drawn(page);
  assert.equal(await page.locator("#trial").inputValue(), "3");
});

test("trials are chosen by their outcome, and sorted by what they needed", { skip }, async () => {
  const rows = page.locator("#trials tbody tr");
  const outcomes = [...new Set(trials.map(({ outcome }) => outcome))];
  for (const outcome of outcomes.length > 1 ? outcomes : []) {
    await page.locator(`#trials [data-outcome=${outcome}]`).click();
    assert.equal(await rows.count(), trials.filter((trial) => trial.outcome === outcome).length);
  }
  if (outcomes.length > 1) await page.locator('#trials [data-outcome=""]').click();
  await page.locator("#trials [data-sort=steps]").click();
  const numbers = (await rows.locator("th button[data-trial]").allInnerTexts()).map(Number);
  const steps = numbers.map((number) => trials[number].steps);
  assert.deepEqual(steps, [...steps].sort((a, b) => a - b));
  await page.locator("#trials [data-sort=trial]").click();
});

test("the verdict of the trial and of the step are above the map", { skip }, async () => {
  await page.locator("#trial").selectOption("3");
  await drawn(page);
  const told = page.locator(".trial-outcome");
  assert.match(await told.innerText(), new RegExp(`^Trial 3: ${trials[3].outcome} – `));
  assert.ok((await told.boundingBox()).y < (await page.locator("figure.map").boundingBox()).y);
});

test("the summary counts the trials", { skip }, async () => {
  const right = trials.filter(({ outcome }) => outcome === "right").length;
  const wrong = trials.filter(({ outcome }) => outcome === "wrong").length;
  const row = page.locator("#summary tr", { hasText: "right, wrong, undecided" });
  assert.match(await row.innerText(), new RegExp(`${right}, ${wrong}, ${trials.length - right - wrong}`));
});

test("the share of localized trials ends at that of right ones", { skip }, async () => {
  await page.locator("[data-share=over_steps] canvas").waitFor();
  // A run alone has curves of all that is told over trials, and no boxes beside each other.
  assert.equal(await page.locator("#distributions .plot canvas").count(), 5);
  assert.equal(await page.locator("#distributions [data-boxes]").count(), 0);
});

test("axe finds nothing serious", { skip }, () => assertAccessibleInBoth(page, "intel"));
