// Takes a picture of a report: node picture.mjs REPORT OUT.png TRIAL STEP
import { closeBrowser, moveSlider, open } from "./open.mjs";

const [report, out, trial, step] = process.argv.slice(2);
const { page } = await open(report, { viewport: { width: 1366, height: 900 }, colorScheme: "light" });
await page.locator("#trial").evaluate((select, value) => {
  select.value = value;
  select.dispatchEvent(new Event("change"));
}, trial);
await moveSlider(page, Number(step));
await page.screenshot({ path: out });
await closeBrowser();
