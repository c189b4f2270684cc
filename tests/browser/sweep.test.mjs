// What a sweep has taught, on the page.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { assertAccessibleInBoth } from "./accessible.mjs";
import { assertTablesExplained } from "./meanings.mjs";
import { open, skip, testsOn } from "./open.mjs";
import { cellsOf, saved, seen } from "./saved.mjs";
import { glocal, report, runExperiment, workFolder } from "./runs.mjs";

const work = workFolder();
let page, sweep;

testsOn(async () => {
  const folder = runExperiment("sim_sweep", join(work, "sweep"), "--set", "trials.every_m=25");
  sweep = JSON.parse(glocal("sweep", folder, "--json"));
  return ({ page } = await open(report(join(work, "report.html"), folder)));
});

const percent = (share) => `${(100 * share).toFixed(1)} %`;

test("settings are listed best first, with what they were judged by", { skip }, async () => {
  const table = page.locator("#sweep table").first();
  const rows = table.locator("tbody tr");
  assert.deepEqual((await rows.locator("th").allInnerTexts()).map((text) => text.trim()), sweep.settings.map((s) => s.setting));
  const heads = await table.locator("thead th").evaluateAll((all) => all.map((head) => head.textContent));
  const best = await rows.first().locator("td").evaluateAll((all) => all.map((cell) => cell.textContent));
  const told = (head) => best[heads.findIndex((text) => text.startsWith(head)) - 1];
  const [{ chosen, judged, values }] = sweep.settings;
  assert.deepEqual(["right", "wrong", "trials"].map(told), [chosen.right, chosen.wrong, chosen.trials].map(String));
  assert.ok(told("success by").startsWith(percent(chosen.success_rate.value)), told("success by"));
  assert.ok(told("success judged").startsWith(percent(judged.success_rate.value)), told("success judged"));
  // What the setting changes has a column for each parameter.
  for (const { label, path } of sweep.effects) assert.equal(told(label), values[path]);
  const text = await page.locator("#sweep").innerText();
  for (const warning of sweep.warnings) assert.ok(text.includes(warning), warning);
});

test("what came out is told of the settings over the cases that they are chosen by, in the same order", { skip }, async () => {
  const rows = page.locator("#figures tbody tr");
  assert.deepEqual(await rows.locator("[data-run]").allInnerTexts(), sweep.settings.map((s) => s.setting));
  const right = async () => (await rows.first().locator("td").allInnerTexts())[0];
  assert.equal(await right(), String(sweep.settings[0].chosen.right));
  await page.locator("#figures [data-axis=cases]").selectOption({ label: "to judge by" });
  const names = await rows.locator("[data-run]").allInnerTexts();
  assert.equal(await right(), String(sweep.settings.find(({ setting }) => setting === names[0]).judged.right));
  await page.locator("#figures [data-axis=cases]").selectOption({ label: "to choose by" });
  // Other rows: each case by itself, and single runs.
  await page.locator("#level").selectOption("run");
  assert.equal(await rows.count(), Math.min(30, sweep.settings.length * sweep.choose_on.length * 2));
  await page.locator("#level").selectOption("setting");
});

test("runs without steps can be chosen, too", { skip }, async () => {
  assert.equal(await page.locator("#view").count(), 0);
  await page.locator("#run").selectOption("1");
  assert.equal(await page.evaluate(() => document.body.dataset.run), await page.locator("#run option:checked").innerText());
  await page.locator("#run").selectOption("0");
});

test("each parameter has its levels where they belong on the axis", { skip }, async () => {
  const charts = page.locator("#sweep .effect");
  assert.equal(await charts.count(), sweep.effects.length);
  for (const [i, effect] of sweep.effects.entries()) {
    const chart = charts.nth(i);
    assert.equal(await chart.locator("strong").innerText(), effect.label);
    for (const [k, level] of effect.levels.entries()) {
      const track = await chart.locator(".track").nth(k).boundingBox();
      const dot = await chart.locator(".dot").nth(k).boundingBox();
      const bar = await chart.locator(".interval").nth(k).boundingBox();
      const share = (x) => (x - track.x) / track.width;
      const { value, low, high } = level.success_rate;
      assert.ok(Math.abs(share(dot.x + dot.width / 2) - value) < 0.01, `${effect.label}, ${level.label}`);
      assert.ok(Math.abs(share(bar.x) - low) < 0.01 && Math.abs(share(bar.x + bar.width) - high) < 0.01);
    }
  }
});

test("each setting is a line from its values to its share of right trials", { skip }, async () => {
  const lines = page.locator("#sweep .parallel .lines path");
  assert.equal(await lines.count(), sweep.settings.length);
  const axes = await page.locator("#sweep .parallel .axis").evaluateAll((all) =>
    all.map((axis) => {
      const [line, label] = [axis.querySelector("line"), axis.querySelector(".label")];
      const [x, low, high] = ["x1", "y2", "y1"].map((key) => Number(line.getAttribute(key)));
      return { x, low, high, label: label.lastChild.textContent };
    }),
  );
  assert.equal(axes.length, sweep.effects.length + 1);
  const epsilon = sweep.effects.findIndex(({ label }) => label === "contact_epsilon");
  const all = sweep.settings.map(({ values }) => Number(values[sweep.effects[epsilon].path]));
  for (const { setting, values, chosen } of sweep.settings) {
    const points = (await page.locator(`#sweep [data-setting="${setting}"]`).getAttribute("d")).slice(1).split("L").map((point) => point.split(" ").map(Number));
    const at = (axis, share) => axis.low + share * (axis.high - axis.low);
    points.forEach(([x], k) => assert.ok(Math.abs(x - axes[k].x) < 0.1));
    assert.ok(Math.abs(points.at(-1)[1] - at(axes.at(-1), chosen.success_rate.value)) < 0.1, setting);
    const share = (Number(values[sweep.effects[epsilon].path]) - Math.min(...all)) / (Math.max(...all) - Math.min(...all));
    assert.ok(Math.abs(points[epsilon][1] - at(axes[epsilon], share)) < 0.1, `${setting}: ${points[epsilon][1]}`);
  }
});

test("effects are saved as pictures and as numbers", { skip }, async () => {
  for (const [i, effect] of sweep.effects.entries()) {
    const chart = page.locator("#sweep .effect").nth(i);
    const svg = await saved(page, chart.locator("[data-save=svg]"));
    assert.equal(svg.name, `effect-of-${effect.label.replaceAll("_", "-")}.svg`);
    const text = svg.content.toString();
    assert.ok(text.includes(`>${effect.label}: `), text.slice(0, 300));
    // A circle for each level, along the axis as its share is.
    const circles = [...text.matchAll(/M([\d.]+) [\d.]+a4\.5 /g)].map(([, left]) => Number(left) + 4.5);
    const ends = text.match(/M([\d.]+) [\d.]+L([\d.]+) [\d.]+" fill="none" stroke="#\w+" stroke-width="1"/).slice(1).map(Number);
    const levels = effect.levels.filter(({ trials }) => trials > 0);
    assert.equal(circles.length, levels.length);
    circles.forEach((x, k) => assert.ok(Math.abs((x - ends[0]) / (ends[1] - ends[0]) - levels[k].success_rate.value) < 0.002));
    const csv = await saved(page, chart.locator(".csv"));
    const [head, ...rows] = cellsOf(csv.content.toString());
    assert.deepEqual(head, [effect.label, "settings", "trials", "right", "low", "high"]);
    assert.deepEqual(rows, effect.levels.map(({ label, settings, trials, success_rate: { value, low, high } }) => [label, ...[settings, trials, value, low, high].map(String)]));
  }
});

test("the map of two parameters is saved as a picture and as numbers", { skip }, async () => {
  const { rows, columns, cells } = sweep.map;
  const figure = page.locator("#sweep .heat");
  const csv = cellsOf((await saved(page, figure.locator(".csv"))).content.toString());
  assert.deepEqual(csv[0].slice(1), columns.levels);
  rows.levels.forEach((level, r) => {
    assert.equal(csv[r + 1][0], level);
    cells[r].forEach(({ trials, success_rate: { value } }, c) => assert.equal(csv[r + 1][c + 1], trials > 0 ? String(100 * value) : ""));
  });
  const png = await saved(page, figure.locator("[data-save=png]"));
  const { colours } = await seen(page, png.content, "image/png");
  const shown = await figure.locator("td:not(.empty)").evaluateAll((all) => all.map((cell) => getComputedStyle(cell).backgroundColor.match(/\d+/g).join(",")));
  for (const colour of shown) assert.ok(colours[colour] > 2000, `${colour}: ${colours[colour]}`);
});

test("parallel coordinates and boxes are saved as they are shown", { skip }, async () => {
  const figure = page.locator("#sweep .parallel");
  const svg = await saved(page, figure.locator("[data-save=svg]"));
  assert.equal(svg.name, "parallel-coordinates.svg");
  const shown = await figure.locator(".lines path").evaluateAll((all) =>
    all.map((path) => [path.getAttribute("d"), getComputedStyle(path).strokeWidth]),
  );
  const text = svg.content.toString();
  const inFile = [...text.matchAll(/<path d="([^"]+)" style="([^"]+)"/g)].map(([, d, style]) => [d, /stroke-width: ([^;]+)/.exec(style)[1]]);
  assert.deepEqual(inFile, shown);
  // What it looks like is in the file alone: neither variables nor classes of the page.
  assert.ok(!/var\(|class=|color-mix|color\(/.test(text));
  for (const [part, name] of [["[data-boxes=steps]", "steps-to-localize.png"], ["#sweep .parallel", "parallel-coordinates.png"]]) {
    const png = await saved(page, page.locator(part).locator("[data-save=png]"));
    assert.equal(png.name, name);
    assert.ok(Object.keys((await seen(page, png.content, "image/png")).colours).length > 20, part);
  }
});

test("curves and boxes over all trials are of settings", { skip }, async () => {
  assert.deepEqual(await page.locator("#distributions .names span").allInnerTexts(), sweep.settings.map((s) => s.setting));
  assert.equal(await page.locator("[data-boxes=steps] [data-run]").count(), sweep.settings.length);
});

test("cells of the map can be read on their colours", { skip }, async () => {
  const cells = await page.locator("#sweep .heat td").evaluateAll((all) =>
    all.map((cell) => {
      const { backgroundColor, color } = getComputedStyle(cell);
      return { text: cell.innerText, back: backgroundColor, ink: color };
    }),
  );
  const expected = sweep.map.cells.flat();
  assert.equal(cells.length, expected.length);
  // WCAG 2: relative luminance and contrast.
  const luminance = (colour) => {
    const [r, g, b] = colour.match(/[\d.]+/g).map((c) => c / 255).map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  for (const [i, { text, back, ink }] of cells.entries()) {
    const { trials, success_rate: rate } = expected[i];
    assert.equal(text, trials > 0 ? (100 * rate.value).toFixed(0) : "–");
    if (trials === 0) continue;
    const [a, b] = [luminance(back), luminance(ink)].sort((x, y) => y - x);
    assert.ok((a + 0.05) / (b + 0.05) > 4.5, `${text}: ${ink} on ${back}`);
  }
  for (const axis of [sweep.map.rows, sweep.map.columns])
    assert.ok((await page.locator("#sweep .heat thead").innerText()).includes(axis.label));
});

test("every column of a table tells what it is", { skip }, () => assertTablesExplained(page, 40));

test("axe finds nothing serious", { skip }, () => assertAccessibleInBoth(page, "sweep"));
