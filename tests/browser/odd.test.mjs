// Runs in which something is missing, and names that look like markup.
import assert from "node:assert/strict";
import { cpSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { assertQuiet, closeBrowser, isTaken, open, moveSlider, skip } from "./open.mjs";
import { interruptedRun, report, runExperiment, stepsOf, trialsOf, workFolder } from "./runs.mjs";
import { checkSteps } from "./steps_check.mjs";

const work = workFolder();
after(closeBrowser);

/** The results of a run, with its trials and summary changed. */
function changed(folder, out, trials, summary) {
  cpSync(folder, out, { recursive: true });
  writeFileSync(join(out, "trials.jsonl"), trialsOf(folder).flatMap(trials).map((line) => `${JSON.stringify(line)}\n`).join(""));
  writeFileSync(join(out, "summary.json"), JSON.stringify({ ...JSON.parse(readFileSync(join(folder, "summary.json"), "utf8")), ...summary }));
  return out;
}

/** What the page's summary says of these. */
function summaryOf(page, names) {
  return Promise.all(names.map((name) => page.locator(`#summary tr:has(span:text-is("${name}")) td`).innerText()));
}

const rates = ["success", "wrong"];
const times = ["wall time of a step, median (95 %)", "matching, median"];

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
  assert.deepEqual(await summaryOf(opened.page, [...rates, ...times]), ["–", "–", "–", "–"]);
  assert.equal(await opened.page.locator('#figures [data-figure="wall time of a step"] dd').innerText(), "–");
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

test("declarations that nothing judges", { skip }, async () => {
  const lab = runExperiment("paper_lab", join(work, "judged"), "--set", "output.maps=none");
  const unjudged = ({ translation_error_m, rotation_error_deg, ...line }) => [{ ...line, outcome: "declared" }];
  const count = trialsOf(lab).length;
  const folder = changed(lab, join(work, "unjudged"), unjudged, { trials: { count, right: 0, wrong: 0, undecided: 0, declared_without_reference: count } });
  const opened = await open(report(join(work, "unjudged.html"), folder));
  assert.deepEqual(await summaryOf(opened.page, ["declared, not judged", ...rates]), [String(count), "–", "–"]);
  const judged = await open(report(join(work, "judged.html"), lab));
  assert.deepEqual(await summaryOf(judged.page, rates), ["100.0 % (20.7 to 100.0 %)", "0.0 % (0.0 to 79.3 %)"]);
  assert.equal(await judged.page.locator('#summary span:text-is("declared, not judged")').count(), 0);
  for (const each of [opened, judged]) assertQuiet(each);
});

test("runs of which one has no trials, and none has steps", { skip }, async () => {
  const right = runExperiment("paper_lab", join(work, "right"), "--set", "output.steps=false", "--set", "output.maps=none");
  const wrong = changed(right, join(work, "wrong"), (line) => [{ ...line, outcome: "wrong" }], { trials: { count: 1, right: 0, wrong: 1, undecided: 0 } });
  const empty = changed(right, join(work, "empty"), () => [], { complete: false, trials: { count: 0, right: 0, wrong: 0, undecided: 0 }, steps: 0 });
  const opened = await open(report(join(work, "three.html"), right, wrong, empty));
  const rows = opened.page.locator("#figures tbody tr");
  const names = () => rows.locator("[data-run]").allInnerTexts();
  assert.deepEqual(await names(), ["right", "wrong", "empty (incomplete)"]);
  // Last of the worst, too; and the chosen run stays marked.
  for (const order of [["right", "wrong"], ["wrong", "right"]]) {
    await opened.page.locator("#figures [data-sort=score]").click();
    assert.deepEqual(await names(), [...order, "empty (incomplete)"]);
    assert.deepEqual(await rows.locator("[data-run][aria-pressed=true]").allInnerTexts(), ["right"]);
  }
  const heads = await opened.page.locator("#figures thead th").allInnerTexts();
  const cells = await rows.filter({ has: opened.page.locator("[data-run][aria-pressed=true]") }).locator("td").allInnerTexts();
  const time = Number(cells[heads.findIndex((text) => text.startsWith("time")) - 1]);
  const { median } = JSON.parse(readFileSync(join(right, "summary.json"), "utf8")).step_ms;
  assert.ok(Math.abs(time - median) <= 0.051 * median, `${time} for ${median}`);
  // There is no player, so keys are the browser's.
  assert.equal(await isTaken(opened.page, { key: "End" }), false);
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
