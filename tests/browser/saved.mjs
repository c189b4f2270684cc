// Files that a page saves.
import { readFileSync } from "node:fs";
import { pixelsOf } from "./open.mjs";

/** What a button saves: the file's name and its content. */
export async function saved(page, button) {
  const menu = button.locator("xpath=ancestor::details");
  if ((await menu.count()) > 0) await menu.evaluate((element) => (element.open = true));
  // By pointer: a page may save few files that nobody has clicked for.
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  return { name: download.suggestedFilename(), content: readFileSync(await download.path()) };
}

/** Cells of a CSV file as RFC 4180 has it. */
export function cellsOf(text) {
  const rows = [[]];
  for (const [, quoted, plain, end] of text.matchAll(/(?:"((?:[^"]|"")*)"|([^",\r\n]*))(,|\r\n)/g)) {
    rows.at(-1).push(quoted === undefined ? plain : quoted.replaceAll('""', '"'));
    if (end !== ",") rows.push([]);
  }
  return rows.slice(0, -1);
}

/** How many pixels have each colour ("red,green,blue"). */
export function countColours({ data }) {
  const colours = {};
  for (let i = 0; i < data.length; i += 4) {
    const colour = `${data[i]},${data[i + 1]},${data[i + 2]}`;
    colours[colour] = (colours[colour] ?? 0) + 1;
  }
  return colours;
}

/** Size and colours of an SVG or PNG file, seen in a page of its own. */
export async function seen(page, content, kind) {
  const picture = await page.context().newPage();
  await picture.setContent(`<img src="data:${kind};base64,${content.toString("base64")}">`);
  await picture.locator("img").evaluate((image) => image.decode());
  const pixels = await pixelsOf(picture, "img");
  await picture.close();
  return { width: pixels.width, height: pixels.height, colours: countColours(pixels) };
}
