// A report in a browser that notes everything that must not happen.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before } from "node:test";

const browserFile = "/usr/bin/chromium-headless-shell";
export const skip = existsSync(browserFile) ? false : "Chromium is missing; scripts/setup --browser installs it";

let browser = null;

async function launch() {
  const { chromium } = createRequire(join(process.env.GLOCAL_BROWSER_PACKAGES, "package.json"))("playwright-core");
  return chromium.launch({
    executablePath: browserFile,
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
}

export async function closeBrowser() {
  await browser?.close();
  browser = null;
}

/** The page of a report, when it has drawn itself. `options` are those of a browser context. */
export async function open(address, options = {}) {
  browser ??= await launch();
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 }, ...options });
  const page = await context.newPage();
  const noted = { errors: [], requests: [], dialogs: 0 };
  // Drawing in space without a graphics card is slow, of which the browser warns when a test looks at pixels.
  const isOfDriver = (text) => text.includes("GPU stall due to ReadPixels");
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !isOfDriver(message.text()) && noted.errors.push(message.text()));
  page.on("pageerror", (error) => noted.errors.push(String(error)));
  page.on("request", (request) => noted.requests.push(request.url()));
  page.on("dialog", async (dialog) => {
    ++noted.dialogs;
    await dialog.dismiss();
  });
  const url = address.startsWith("http") ? address : `file://${address}`;
  await page.goto(url);
  await page.waitForSelector("body[data-step], body[data-shown]");
  // Without steps and maps there is nothing to draw.
  if ((await page.locator("#view").count()) > 0) await page.waitForSelector("canvas[data-scale]");
  await drawn(page);
  return { page, noted, url: page.url().replace(/#.*/, "") };
}

/** Nothing was fetched besides the page itself, and perhaps its steps beside it; no error was told, and nothing asked the reader. */
export function assertQuiet({ noted, url }) {
  // The empty icon is part of the page, and so are the files that it saves.
  const isOther = (address) => !/^(data|blob):/.test(address) && !address.startsWith(url.replace(/\.html$/, "_steps/"));
  const fetched = noted.requests.filter(isOther).map((address) => address.replace(/#.*/, ""));
  assert.deepEqual(fetched, [url]);
  assert.deepEqual(noted.errors, []);
  assert.equal(noted.dialogs, 0);
}

/** The tests of this file are on the page that `setUp` opens and returns: nothing has gone wrong with it when they have ended. */
export function testsOn(setUp, skipped = skip) {
  let opened;
  before(async () => {
    if (!skipped) opened = await setUp();
  });
  after(async () => {
    if (!skipped) assertQuiet(opened);
    await closeBrowser();
  });
}

export async function slide(page, slider, value) {
  await page.locator(slider).evaluate((slider, value) => {
    slider.value = String(value);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  }, value);
  await drawn(page);
}

export const moveSlider = (page, step) => slide(page, ".player input[type=range]", step);

/** Drags by so many px with the left button. */
export async function drag(page, { x, y }, right, down) {
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + right, y + down, { steps: 4 });
  await page.mouse.up();
  await drawn(page);
}

/** Whether the page keeps a key from the browser. */
export function isTaken(page, key) {
  return page.evaluate((key) => !document.body.dispatchEvent(new KeyboardEvent("keydown", { ...key, bubbles: true, cancelable: true })), key);
}

/** Waits until what was asked for has been loaded and drawn. */
export async function drawn(page) {
  await page.waitForFunction(() => document.body.dataset.loading === undefined);
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

/** The hash of the page's address, once it has been written: a page's timers end in the order in which they are due, however slow it is. */
export function hashOf(page) {
  return page.evaluate(() => new Promise((resolve) => setTimeout(() => resolve(location.hash), 300)));
}

const plan = ".map:not(.space) .stage canvas";

/** What the page says of its view, to find a place of the map on the screen (y up in the map, down on the screen). */
export async function mapView(page, canvas = plan) {
  const { data, box } = await page.locator(canvas).evaluate((canvas) => {
    window.scrollTo(0, 0);
    const rectangle = canvas.getBoundingClientRect();
    return { data: { ...canvas.dataset }, box: { left: rectangle.left, top: rectangle.top, width: rectangle.width, height: rectangle.height } };
  });
  const [x, y, scale] = [Number(data.x), Number(data.y), Number(data.scale)];
  return {
    x,
    y,
    scale,
    box,
    toScreen: (pose) => ({
      x: box.left + box.width / 2 + (pose.x - x) * scale,
      y: box.top + box.height / 2 - (pose.y - y) * scale,
    }),
  };
}

/** What a canvas or an image shows: its width and height, and red, green, blue, opacity of each pixel, row by row. */
export async function pixelsOf(page, element) {
  const { bytes, width, height } = await page.locator(element).evaluate((element) => {
    // Reading the page's own canvas again and again would have the browser warn of it.
    const copy = document.createElement("canvas");
    Object.assign(copy, { width: element.width, height: element.height });
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(element, 0, 0);
    const { data, width, height } = context.getImageData(0, 0, copy.width, copy.height);
    let text = "";
    for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
    return { bytes: btoa(text), width, height };
  });
  return { data: Buffer.from(bytes, "base64"), width, height };
}

/** The map's drawing as it is: red, green, blue, opacity of its pixels, which places on the screen lead to. */
async function drawing(page, canvas) {
  const { data, width, height } = await pixelsOf(page, canvas);
  const box = await page.locator(canvas).evaluate((canvas) => {
    const { left, top, width: shown } = canvas.getBoundingClientRect();
    return { left, top, ratio: canvas.width / shown };
  });
  return ({ x, y }) => {
    const [column, row] = [Math.floor((x - box.left) * box.ratio), Math.floor((y - box.top) * box.ratio)];
    const isInside = column >= 0 && row >= 0 && column < width && row < height;
    return isInside ? [...data.subarray(4 * (row * width + column), 4 * (row * width + column) + 4)] : [0, 0, 0, 0];
  };
}

/** For each place on the screen whether anything is drawn there, or in a pixel beside it. */
export async function painted(page, places, canvas = plan) {
  const at = await drawing(page, canvas);
  const offsets = [-1, 0, 1];
  return places.map(({ x, y }) => offsets.some((dx) => offsets.some((dy) => at({ x: x + dx, y: y + dy })[3] > 0)));
}

/** Colour of the map's drawing at a place on the screen: red, green, blue, opacity. */
export async function colourAt(page, place) {
  return (await drawing(page, plan))(place);
}

/** The same at many places. */
export async function coloursAt(page, places, canvas = plan) {
  return places.map(await drawing(page, canvas));
}

/** A colour of the page's style sheet: red, green, blue. */
export async function themed(page, name) {
  const hex = await page.evaluate((name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim(), name);
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
}

/** What is drawn: all layers but these are switched off. */
export async function showOnly(page, ...layers) {
  for (const box of await page.locator("input[data-layer]").all()) {
    await box.setChecked(layers.includes(await box.getAttribute("data-layer")));
  }
  await drawn(page);
}
