// What the map shows besides points and poses: space, places, the field of view; and how it is given room.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { assertQuiet, colourAt, drag, drawn, mapView, moveSlider, open, painted, showOnly, skip, testsOn, themed } from "./open.mjs";
import { readPcd, report, runExperiment, stepsOf, workFolder } from "./runs.mjs";

/** In the page: counts what the browser has been asked for, and has not done yet. */
function countAsked() {
  window.asked = 0;
  for (const [owner, name] of [[Element.prototype, "requestFullscreen"], [Document.prototype, "exitFullscreen"]]) {
    const work = owner[name];
    owner[name] = function () {
      ++window.asked;
      return work.call(this).finally(() => --window.asked);
    };
  }
}

const work = workFolder();
let folder, file, steps, page;

testsOn(async () => {
  folder = runExperiment("paper_simulation", join(work, "simulation"));
  file = report(join(work, "report.html"), folder);
  steps = stepsOf(folder, 0);
  const opened = await open(file, { viewport: { width: 1440, height: 900 } });
  page = opened.page;
  await page.evaluate(countAsked);
  return opened;
});

test("free, occupied and unknown cells are shaded as the run's grid has them", { skip }, async () => {
  const { resolution, origin, width, height, cells } = JSON.parse(readFileSync(join(folder, "maps/global_grid.json"), "utf8"));
  assert.equal(origin.theta, 0);
  const kinds = [...cells.matchAll(/(\d+)([ufo])/g)].map(([, n, kind]) => kind.repeat(Number(n))).join("");
  assert.equal(kinds.length, width * height);
  await showOnly(page, "space");
  const view = await mapView(page);
  const colours = { f: await themed(page, "free"), u: await themed(page, "unknown") };
  const checked = { f: 0, u: 0 };
  for (let row = 4; row < height - 4; row += 37) {
    for (let column = 4; column < width - 4; column += 41) {
      const kind = kinds[row * width + column];
      // Pixels are no smaller than cells are: only places amid their like have one colour.
      const around = [-3, 0, 3].flatMap((dr) => [-3, 0, 3].map((dc) => kinds[(row + dr) * width + column + dc]));
      if (around.some((other) => other !== kind)) continue;
      const at = view.toScreen({ x: origin.x + (column + 0.5) * resolution, y: origin.y + (row + 0.5) * resolution });
      assert.deepEqual((await colourAt(page, at)).slice(0, 3), colours[kind], `column ${column}, row ${row}`);
      if (++checked[kind] > 12) break;
    }
    if (checked.f + checked.u > 40) break;
  }
  assert.ok(checked.f > 5 && checked.u > 5, JSON.stringify(checked));
});

test("the cursor's coordinates are told", { skip }, async () => {
  const view = await mapView(page);
  const at = view.toScreen({ x: 10, y: 5 });
  await page.mouse.move(at.x, at.y);
  const [, x, y] = /x (\S+) m, y (\S+) m/.exec(await page.locator(".stage .cursor").innerText());
  assert.ok(Math.hypot(Number(x) - 10, Number(y) - 5) < 1.5 / view.scale + 0.01, `${x}, ${y}`);
});

test("the grid's lines are whole steps apart", { skip }, async () => {
  await showOnly(page, "grid");
  const view = await mapView(page);
  // At this scale lines are 5 m apart; a place between them is empty.
  const line = await painted(page, [view.toScreen({ x: 10, y: 7.5 }), view.toScreen({ x: 12.5, y: 10 })]);
  assert.deepEqual(line, [true, true]);
  assert.deepEqual(await painted(page, [view.toScreen({ x: 12.5, y: 7.5 })]), [false]);
});

test("the field of view reaches from the robot to what the laser met, and no farther", { skip }, async () => {
  const k = 100;
  await moveSlider(page, k);
  await showOnly(page, "view");
  const view = await mapView(page);
  const { estimate } = steps[k];
  const hits = readPcd(join(folder, "maps", "trial_0000", "scan_0100.pcd"));
  const along = (point, share) => ({
    x: estimate.x + share * (Math.cos(estimate.theta) * point.x - Math.sin(estimate.theta) * point.y),
    y: estimate.y + share * (Math.sin(estimate.theta) * point.x + Math.cos(estimate.theta) * point.y),
  });
  const seen = await painted(page, hits.map((hit) => view.toScreen(along(hit, 0.5))));
  assert.ok(seen.every(Boolean), `${seen.filter(Boolean).length} of ${seen.length}`);
  const farthest = hits.reduce((a, b) => (Math.hypot(a.x, a.y) > Math.hypot(b.x, b.y) ? a : b));
  assert.deepEqual(await painted(page, [view.toScreen(along(farthest, 1.3))]), [false]);
});

test("boxes are where the drive begins and ends", { skip }, async () => {
  await showOnly(page, "ends");
  const view = await mapView(page);
  for (const { reference } of [steps[0], steps.at(-1)]) {
    const { x, y } = view.toScreen(reference);
    assert.deepEqual(await painted(page, [{ x: x - 6, y }, { x: x + 6, y }, { x, y: y - 6 }, { x, y: y + 6 }]), [true, true, true, true]);
    assert.deepEqual(await painted(page, [{ x, y }]), [false]);
  }
});

test("the estimate's dots have the colour of the verdict or of the error", { skip }, async () => {
  await moveSlider(page, steps.length - 1);
  await showOnly(page, "estimate");
  const view = await mapView(page);
  const places = steps.map(({ estimate }) => estimate && view.toScreen(estimate));
  const alone = (i) => places[i] && places.every((other, k) => k === i || !other || Math.hypot(other.x - places[i].x, other.y - places[i].y) > 9);
  const ambiguous = steps.findIndex(({ verdict, translation_error_m: error }, i) => verdict === "ambiguous" && error > 10 && alone(i));
  assert.ok(ambiguous >= 0);
  const select = page.locator("select[aria-label='Colour of the estimate']");
  await select.selectOption("verdict");
  await drawn(page);
  assert.deepEqual((await colourAt(page, places[ambiguous])).slice(0, 3), [230, 159, 0]);
  const scale = page.locator(".legend .scale", { hasText: "error" });
  assert.equal(await scale.isVisible(), false);
  await select.selectOption("error");
  await drawn(page);
  // 10 m and more have the last colour of the scale.
  assert.deepEqual((await colourAt(page, places[ambiguous])).slice(0, 3), [213, 94, 0]);
  assert.equal(await scale.isVisible(), true);
  await select.selectOption("plain");
});

test("a click lists the clusters near the place", { skip }, async () => {
  await moveSlider(page, 0);
  await showOnly(page, "clusters");
  const view = await mapView(page);
  const { best } = steps[0];
  // The page has the place of a whole pixel.
  const place = view.toScreen(best[0].pose);
  const at = { x: Math.round(place.x), y: Math.round(place.y) };
  const clicked = { x: view.x + (at.x - view.box.left - view.box.width / 2) / view.scale, y: view.y - (at.y - view.box.top - view.box.height / 2) / view.scale };
  await page.mouse.click(at.x, at.y);
  const distances = best.map(({ pose }) => Math.hypot(pose.x - clicked.x, pose.y - clicked.y));
  const expected = distances.map((d, rank) => ({ d, rank })).sort((a, b) => a.d - b.d);
  // The page's own place may be a part of a pixel away.
  const within = (radius) => distances.filter((d) => d <= radius).length;
  const [, found] = /^(\d+) clusters? within 1.0 m/.exec(await page.locator(".near strong").innerText());
  assert.ok(found >= within(1 - 1.5 / view.scale) && found <= within(1 + 1.5 / view.scale), `${found} for ${within(1)}`);
  const listed = await page.locator(".near li button").allInnerTexts();
  // Neighbours may change places.
  const far = listed.map((text) => distances[Number(text.replace("cluster ", "")) - 1]);
  assert.equal(new Set(listed).size, Math.min(8, Number(found)));
  far.forEach((d, i) => assert.ok(Math.abs(d - expected[i].d) < 1.5 / view.scale, `${d} for ${expected[i].d}`));
  await page.locator(".near li button").last().click();
  const chosen = page.locator(".hypotheses table [aria-pressed=true]");
  assert.equal(`cluster ${await chosen.innerText()}`, listed.at(-1));
  await page.locator(".near .close").press("Escape");
  assert.equal(await page.locator(".near").isVisible(), false);
});

/** Presses a key so often before the browser has done anything about it. */
async function pressAtOnce(key, times) {
  await page.evaluate(([key, times]) => {
    const again = () => {
      for (let i = 1; i < times; ++i) document.activeElement.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
    };
    document.addEventListener("keyup", again, { once: true });
  }, [key, times]);
  await page.keyboard.press(key);
}

/** Whether the map has the whole window, and whether it has the whole screen, once the browser has followed. */
async function fullness() {
  await page.waitForFunction(() => window.asked === 0);
  return page.evaluate(() => [document.querySelector("main").classList.contains("full"), document.fullscreenElement !== null]);
}

test("the map can have the whole window", { skip }, async () => {
  const width = async () => (await page.locator(".stage").boundingBox()).width;
  const before = await width();
  await page.locator(".stage canvas").focus();
  await page.keyboard.press("f");
  await page.waitForFunction(() => document.querySelector(".stage").clientWidth > 1380);
  assert.equal(await page.locator(".curves").isVisible(), false);
  assert.equal(await page.locator(".player").isVisible(), true);
  // The browser may not have followed by now.
  await page.keyboard.press("f");
  assert.deepEqual(await fullness(), [false, false]);
  await page.waitForFunction((before) => Math.abs(document.querySelector(".stage").getBoundingClientRect().width - before) < 2, before);
});

test("who changes their mind before the browser has followed gets what they wanted last", { skip }, async () => {
  await page.locator(".stage canvas").focus();
  for (const times of [2, 4, 2, 4]) {
    await pressAtOnce("f", times);
    assert.deepEqual(await fullness(), [false, false], `${times} times`);
  }
});

test("borders can be moved by pointer and keys", { skip }, async () => {
  const stage = async () => page.locator(".stage").boundingBox();
  const before = await stage();
  const upright = page.locator(".border.vertical");
  const box = await upright.boundingBox();
  await drag(page, { x: box.x + box.width / 2, y: box.y + 100 }, 150, 0);
  const wider = await stage();
  assert.ok(Math.abs(wider.width - before.width - 150) < 20, `${before.width} to ${wider.width}`);
  await upright.focus();
  await page.keyboard.press("ArrowLeft");
  assert.ok((await stage()).width < wider.width - 10);
  // The step has not changed: the keys were the border's.
  assert.equal(await page.evaluate(() => document.body.dataset.step), "0");
  await page.locator(".border.horizontal").focus();
  await page.keyboard.press("ArrowDown");
  assert.equal(await page.locator(".border.horizontal").getAttribute("aria-valuenow"), "580");
  assert.ok(Math.abs((await stage()).height - 580) < 3);
});

test("nothing is wider than a telephone", { skip }, async () => {
  const small = await open(file, { viewport: { width: 390, height: 844 } });
  assert.equal(await small.page.evaluate(() => document.documentElement.scrollWidth), 390);
  const parts = await small.page.locator("#view > *, #figures, header").evaluateAll((all) =>
    all.filter((part) => part.getBoundingClientRect().right > 391).map((part) => part.className),
  );
  assert.deepEqual(parts, []);
  // Nothing keeps room in the legend without being shown.
  const gap = await small.page.locator(".map .legend").evaluate((legend) => {
    const shown = [...legend.children].filter((part) => part.checkVisibility({ visibilityProperty: true }));
    return legend.getBoundingClientRect().bottom - Math.max(...shown.map((part) => part.getBoundingClientRect().bottom));
  });
  assert.ok(gap < 4, `${gap} px`);
  assertQuiet(small);
});
