// The page of the leaderboard: the committed results of one suite, and on another one those of two methods that differ where the test says.
import assert from "node:assert/strict";
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { execFileSync } from "node:child_process";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { assertAccessibleInBoth } from "./accessible.mjs";
import { assertTablesExplained } from "./meanings.mjs";
import { drawn, open, skip, testsOn } from "./open.mjs";
import { glocal, program, workFolder } from "./runs.mjs";
import { cellsOf, saved } from "./saved.mjs";

const work = workFolder();
const board = join(work, "leaderboard");
const committed = join(process.env.GLOCAL_SOURCE_DIR, "leaderboard");
const hostile = "<img src=x onerror=window.hacked=1>'";
const json = (file) => JSON.parse(readFileSync(file, "utf8"));
/** Seeds of paper_lab at which the other method is right and `paper` is not. */
const lost = [3, 8, 21];
let page, paper, other;

testsOn(async () => {
  cpSync(committed, board, { recursive: true });
  rmSync(join(board, "paper@1"), { recursive: true });
  mkdirSync(join(board, "paper@1"));
  const entry = (outcome) => {
    const its = json(join(committed, "paper@1/paper.json"));
    for (const result of its.results) if (result.case === "paper_lab" && lost.includes(result.seed)) result.outcome = outcome(result.seed);
    return its;
  };
  paper = entry((seed) => (seed === 8 ? "w" : "u"));
  other = { ...entry(() => "r"), method: hostile };
  for (const [name, its] of [["paper", paper], ["other", other]]) writeFileSync(join(board, `paper@1/${name}.json`), JSON.stringify(its));
  const renewal = (suite, method, starts, right) =>
    JSON.stringify({ date: "2026-11-25", revision: "v2", suite, method, starts, right, wrong: 0, undecided: starts - right }) + "\n";
  const history = [207, 200, 290].map((right) => renewal("paper@1", "paper", 300, right));
  writeFileSync(join(board, "history.jsonl"), [...history, renewal("stress_space@1", "lidar_upright", 430, 331)].join(""));
  glocal("leaderboard", "--board", board, "-o", join(work, "board.html"));
  return ({ page } = await open(join(work, "board.html")));
});

const letters = (entry) => entry.results.map(({ outcome }) => outcome).join("");
const countOf = (text, letter) => text.split(letter).length - 1;
const suitePart = (suite) => page.locator("section[id^=suite-]", { has: page.locator("h2", { hasText: suite }) });

test("all methods stand on all suites, wrong ones first", { skip }, async () => {
  const heads = await page.locator("#methods thead th").allInnerTexts();
  const rows = await page.locator("#methods tbody tr").evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => [...cell.querySelectorAll("b")].map((b) => Number(b.textContent.replace(",", ""))))));
  const names = await page.locator("#methods tbody th").evaluateAll((all) => all.map((cell) => cell.firstChild.textContent));
  assert.ok(names.includes(hostile));
  const at = (suite, method) => rows[names.indexOf(method)][heads.findIndex((head) => head.trim() === suite)];
  for (const [suite, method] of [["planar@1", "indexed"], ["planar@1", "paper_logs"], ["single@1", "indexed_single"]]) {
    const all = letters(json(join(committed, suite, `${method}.json`)));
    assert.deepEqual(at(suite, method), ["w", "r", "u"].map((letter) => countOf(all, letter)), `${suite}, ${method}`);
  }
  assert.deepEqual(at("paper@1", hostile), ["w", "r", "u"].map((letter) => countOf(letters(other), letter)));
  const [, ...lines] = cellsOf((await saved(page, page.locator("#methods .csv"))).content.toString());
  const right = countOf(letters(json(join(committed, "planar@1/indexed.json"))), "r").toLocaleString("en");
  assert.ok(lines[names.indexOf("indexed")].join().includes(`0 wrong 0.0 to 0.1 % ${right} right `));
  const scores = rows.map((cells) => cells.reduce((sum, [wrong = 0, right = 0, undecided = 1]) => sum + (right - wrong) / (wrong + right + undecided), 0));
  assert.deepEqual(scores, [...scores].sort((a, b) => b - a));
  assert.equal(await page.evaluate(() => window.hacked), undefined);
});

test("each case has its row, and its numbers lead to the starts that are lost", { skip }, async () => {
  const row = suitePart("paper@1").locator("tbody tr", { has: page.locator("th", { hasText: "paper_lab" }) });
  const lab = paper.results.filter((result) => result.case === "paper_lab").map(({ outcome }) => outcome).join("");
  const link = row.locator("a").filter({ hasText: `${countOf(lab, "w")} / ${countOf(lab, "r")}` });
  await link.click();
  assert.match(await page.locator("#lost .told").innerText(), /^3 starts on paper_lab of paper@1 that paper does not get right/);
  const told = await page.locator("#lost tbody tr").evaluateAll((all) => all.map((one) => [...one.cells].slice(1, 6).map((cell) => cell.textContent)));
  const stored = (seed) => other.results.find((result) => result.case === "paper_lab" && result.seed === seed);
  const steps = (seed) => String(stored(seed).steps[0]);
  // The wrong one first.
  assert.deepEqual(told.map((cells) => [cells[0], cells[1], cells[2]]), [["8", "wrong", steps(8)], ["3", "undecided", steps(3)], ["21", "undecided", steps(21)]]);
  assert.deepEqual(new Set(told.map((cells) => cells[4])), new Set([hostile]));
  // Who wins everything loses nothing; and an address alone brings the same.
  await page.locator("#lost [data-asked=method]").selectOption(hostile);
  assert.match(await page.locator("#lost .told").innerText(), /^0 starts on paper_lab/);
  await page.goBack();
  assert.equal(await page.locator("#lost tbody tr").count(), 3);
});

test("the command of a start explains it", { skip }, async () => {
  const commands = async () => (await page.locator("#lost .commands").innerText()).split("\n");
  await page.locator("#lost [data-start]").nth(1).click();
  const [run, explain] = (await commands()).map((command) => command.replace(/^glocal/, program));
  const options = { cwd: work, shell: true, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] };
  mkdirSync(join(work, "results"), { recursive: true });
  execFileSync(run, { ...options, stdio: "ignore" });
  assert.match(execFileSync(explain, options), /trial 0, step/);
});

test("curves end at the shares of right starts", { skip }, async () => {
  const svg = (await saved(page, suitePart("planar@1").locator("[data-share=steps] [data-save=svg]"))).content.toString();
  for (const word of ["planar@1: right within so many steps", ">step<", ">share of starts declared right<", ">indexed<", ">paper_logs<"]) assert.ok(svg.includes(word), word);
  const time = (await saved(page, suitePart("planar@1").locator("[data-share=time] [data-save=svg]"))).content.toString();
  for (const word of ["CPU time of a step, ms (logarithmic)", ">indexed<"]) assert.ok(time.includes(word), word);
});

test("significant steps of the history are marked, and one renewal alone has no chart", { skip }, async () => {
  const chart = suitePart("paper@1").locator("[data-share=renewals]");
  assert.equal(await chart.count(), 1);
  const svg = (await saved(page, chart.locator("[data-save=svg]"))).content.toString();
  assert.equal(countOf(svg, "▼"), 1);
  const table = suitePart("paper@1").locator(".table").last();
  const rows = cellsOf((await saved(page, table.locator(".csv"))).content.toString());
  assert.deepEqual(rows.slice(1).map((cells) => cells.slice(0, 3)), [["paper 1", "0", "207"], ["paper 2", "0", "200"], ["paper 3", "0", "290"]]);
  assert.equal(rows[3].at(-1), "< 0.001");
  assert.ok(Number(rows[2].at(-1)) > 0.5);
  assert.equal(await suitePart("stress_space@1").locator("[data-share=renewals]").count(), 0);
  assert.match(await suitePart("stress_space@1").locator(".table").last().innerText(), /lidar_upright 1/);
});

test("nothing scrolls aside on a telephone, and all can be reached", { skip }, async () => {
  await page.setViewportSize({ width: 390, height: 800 });
  await drawn(page);
  const wide = await page.evaluate(() => [...document.querySelectorAll("body *")].filter((e) => e.getBoundingClientRect().right > 390).map((e) => `${e.tagName} ${e.className}`));
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390, wide.join(", "));
  // Links in what is unfolded below a row work, too.
  await page.locator("#methods .unfold").first().click();
  const link = page.locator("#methods .unfolded a").first();
  const address = await link.getAttribute("href");
  await link.click();
  assert.ok(page.url().endsWith(address));
  await page.setViewportSize({ width: 1366, height: 768 });
});

test("a table of twenty methods fits, and all of a row can be read", { skip }, async () => {
  const many = join(work, "many");
  mkdirSync(join(many, "paper@1"), { recursive: true });
  const methods = Array.from({ length: 20 }, (_, i) => `method_${i}`);
  for (const method of methods) writeFileSync(join(many, `paper@1/${method}.json`), JSON.stringify({ ...paper, method }));
  glocal("leaderboard", "--board", many, "-o", join(work, "many.html"));
  const wide = (await open(join(work, "many.html"))).page;
  await wide.setViewportSize({ width: 900, height: 800 });
  await drawn(wide);
  assert.equal(await wide.evaluate(() => document.documentElement.scrollWidth), 900);
  const table = wide.locator(".table").filter({ hasText: "paper_lab" }).first();
  const heads = await table.locator("thead th").evaluateAll((all) => all.filter((head) => head.offsetWidth > 0).map(({ innerText }) => innerText));
  assert.ok(heads.length > 3 && heads.length < 20, heads.join(", "));
  await table.locator(".unfold").first().click();
  const told = await table.locator(".unfolded dt").allInnerTexts();
  assert.deepEqual([...heads.slice(2), ...told].sort(), methods.sort());
  await wide.close();
});

test("every column of a table tells what it is", { skip }, () => assertTablesExplained(page, 20));

test("axe finds nothing serious", { skip }, () => assertAccessibleInBoth(page, "leaderboard"));
