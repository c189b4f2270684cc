// What axe-core has against a page.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const axe = readFileSync(createRequire(join(process.env.GLOCAL_BROWSER_PACKAGES, "package.json")).resolve("axe-core/axe.min.js"), "utf8");

/** Nothing serious or critical by WCAG 2.1 A and AA, and by what else axe holds good practice. */
export async function assertAccessible(page, what) {
  await page.evaluate(axe);
  const found = await page.evaluate(async () => {
    const { violations } = await window.axe.run(document, { resultTypes: ["violations"] });
    return violations.map(({ id, impact, nodes }) => ({ id, impact, nodes: nodes.slice(0, 3).map(({ html, failureSummary }) => `${html.slice(0, 160)}: ${failureSummary}`), count: nodes.length }));
  });
  assert.deepEqual(found.filter(({ impact }) => impact === "serious" || impact === "critical"), [], what);
  return found;
}

/** The same on light and on dark paper. */
export async function assertAccessibleInBoth(page, what) {
  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    await page.waitForFunction((theme) => document.documentElement.dataset.theme === theme, colorScheme);
    await assertAccessible(page, `${what}, ${colorScheme}`);
  }
}
