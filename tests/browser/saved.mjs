// Files that a page saves.
import { readFileSync } from "node:fs";

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

/** Pixels of an SVG or PNG file, in a page of their own. */
export async function pixelsOf(page, content, kind) {
  const picture = await page.context().newPage();
  const read = await picture.evaluate(async (url) => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = document.createElement("canvas");
    Object.assign(canvas, { width: image.width, height: image.height });
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    const colours = {};
    for (let i = 0; i < data.length; i += 4) {
      const colour = `${data[i]},${data[i + 1]},${data[i + 2]}`;
      colours[colour] = (colours[colour] ?? 0) + 1;
    }
    return { width: image.width, height: image.height, colours };
  }, `data:${kind};base64,${content.toString("base64")}`);
  await picture.close();
  return read;
}
