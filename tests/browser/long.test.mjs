// A drive of 5,000 steps: the steps of a real run, over and over. How long it takes is told, not tested: machines differ.
import assert from "node:assert/strict";
import { copyFileSync, linkSync, mkdirSync, readdirSync, readFileSync, renameSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { assertQuiet, closeBrowser, moveSlider, open, skip } from "./open.mjs";
import { report, runExperiment, stepsOf, workFolder } from "./runs.mjs";
import { checkSteps } from "./steps_check.mjs";

const length = 5000;
const work = workFolder();
after(closeBrowser);

function lengthened(folder, out) {
  mkdirSync(join(out, "maps", "trial_0000"), { recursive: true });
  for (const name of ["effective.yaml", "provenance.json", "trials.jsonl", "maps/global.pcd"]) copyFileSync(join(folder, name), join(out, name));
  const steps = stepsOf(folder, 0);
  const padded = (k) => String(k).padStart(4, "0");
  const clusters = steps.flatMap((step) => step.best);
  const lines = [];
  for (let k = 0; k < length; ++k) {
    const source = k % steps.length;
    const best = Array.from({ length: 50 }, (_, i) => clusters[(50 * k + i) % clusters.length]);
    lines.push(JSON.stringify({ ...steps[source], step: k, best, clusters: 50 }));
    for (const kind of ["step", "scan"]) {
      linkSync(join(folder, "maps", "trial_0000", `${kind}_${padded(source)}.pcd`), join(out, "maps", "trial_0000", `${kind}_${padded(k)}.pcd`));
    }
  }
  const summary = JSON.parse(readFileSync(join(folder, "summary.json"), "utf8"));
  writeFileSync(join(out, "summary.json"), JSON.stringify({ ...summary, steps: length }));
  writeFileSync(join(out, "steps.jsonl"), `${lines.join("\n")}\n`);
  return out;
}

test("a run of 5,000 steps opens, and every step can be reached", { skip }, async (t) => {
  const folder = lengthened(runExperiment("paper_simulation", join(work, "short")), join(work, "long"));
  const file = report(join(work, "report.html"), folder);
  const beside = file.replace(".html", "_steps");
  const size = (name) => (statSync(name).size / 1e6).toFixed(1);
  t.diagnostic(`${size(file)} MB, and ${readdirSync(beside).map((name) => size(join(beside, name)))} MB beside it`);
  assert.ok(statSync(file).size < 3e6);
  const begin = performance.now();
  const opened = await open(file);
  t.diagnostic(`opened after ${Math.round(performance.now() - begin)} ms, with the browser's own start`);
  const steps = stepsOf(folder, 0);
  await checkSteps(opened.page, steps, [0, 1234, 4999]);
  const moves = performance.now();
  for (let k = 0; k < length; k += 250) await moveSlider(opened.page, k);
  t.diagnostic(`${Math.round((performance.now() - moves) / 20)} ms from one step to another, drawn`);
  assert.equal(await opened.page.locator("input[type=range]").getAttribute("max"), "4999");
  assertQuiet(opened);
  // Without its folder the page says what is missing.
  renameSync(beside, `${beside}_elsewhere`);
  const alone = await open(file);
  assert.match(await alone.page.locator(".map .note").innerText(), /steps lie in the folder report_steps beside this page, where \w+_0\.js is missing/);
  assert.equal(await alone.page.locator("#figures .answer strong").innerText(), "right");
});
