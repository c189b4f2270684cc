// A run that is watched while it goes on.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, test } from "node:test";
import { assertAccessibleInBoth } from "./accessible.mjs";
import { closeBrowser, open, skip } from "./open.mjs";
import { experiments, program, stepsOf, workFolder } from "./runs.mjs";

const work = workFolder();
after(closeBrowser);

/** Starts a run; its page's address, and its exit code when it has ended. */
async function watchedRun(name, out, ...parameters) {
  const run = spawn(program, ["run", join(experiments, `${name}.yaml`), "--out", out, "--watch", ...parameters], {
    stdio: ["ignore", "ignore", "pipe"],
  });
  const ended = new Promise((resolve) => run.on("exit", resolve));
  for await (const line of createInterface({ input: run.stderr })) {
    const address = /http:\/\/127\.0\.0\.1:\d+\//.exec(line);
    if (address) {
      run.stderr.resume();
      return { run, ended, address: address[0] };
    }
  }
  throw new Error("the run told no address");
}

test("the page shows the run as it goes on, and keeps what it has when the program ends", { skip }, async () => {
  const out = join(work, "watched");
  // Slow enough to be looked at.
  const { run, ended, address } = await watchedRun("paper_simulation", out, "--set", "localizer.matcher.ransam.iterations=6000000");
  const { page, noted } = await open(address);
  const last = () => page.locator("input[type=range]").getAttribute("max").then(Number);
  const first = await last();
  await page.waitForFunction((before) => Number(document.querySelector("input[type=range]").max) > before + 2, first);
  assert.match(await page.locator(".live").innerText(), /paper_simulation: running, 0 of 1 trials/);
  // The page begins with the newest step, and who looks at that stays there.
  assert.ok((await page.locator(".map .note").innerText()).includes("only the newest step") === false);
  await page.waitForFunction(() => document.body.dataset.step === document.querySelector("input[type=range]").max);
  await page.keyboard.press("Home");
  const grown = await last();
  await page.waitForFunction((before) => Number(document.querySelector("input[type=range]").max) > before, grown);
  assert.equal(await page.evaluate(() => document.body.dataset.step), "0");
  assert.match(await page.locator(".map .note").innerText(), /only the newest step has its local map/);
  // News leave the list of trials as the reader has it.
  const sorted = page.locator("#trials th[aria-sort=ascending]");
  await page.locator('#trials [data-sort="error, m"]').click();
  const then = await last();
  await page.waitForFunction((before) => Number(document.querySelector("input[type=range]").max) > before, then);
  assert.equal(await sorted.innerText(), "error, m");
  await assertAccessibleInBoth(page, "a run that goes on");
  run.kill("SIGINT");
  assert.equal(await ended, 3);
  await page.waitForFunction(() => /does not answer|finished/.test(document.querySelector(".live").textContent));
  assert.doesNotMatch(await page.locator(".live").innerText(), /[^.] The program/);
  // What it shows is what the run would have written of the step; a trial that was not finished is not kept.
  assert.match(await page.locator(".details").innerText(), /Ω best/);
  const origin = new URL(address).origin;
  assert.ok(noted.requests.every((url) => url.startsWith(`${origin}/`) || url.startsWith("data:")));
  assert.deepEqual(noted.errors.filter((text) => !text.includes("ERR_CONNECTION_REFUSED")), []);
});

test("a finished run is shown whole", { skip }, async () => {
  const out = join(work, "whole");
  const { ended, address } = await watchedRun("paper_lab", out, "--set", "localizer.matcher.ransam.iterations=400000");
  const { page } = await open(address);
  assert.equal(await ended, 0);
  const steps = stepsOf(out, 0);
  // The last answer may have come before the last steps: what is shown is right as far as it goes.
  await page.waitForFunction(() => /does not answer|finished/.test(document.querySelector(".live").textContent));
  const shown = Number(await page.locator("input[type=range]").getAttribute("max"));
  assert.ok(shown >= 0 && shown < steps.length);
  const told = await page.locator('.details dt:text-is("clusters") + dd').innerText();
  assert.equal(Number(told.replaceAll(",", "")), steps[shown].clusters);
});
