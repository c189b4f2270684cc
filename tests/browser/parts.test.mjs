// The page's arithmetic, by hand.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { pageModule } from "./page_module.mjs";

const names = [
  "geometry", "numbers", "shares", "candidates_shown", "field_of_view", "export",
  "boxes", "certificate", "answers", "svg", "space_poses", "comparison", "board_lost", "board_data", "store", "missing",
];
const [geometry, numbers, shares, shown, view, files, boxes, certificate, answers, svg, spacePoses, comparison, lost, board, store, missing] =
  await Promise.all(names.map(pageModule));

const near = (a, b) => assert.ok(Math.hypot(a.x - b.x, a.y - b.y, a.theta - b.theta) < 1e-12, JSON.stringify([a, b]));

test("poses are put together and undone", () => {
  const quarter = { x: 1, y: 2, theta: Math.PI / 2 };
  near(geometry.compose(quarter, { x: 3, y: 1, theta: 0.5 }), { x: 0, y: 5, theta: Math.PI / 2 + 0.5 });
  near(geometry.inverse(quarter), { x: -2, y: 1, theta: -Math.PI / 2 });
  near(geometry.compose(quarter, geometry.inverse(quarter)), { x: 0, y: 0, theta: 0 });
});

test("angles lie in (-pi, pi]", () => {
  assert.equal(geometry.wrap(Math.PI), Math.PI);
  assert.equal(geometry.wrap(-Math.PI), Math.PI);
  assert.ok(Math.abs(geometry.wrap(7) - (7 - 2 * Math.PI)) < 1e-12);
  assert.ok(Math.abs(geometry.wrap(-4) - (2 * Math.PI - 4)) < 1e-12);
});

test("boxes leave out what is missing", () => {
  assert.deepEqual(geometry.boundingBox([1, null, -2], [5, 9, 7]), { low: { x: -2, y: 5 }, high: { x: 1, y: 7 } });
  assert.equal(geometry.boundingBox([null], [1]), null);
});

test("shares count what is no larger, of all", () => {
  assert.deepEqual(shares.cumulativeShare({ values: [3, 1, 3], of: 4 }, [0, 1, 2, 3, 9]), [0, 0.25, 0.25, 0.75, 0.75]);
  assert.deepEqual(shares.cumulativeShare({ values: [], of: 0 }, [1, 2]), [null, null]);
});

test("axes are logarithmic where values differ much, but not by what rounding leaves of nothing", () => {
  const ranges = [[1, 20], [1, 40], [0.001, 100], [0, 100], [1.9e-15, 2]];
  assert.deepEqual(ranges.map(([low, high]) => svg.isLogarithmic(low, high)), [false, true, true, false, false]);
});

test("numbers have the digits that mean something", () => {
  const told = [0, 1.91e-16, 1, 0.00206464, 12345.6, -0.5, 1e-9, 999.6].map((value) => numbers.significant(value));
  assert.deepEqual(told, ["0", "0", "1.00", "0.00206", "12346", "-0.500", "1.00e-9", "1000"]);
  assert.equal(numbers.significant(null), "–");
  assert.equal(numbers.proportion({ value: 1, low: 0.9162, high: 1 }), "100.0 % (91.6 to 100.0 %)");
  assert.deepEqual([3.2, 300, 9000].map(numbers.duration), ["4 s", "5 min", "2.5 h"]);
  const names = ["distance_m", "rotation_error_deg", "step_cpu_ms", "steps", "free_space_violation"].map(numbers.nameOf);
  assert.deepEqual(names, ["distance, m", "rotation error, °", "CPU time of a step, ms", "steps", "free space violation"]);
});

test("of what shares a cell the first is drawn, and more as the scale grows", () => {
  const places = { x: [0.1, 0.9, 2.1, 0.2], y: [0.1, 0.9, 0.1, 0.2] };
  // At 16 px per m cells are 1 m wide, at 128 an eighth.
  assert.deepEqual(shown.thinnedOut(places, 0, 4, 16), [2, 0]);
  assert.deepEqual(shown.thinnedOut(places, 1, 4, 16), [2, 1]);
  assert.deepEqual(shown.thinnedOut(places, 0, 4, 128), [3, 2, 1, 0]);
});

test("clusters next to the best are opaque, weak ones faint", () => {
  assert.equal(shown.opacityOf(0.8, 0.8), 1);
  assert.equal(shown.opacityOf(0.77, 0.8), 1);
  assert.ok(Math.abs(shown.opacityOf(0.68, 0.8) - 0.6) < 1e-12);
  assert.equal(shown.opacityOf(0.1, 0.8), 0.2);
  assert.equal(shown.opacityOf(0, 0), 1);
});

test("a fan begins and ends at the robot where the laser does not see", () => {
  const at = (degrees, range) => ({ x: range * Math.cos((degrees * Math.PI) / 180), y: range * Math.sin((degrees * Math.PI) / 180) });
  // Ahead from -45.25 to 45.25 degrees, at 2 m; one hit farther in the same direction as another is hidden.
  const ahead = Array.from({ length: 182 }, (_, i) => at(i / 2 - 45.25, 2));
  const [fan, ...none] = view.fansOf([...ahead, at(0.25, 5)]);
  assert.deepEqual(none, []);
  assert.equal(fan.length, 183);
  assert.deepEqual(fan[0], { x: 0, y: 0 });
  assert.ok(fan.slice(1).every(({ x, y }) => Math.abs(Math.hypot(x, y) - 2) < 1e-9));
  // Behind the robot angles jump from -180 to 180 degrees, and the view does not end.
  assert.equal(view.fansOf(Array.from({ length: 61 }, (_, i) => at(150.25 + i, 1))).length, 1);
  // All around there is no corner at the robot.
  assert.deepEqual(view.fansOf([0.2, 90.2, 180.2, 270.2].flatMap((a) => Array.from({ length: 90 }, (_, i) => at(a + i, 1))))[0].length, 360);
  assert.deepEqual(view.fansOf([]), []);
});

test("lines of the map are 1, 2 or 5 of a power of ten apart", () => {
  assert.deepEqual([0.03, 0.5, 1.01, 4, 7, 10, 11].map(svg.roundStep), [0.05, 0.5, 2, 5, 10, 10, 20]);
});

test("cells of CSV files are quoted where they must be, and numbers are plain", () => {
  assert.equal(files.csvOf([["a", "12,345", "–", 'say "so", twice'], ["1,2,3", "1,234.5", "", "x\ny"]]), 'a,12345,,"say ""so"", twice"\r\n"1,2,3",1234.5,,"x\ny"\r\n');
});

test("boxes hold half of the values, and whiskers no outlier", () => {
  // Quarters at 3 and 7; whiskers reach to 13 at most.
  assert.deepEqual(boxes.boxOf([9, 1, 2, 3, 4, 5, 6, 7, 40]), {
    kind: "box", low: 1, quarter: 3, median: 5, three_quarters: 7, high: 9, outliers: [40],
  });
  assert.deepEqual(boxes.boxOf([3, 1, 2, 9]), { kind: "dots", median: 2.5, values: [1, 2, 3, 9] });
  assert.deepEqual(boxes.boxOf([4]), { kind: "dots", median: 4, values: [4] });
  assert.equal(boxes.boxOf([]), null);
});

test("ticks are round numbers", () => {
  assert.deepEqual(svg.ticks(0, 10, 5), [0, 2, 4, 6, 8, 10]);
  assert.deepEqual(svg.ticks(0.31, 0.52, 4), [0.4, 0.5]);
  assert.deepEqual(svg.ticks(-0.25, 0.25, 5), [-0.2, -0.1, 0, 0.1, 0.2]);
  assert.deepEqual(svg.logTicks(0.5, 2000), [1, 10, 100, 1000]);
  assert.deepEqual(svg.logTicks(0.3, 12), [0.5, 1, 2, 5, 10]);
});

test("certificates are told with what they prove, and what they do not", () => {
  const proved = { contact: 0.84, at_most: 0.61, distance_m: 1, rotation_deg: 30 };
  const sentence =
    "84.0 % of the local map's points are in contact at the declared pose; no pose more than 1 m or 30° away has more than 61.0 %.";
  assert.equal(certificate.certificateSentence(proved), sentence);
  assert.match(certificate.certificateSentence({ ...proved, at_most: 0.9 }), /a pose elsewhere may fit as well\.$/);
  const verification = { step: 4, refuted: false, score: 0.8, margin: 0.05, rivals: [], certificate: proved };
  assert.equal(certificate.verificationSentence(verification), `${sentence} No rival was found.`);
  const rival = { pose: { x: 3, y: -1.5, theta: 0 }, contact: 0.79, score: 0.78 };
  assert.match(certificate.verificationSentence({ ...verification, goes_on: true, certificate: undefined }), /the search of the whole map goes on\.$/);
  const refuted = certificate.verificationSentence({ ...verification, refuted: true, rivals: [rival], certificate: undefined });
  assert.match(refuted, /^Refuted\. The search of the whole map was given up, so nothing is proved\./);
  assert.match(refuted, /One rival was found; the best, at 3\.0 m, -1\.5 m, has score 0\.780, and 0\.750 is enough to refute/);
  // What refutes a pose need not be a rival.
  const worse = certificate.verificationSentence({ ...verification, refuted: true, rivals: [{ ...rival, score: 0.7 }] });
  assert.match(worse, /^Refuted\. .* has score 0\.700, less than the 0\.750 that would refute the declared pose/);
  // Results list the five best, however many there are.
  const told = (count) => certificate.verificationSentence({ ...verification, rivals: Array(count).fill(rival) });
  assert.match(told(4), / 4 rivals were found;/);
  assert.match(told(5), / At least 5 rivals were found;/);
});

const trial = (outcome, steps = 1) => ({ outcome, steps, start: {} });
const run = (name, variant, trials, settings = {}) => ({ name, trials, settings: { name: { text: "lab" }, ...settings }, provenance: variant && { variant: { role: "none", values: {}, ...variant } } });

test("runs are told by setting, by case or alone", () => {
  const runs = ["a", "b"].flatMap((setting) => ["lab", "hall"].flatMap((its) => [1, 2].map((seed) => run(`${setting}_${its}_seed-${seed}`, { setting, case: its, seed }, [trial("right")]))));
  const names = (level) => answers.groupsOf(runs, level).map(({ name, trials }) => [name, trials.length]);
  assert.deepEqual(names("setting"), [["a", 4], ["b", 4]]);
  assert.deepEqual(names("case"), [["a, lab", 2], ["a, hall", 2], ["b, lab", 2], ["b, hall", 2]]);
  assert.equal(names("run").length, 8);
  assert.deepEqual(answers.levelsOf(runs), ["setting", "case", "run"]);
  // Of other folders nothing is known but their names, and the same part twice is none of a whole.
  assert.deepEqual(answers.levelsOf([run("x", null, []), run("y", null, [])]), ["setting"]);
  assert.equal(answers.groupsOf([...runs, runs[0]], "setting").length, 8);
  // What has one name is not one method where its values differ.
  const changed = { ...runs[0], name: "changed", settings: { ...runs[0].settings, "localizer.contact_epsilon": { text: "0.2" } } };
  for (const part of [{ seed: 77 }, { case: "cellar" }]) {
    changed.provenance = { ...runs[0].provenance, variant: { ...runs[0].provenance.variant, ...part } };
    assert.equal(answers.groupsOf([...runs, changed], "setting").length, 9);
  }
  // Settings of one name in two experiments are two.
  const other = run("other", { setting: "a", case: "lab", seed: 1 }, [trial("wrong")], { name: { text: "second" } });
  assert.deepEqual(answers.groupsOf([runs[0], other], "setting").map(({ name }) => name), ["lab, a", "second, a"]);
});

test("the best come first: right less wrong, then fewer steps, and by nothing that judges", () => {
  const variant = (setting, more = {}) => ({ setting, case: "", seed: 1, ...more });
  const runs = [
    run("wrong", variant("wrong"), [trial("right"), trial("right"), trial("wrong")]),
    run("slow", variant("slow"), [trial("right", 9), trial("right", 5), trial("undecided")]),
    run("quick", variant("quick"), [trial("right", 4), trial("right", 6), trial("undecided")]),
    run("none", variant("none"), []),
  ];
  const order = (all) => answers.bestFirst(all, "setting").map(({ name }) => name);
  assert.deepEqual(order(runs), ["quick", "slow", "wrong", "none"]);
  const judged = run("slow_judged", variant("slow", { case: "other", role: "judge" }), [trial("right"), trial("right"), trial("right"), trial("right"), trial("right")]);
  assert.deepEqual(order([...runs, judged]), ["quick", "slow", "wrong", "none"]);
  // Who lacks a case may lack the harder one.
  const hard = (setting, outcome) => run(`${setting}_hard`, variant(setting, { case: "hard" }), [trial(outcome), trial("wrong"), trial("wrong")]);
  assert.deepEqual(order([...runs, hard("slow", "right"), hard("none", "wrong")]), ["slow", "none", "quick", "wrong"]);
  const { steps, right, undecided } = answers.answerOf(answers.groupOf("slow", [runs[1]]));
  assert.deepEqual([steps, right, undecided], [7, 2, 1]);
});

test("the time of a step is that of all steps where a run's summary tells it", () => {
  const timed = (summary) => ({ ...run("a", null, [trial("right")]), step_ms: [1, 2, 9], timed_steps: 3, summary });
  const of = (...runs) => answers.answerOf(answers.groupOf("a", runs)).step_ms;
  const summary = { complete: true, steps: 400, step_ms: { median: 2.5 } };
  assert.equal(of(timed(summary)), 2.5);
  assert.equal(of({ ...timed(summary), step_ms: [], timed_steps: 0 }), 2.5);
  // Medians of several runs are none of all their steps.
  assert.equal(of(timed(summary), timed(summary)), 2);
  assert.equal(of({ ...timed({ ...summary, steps: 0 }), step_ms: [] }), null);
});

test("runs are found by words of their names and of what they set otherwise", () => {
  const runs = [run("a", null, [], { "x.size": { text: "20" }, same: { text: "word" } }), run("b", null, [], { "x.size": { text: "30" }, same: { text: "word" } })];
  const found = (words) => answers.searched(runs, words).map(({ name }) => name);
  assert.deepEqual([found(""), found("size=30"), found("A size"), found("word"), found("a 30")], [["a", "b"], ["b"], ["a"], [], []]);
});

test("a comparison is read as far as it goes, with p only where something differs", () => {
  const outcome = { outcome: "right", both: 3, only_baseline: 2, only_variant: 0, neither: 1, differing_places: 2, difference_points: { value: -33, low: -60, high: 0 }, p: 0.5, p_holm: 1, significant: false };
  const same = { ...outcome, outcome: "wrong", only_baseline: 0, differing_places: 0 };
  const steps = { measure: "steps", differing_places: 0, baseline_median: 4, variant_median: 4, mean_difference: { value: 0, low: 0, high: 0 }, p: 1, p_holm: 1 };
  const found = comparison.read({ baseline: "a", warnings: ["w"], pairs: [{ variant: "b", conclusion: "c", warnings: ["v"], outcomes: [outcome, same], measures: [steps] }] });
  assert.deepEqual([found.conclusions, found.warnings], [["c"], ["w", "b: v"]]);
  assert.deepEqual(found.rows.map(({ variant, measure, baseline, own, p }) => [variant, measure, baseline, own, p]), [["b", "right", 5, 3, 1]]);
  assert.deepEqual(found.alike, [{ variant: "b", measures: ["wrong", "steps"] }]);
  // Over cases and seeds: places differ, and no test of one place can reject.
  const pooled = { measure: "steps", differing_places: 1, has_chance: false, baseline_median: 4, variant_median: 5, mean_difference: { value: 0.5, low: 0, high: 1 }, median_difference: 0, p_holm: 1 };
  const methods = [{ name: "a", success_rate: { value: 0.5, low: 0.25, high: 0.75 } }];
  const other = comparison.read({ starts: 8, places: 4, methods, pairs: [{ variant: "b", measures: [pooled] }] });
  assert.deepEqual(other.methods, [{ name: "a", right: methods[0].success_rate, wrong: undefined, undecided: undefined }]);
  assert.deepEqual([other.rows[0].p, other.rows[0].difference.value, other.places], [undefined, 0.5, 4]);
  for (const odd of [undefined, null, "text", [], 3]) assert.equal(comparison.read(odd), null);
  for (const odd of [{}, { pairs: 3 }, { pairs: [null, { outcomes: ["x"] }] }]) assert.deepEqual(comparison.read(odd).rows, []);
});

test("a start is lost where another method is right, to the best of these", () => {
  const entry = (method, ...outcomes) => ({ method, results: outcomes.map((outcome, i) => ({ case: ["room", "hall"][i], seed: 1, outcome })) });
  const [own, best, other] = [entry("own", "ruwdf", "w"), entry("best", "rrruu", "r"), entry("other", "urrrw", "u")];
  const told = (...parameters) => lost.lostStarts(...parameters).map(({ own: its, start, winner }) => `${its.case} ${start} ${winner}`);
  assert.deepEqual(told(own, [best, other]), ["room 2 best", "hall 0 best", "room 3 other", "room 1 best"]);
  assert.deepEqual(told(own, [other], "room"), ["room 2 other", "room 3 other", "room 1 other"]);
  assert.deepEqual(told(best, [own, other], "hall"), []);
  // A share has some of the starts: room 1 and 4 here.
  const share = { method: "share", results: [{ case: "room", seed: 1, numbers: [1, 4], outcome: "ru" }] };
  assert.deepEqual(told(own, [share]), ["room 1 share"]);
  assert.deepEqual(told(share, [own, best]), []);
  assert.deepEqual(told(share, [entry("fifth", "uuuur")]), ["room 4 fifth"]);
});

test("names in commands are single words, whatever is in them", () => {
  const start = { own: { case: "room", seed: 2 }, start: 7 };
  assert.equal(
    lost.explainCommands("small@1", "mine", start),
    "glocal run --suite small@1 --method mine --only mine_room_seed-2 --out results/explain/small@1/mine\nglocal explain results/explain/small@1/mine/mine_room_seed-2 --trial 7",
  );
  const name = "it's; rm -rf $HOME";
  const [command] = lost.explainCommands("small@1", name, start).split("\n");
  const words = JSON.parse(execFileSync("sh", ["-c", `glocal() { node -e 'console.log(JSON.stringify(process.argv.slice(1)))' -- "$@"; }; ${command}`], { encoding: "utf8" }));
  assert.deepEqual(words.slice(3), ["--method", name, "--only", `${name}_room_seed-2`, "--out", `results/explain/small@1/${name}`]);
});

test("addresses of lost starts come back, whatever is in their names", () => {
  const asked = { suite: "small@1", method: "a&by=b #1%", case: "", by: "<i>" };
  assert.deepEqual(board.askedIn(board.linkTo(asked)), asked);
  assert.equal(board.askedIn("#suite-0"), null);
});

test("a trial that is chosen is shown, whatever moves the steps until it is loaded", async () => {
  globalThis.document = { body: { dataset: {} } };
  const steps = (length) => ({ step: Array.from({ length }, (_, i) => i), verdict: Array(length).fill("searching") });
  const trials = [{ ...trial("right"), columns: steps(9) }, { ...trial("right"), chunk: 0 }, { ...trial("right"), chunk: 1 }];
  let loaded;
  const chunks = { load: (its) => new Promise((resolve, reject) => (loaded = (columns) => (columns ? resolve(Object.assign(its, { columns, chunk: undefined })) : reject(new Error("no steps"))))) };
  const page = new store.Store({ maps: [], runs: [{ trials }] }, chunks);
  await page.open();
  const choose = async (index, columns) => {
    page.chooseTrial(index);
    page.chooseStep(3);
    page.chooseHypothesis("reference");
    loaded(columns);
    await new Promise((resolve) => setTimeout(resolve));
    return page.selected;
  };
  assert.deepEqual(await choose(1, steps(5)), { run: 0, trial: 1, step: 4, hypothesis: "estimate" });
  page.chooseStep(3);
  assert.equal(page.selected.step, 3);
  assert.deepEqual(missing.whatIsMissing({ map: {}, trial: page.trial, steps: page.steps, fault: page.fault }), []);
  // Nor does it stop where nothing comes.
  assert.deepEqual(await choose(2), { run: 0, trial: 2, step: 0, hypothesis: "estimate" });
  assert.deepEqual(missing.whatIsMissing({ map: {}, trial: page.trial, steps: page.steps, fault: page.fault }), ["no steps."]);
  delete globalThis.document;
});

test("what cannot be seen is told in the words of the page", () => {
  const steps = { step: [0], verdict: ["unknown_place"], clusters: [7] };
  const shown = { steps, trial: { trial: 4 }, selected: { step: 0 } };
  assert.equal(missing.shownIn("Map", shown), "Map at step 0 of trial 4: unknown place, 7 clusters");
  assert.equal(missing.shownIn("Map", { ...shown, steps: undefined }), "Map");
});

test("poses in space are read from their columns", () => {
  const pose = { x: [1, null], y: [2, null], z: [3, null], qx: [0, null], qy: [0, null], qz: [0.6, null], qw: [0.8, null] };
  assert.deepEqual(spacePoses.columnPose(pose, 0), { position: [1, 2, 3], rotation: [0, 0, 0.6, 0.8] });
  assert.equal(spacePoses.columnPose(pose, 1), null);
  assert.equal(spacePoses.columnPose({ x: [1], y: [2] }, 0), null);
  const steps = { candidates: [[1, 2, 0, 4, 5, 0.1]], candidates_in_space: [[3, 0, 0, 0, 1, 6, 0, 0, 1, 0]] };
  assert.deepEqual(spacePoses.candidatePose(steps, 0, 1), { position: [4, 5, 6], rotation: [0, 0, 1, 0] });
});
