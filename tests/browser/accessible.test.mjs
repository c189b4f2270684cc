// Pages for everybody: axe-core, the keyboard, light and dark, paper.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { assertAccessible } from "./accessible.mjs";
import { assertQuiet, closeBrowser, open, skip } from "./open.mjs";
import { report, runExperiment, workFolder } from "./runs.mjs";

const work = workFolder();
const files = {};

before(() => {
  if (skip) return;
  const run = (name, experiment, ...parameters) => {
    files[name] = report(join(work, `${name}.html`), runExperiment(experiment, join(work, name), ...parameters));
  };
  run("simulation", "paper_simulation");
  run("variants", "paper_variants", "--set", "output.maps=first_trial", "--only", "fewer_draws", "--only", "paper");
  run("single", "paper_variants", "--set", "variants={}", "--set", "trials.max_steps=1", "--set", "trials.min_steps=1");
});
after(closeBrowser);

for (const colorScheme of ["light", "dark"]) {
  test(`axe finds nothing serious on ${colorScheme} pages`, { skip }, async () => {
    for (const [name, file] of Object.entries(files)) {
      const opened = await open(file, { colorScheme });
      assert.equal(await opened.page.evaluate(() => document.documentElement.dataset.theme), colorScheme);
      await assertAccessible(opened.page, `${name}, ${colorScheme}`);
      assertQuiet(opened);
      await opened.page.close();
    }
  });
}

test("the keyboard reaches everything, and one sees where it is", { skip }, async () => {
  const opened = await open(files.variants);
  const { page } = opened;
  const all = await page.evaluate(() => {
    const isShown = (e) => e.checkVisibility() && !e.closest("details:not([open]) > :not(summary)");
    const reachable = "a[href], button:not([disabled]), select:not([disabled]), input:not([disabled]), summary, canvas[tabindex], [role=separator]";
    const found = [...document.querySelectorAll(reachable)].filter(isShown);
    found.forEach((e, i) => (e.dataset.reach = String(i)));
    return found.length;
  });
  assert.ok(all > 50, String(all));
  const reached = new Set();
  const unseen = [];
  await page.evaluate(() => document.activeElement?.blur());
  for (let i = 0; i < 600 && reached.size < all; ++i) {
    await page.keyboard.press("Tab");
    const { id, name, outline } = await page.evaluate(() => {
      const e = document.activeElement;
      const { outlineStyle, outlineWidth, strokeWidth } = getComputedStyle(e);
      const isOutlined = outlineStyle !== "none" && parseFloat(outlineWidth) >= 2;
      const isStroked = e instanceof SVGElement && parseFloat(strokeWidth) >= 2;
      return { id: e.dataset.reach, name: `${e.tagName}.${e.getAttribute("class")}`, outline: e === document.body || isOutlined || isStroked };
    });
    if (id !== undefined) reached.add(id);
    if (!outline) unseen.push(name);
  }
  assert.equal(reached.size, all);
  assert.deepEqual(unseen, []);
  // Pictures are saved by keyboard, too.
  await page.locator("[data-curve=clusters] summary").focus();
  await page.keyboard.press("Enter");
  await page.keyboard.press("Tab");
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
  assert.match(download.suggestedFilename(), /clusters\.svg$/);
  assertQuiet(opened);
});

test("paper is white, without controls", { skip }, async () => {
  const opened = await open(files.simulation, { colorScheme: "dark" });
  const { page } = opened;
  await page.emulateMedia({ media: "print" });
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  for (const part of [".player", ".zoom", ".border.vertical", ".csv", ".save", "header nav"])
    assert.equal(await page.locator(part).first().isVisible(), false, part);
  for (const part of [".stage canvas", "#figures", ".panel canvas", "#summary table"])
    assert.equal(await page.locator(part).first().isVisible(), true, part);
  assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), "rgb(255, 255, 255)");
  await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
  const pdf = await page.pdf();
  assert.equal(pdf.subarray(0, 5).toString(), "%PDF-");
});
