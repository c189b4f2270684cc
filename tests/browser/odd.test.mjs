// Runs in which something is missing, and names that look like markup.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, test } from "node:test";
import { assertQuiet, closeBrowser, open, moveSlider, skip } from "./open.mjs";
import { interruptedRun, report, runExperiment, stepsOf, trialsOf, workFolder } from "./runs.mjs";
import { checkSteps } from "./steps_check.mjs";

const work = workFolder();
after(closeBrowser);

test("a run with no hypothesis at all", { skip }, async () => {
  const folder = runExperiment("paper_lab", join(work, "none"), "--set", "localizer.matcher.ransam.iterations=1", "--set", "localizer.threshold_policy.sliding_window.initial=1");
  const steps = stepsOf(folder, 0);
  assert.equal(Math.max(...steps.map((step) => step.hypotheses)), 0);
  const opened = await open(report(join(work, "none.html"), folder));
  await checkSteps(opened.page, steps, [0, steps.length - 1]);
  assert.match(await opened.page.locator(".map .note").innerText(), /No hypothesis in this step/);
  await opened.page.locator("[data-hypothesis=reference]").click();
  assertQuiet(opened);
});

test("an interrupted run", { skip }, async () => {
  const folder = join(work, "interrupted");
  const code = await interruptedRun("paper_variants", folder, 2, "--set", "variants={}", "--set", "output.maps=all", "--set", "localizer.matcher.ransam.iterations=2000000");
  assert.equal(code, 3);
  const trials = trialsOf(folder);
  assert.ok(trials.length >= 2);
  const opened = await open(report(join(work, "interrupted.html"), folder));
  assert.match(await opened.page.locator("#summary .warning").innerText(), /Interrupted/);
  assert.equal(await opened.page.locator("#trial option").count(), trials.length);
  const steps = stepsOf(folder, trials.at(-1).trial);
  await opened.page.locator("#trial").selectOption(String(trials.length - 1));
  await checkSteps(opened.page, steps, [steps.length - 1]);
  assertQuiet(opened);
});

test("a run interrupted before its first trial was finished", { skip }, async () => {
  const folder = join(work, "at_once");
  const code = await interruptedRun("paper_simulation", folder, 0, "--set", "localizer.matcher.ransam.iterations=2000000");
  assert.equal(code, 3);
  assert.deepEqual(trialsOf(folder), []);
  const opened = await open(report(join(work, "at_once.html"), folder));
  assert.match(await opened.page.locator(".map .note").innerText(), /No trial was finished/);
  await opened.page.keyboard.press("]");
  assertQuiet(opened);
});

test("a run without steps and maps", { skip }, async () => {
  const folder = runExperiment("paper_lab", join(work, "bare"), "--set", "output.steps=false", "--set", "output.maps=none");
  const opened = await open(report(join(work, "bare.html"), folder));
  assert.match(await opened.page.locator(".map .note").innerText(), /no global map.*no steps/s);
  await opened.page.keyboard.press("ArrowRight");
  assertQuiet(opened);
});

test("names that look like markup show as text", { skip }, async () => {
  const name = "<script>window.hacked=1<img src=x onerror=alert(1)>&amp;";
  const folder = runExperiment("paper_lab", join(work, name));
  const opened = await open(report(join(work, "names.html"), folder));
  assert.equal(await opened.page.locator("h1 .run-name").innerText(), name);
  assert.ok((await opened.page.title()).includes(name));
  assert.equal(await opened.page.evaluate(() => window.hacked), undefined);
  await moveSlider(opened.page, 1);
  assertQuiet(opened);
});
