// The page of glocal leaderboard: what methods have come to on suites, start by start.
import { askedIn, linkTo, scoreOf, type Board, type BoardSuite, type Counts, type Entry, type Renewal } from "./board_data";
import { LostStarts } from "./board_lost";
import { lineSample } from "./curves";
import type { Proportion } from "./data";
import { DataTable, type Column } from "./data_table";
import { append, el, replace, section, type Child } from "./elements";
import { count, fixed, percent, proportion } from "./numbers";
import { startPage, themeButton } from "./page_frame";
import { intervalChart, levelChart, shareChart, type Mark, type SharePanel } from "./share_chart";
import { showMeanings } from "./words";

const mostRows = 30;
/** Of the colours of runs: those of right and of wrong starts everywhere. */
const rightColour = 2;
const wrongColour = 1;

const outcomes = ["wrong", "right", "undecided"] as const;

/** Where nothing happened there is nothing to be alarmed by. */
const kindOf = (n: number, outcome: string): string => (n > 0 ? outcome : "none");

function counts(all: Counts, link: string): HTMLElement {
  const between = ({ low, high }: Proportion): string => `${(100 * low).toFixed(1)} to ${percent(high)}`;
  // Spaces are for files and for screen readers.
  const line = (outcome: (typeof outcomes)[number]): Child[] => [
    el("b", { class: kindOf(all[outcome], outcome) }, count(all[outcome])),
    " ",
    el("span", {}, outcome),
    " ",
    el("small", {}, between(all[`${outcome}_rate`])),
    " ",
  ];
  return el("a", { class: "counts", href: link }, ...outcomes.flatMap(line));
}

/** Of entries that may have a share of a suite. */
const mostStarts = ({ entries }: BoardSuite, of: (entry: Entry) => Counts): number => Math.max(...entries.map((entry) => of(entry).starts));

function overview({ methods, suites }: Board): HTMLElement {
  const entryOf = ({ entries }: BoardSuite, method: string): Entry | undefined => entries.find((entry) => entry.method === method);
  const columns = suites.map((suite): Column<string> => ({
    name: suite.suite,
    meaning: `Wrong, right and undecided of ${count(mostStarts(suite, ({ all }) => all))} starts, with 95 % intervals.`,
    cell: (method) => {
      const entry = entryOf(suite, method);
      if (!entry) return "–";
      return el("div", {}, counts(entry.all, linkTo({ suite: suite.suite, method })), entry.label !== method && el("small", {}, `of ${count(entry.all.starts)} starts`));
    },
    order: { by: (method) => { const entry = entryOf(suite, method); return entry && scoreOf(entry.all); }, best: "most" },
  }));
  const table = new DataTable([{ name: "method", meaning: "The best first: by right starts less wrong ones, over all suites.", cell: (method) => method }, ...columns], { keys: 2, most: mostRows, what: "methods", className: "board" });
  table.setRows(methods);
  return section(
    "methods",
    "All methods",
    table.element,
    el("p", { class: "note" }, "The best first: by right starts less wrong ones. Intervals are 95 %, after Wilson, as if starts were independent. A click on numbers lists the starts that the method loses and another one wins."),
  );
}

/** What belongs to a suite, and what draws its charts anew. */
interface SuitePart {
  element: HTMLElement;
  rebuild: () => void;
}

function suitePart(board: Board, suite: BoardSuite, i: number): SuitePart {
  const { entries } = suite;
  const indexOf = ({ method }: Entry): number => board.methods.indexOf(method);
  const charts = [bySteps(suite, indexOf), ...byTime(suite, indexOf), ...byLevel(suite, indexOf), ...entries.filter(({ renewals }) => renewals.length > 1).map((entry) => overRenewals(suite, entry))];
  const cpus = [...new Set(entries.flatMap(({ step_ms, cpu }) => (step_ms !== undefined && cpu ? [cpu] : [])))];
  const element = section(
    `suite-${i}`,
    suite.suite,
    el("p", { class: "names" }, ...entries.map((entry) => el("span", {}, lineSample(indexOf(entry)), entry.method))),
    el("div", { class: "panels" }, ...charts.map((each) => each.element)),
    cpus.length > 0 && el("p", { class: "note" }, `CPU time of a step: median over all starts, on ${cpus.join("; ")}.`),
    byCase(suite),
    ...renewals(board, suite),
  );
  return { element, rebuild: () => charts.forEach((each) => each.rebuild()) };
}

function bySteps({ suite, entries }: BoardSuite, indexOf: (entry: Entry) => number): SharePanel {
  const samples = entries.map((entry) => ({
    label: entry.label,
    index: indexOf(entry),
    values: entry.results.flatMap(({ outcome, steps }) => steps.filter((_, start) => outcome[start] === "r")),
    of: entry.all.starts,
  }));
  return shareChart("steps", `${suite}: right within so many steps`, samples, { xLabel: "step", label: "share of starts declared right" });
}

function byTime({ suite, entries }: BoardSuite, indexOf: (entry: Entry) => number): SharePanel[] {
  const marks = entries.flatMap((entry): Mark[] =>
    entry.step_ms === undefined ? [] : [{ x: entry.step_ms, rate: entry.all.right_rate, index: indexOf(entry), shape: "●", name: entry.label }],
  );
  if (marks.length === 0) return [];
  const powers = marks.map(({ x }) => Math.log10(x));
  const xRange: [number, number] = [10 ** (Math.ceil(Math.min(...powers)) - 1), 10 ** (Math.floor(Math.max(...powers)) + 1)];
  return [intervalChart("time", `${suite}: right, by CPU time of a step`, marks, { xLabel: "CPU time of a step, ms (logarithmic)", label: "share of starts declared right", logX: true, xRange })];
}

function byLevel({ disturbances, entries }: BoardSuite, indexOf: (entry: Entry) => number): SharePanel[] {
  return disturbances.map((kind, i) => {
    const samples = entries.map((entry) => ({ label: entry.label, index: indexOf(entry), values: entry.kept[i] }));
    // Few starts may do better with a disturbance than without.
    const most = Math.max(1, ...samples.flatMap(({ values }) => values.map((share) => share ?? 0)));
    return levelChart(`kept-${kind}`, `${kind}: success kept`, samples, { xLabel: "level", label: "share of the undisturbed success", range: [0, 1.1 * most], whole: true });
  });
}

function byCase(all: BoardSuite): HTMLElement {
  const { suite, cases, entries } = all;
  const startsOf = (i: number): number => mostStarts(all, (entry) => entry.cases[i]);
  const column = (entry: Entry): Column<number> => ({
    name: entry.label,
    meaning: `Wrong / right of the starts of a case, by ${entry.method}.`,
    cell: (i) => {
      if (entry.cases[i].starts === 0) return "–";
      const { wrong, right, wrong_rate, right_rate } = entry.cases[i];
      const title = `wrong ${proportion(wrong_rate)}, right ${proportion(right_rate)}`;
      return el("a", { href: linkTo({ suite, method: entry.method, case: cases[i] }), title }, el("b", { class: kindOf(wrong, "wrong") }, count(wrong)), ` / ${count(right)}`);
    },
    order: { by: (i) => scoreOf(entry.cases[i]), best: "most" },
    kind: () => "number",
  });
  const columns: Column<number>[] = [
    { name: "case", meaning: "A map, a drive on it, and where on the drive trials start.", cell: (i) => cases[i] },
    { name: "starts", meaning: "Starts of a case, with all seeds.", cell: (i) => count(startsOf(i)), order: { by: startsOf, best: "most" }, kind: () => "number" },
    ...entries.map(column),
  ];
  const table = new DataTable(columns, { keys: 2, most: mostRows, what: "cases", className: "board" });
  table.setRows(cases.map((_, i) => i));
  return el("div", {}, el("h3", {}, "By case: wrong / right"), table.element);
}

function overRenewals({ suite }: BoardSuite, { method, renewals: all }: Entry): SharePanel {
  const marks = all.flatMap(({ right_rate, wrong_rate, significant }, i): Mark[] => [
    { x: i + 1, rate: right_rate, index: rightColour, shape: "●", isJoined: true, isNoted: significant },
    { x: i + 1, rate: wrong_rate, index: wrongColour, shape: "■", isJoined: true },
  ]);
  return intervalChart("renewals", `${suite}, ${method}: right ● and wrong ■`, marks, {
    xLabel: "renewal",
    label: "share of starts",
    xRange: [0.5, all.length + 0.5],
    whole: true,
  });
}

function renewals({ significance }: Board, { entries }: BoardSuite): Child[] {
  const rows = entries.flatMap(({ method, renewals: all }) => all.map((renewal, i) => ({ method, i, ...renewal })));
  if (rows.length === 0) return [];
  type Row = (typeof rows)[0];
  const p = (name: "p_wrong" | "p_right"): Column<Row> => ({
    name: name.replace("_", ", "),
    meaning: "How likely a difference to the renewal before would be that is no smaller, if nothing had changed. Bold: significant.",
    cell: ({ [name]: value }) => {
      const text = value === undefined ? "–" : value < 0.001 ? "< 0.001" : fixed(value, 3);
      return value !== undefined && value < significance ? el("strong", {}, text) : text;
    },
    kind: () => "number",
  });
  const counted = (outcome: (typeof outcomes)[number]): Column<Row> => ({ name: outcome, cell: (row) => count(row[outcome]), kind: (row) => `number ${kindOf(row[outcome], outcome)}` });
  const columns: Column<Row>[] = [
    { name: "renewal", meaning: "How often the results of the method have been renewed.", cell: ({ method, i }) => `${method} ${i + 1}` },
    counted("wrong"),
    counted("right"),
    counted("undecided"),
    { name: "date", meaning: "When the results were made.", cell: ({ date }) => date },
    { name: "revision", meaning: "The commit that they are of.", cell: ({ revision }) => revision },
    ...(rows.some(({ i }) => i > 0) ? [p("p_wrong"), p("p_right")] : []),
  ];
  const table = new DataTable<Row & Renewal>(columns, { keys: 3, most: mostRows, what: "renewals", className: "board" });
  table.setRows(rows);
  const note =
    "▼ and bold: a step that is significant, by Fisher's exact test of two shares, after Holm over all steps of a method on the suite. It knows counts alone, takes the " +
    "same starts for others, and so finds less than the comparison that glocal leaderboard add --force prints.";
  return [el("h3", {}, "Renewals"), table.element, rows.some(({ i }) => i > 0) && el("p", { class: "note" }, note)];
}

function show(board: Board, page: HTMLElement): void {
  const suites = board.suites.map((suite, i) => suitePart(board, suite, i));
  const rebuild = (): void => suites.forEach((suite) => suite.rebuild());
  const lost = new LostStarts(board);
  const links = [...board.suites.map(({ suite }, i) => [suite, `suite-${i}`]), ["Lost starts", "lost"]];
  replace(
    page,
    el("header", {}, el("h1", {}, "Leaderboard"), themeButton(rebuild), el("nav", { "aria-label": "Parts of the page" }, ...links.map(([name, id]) => el("a", { href: `#${id}` }, name)))),
    el("main", { class: "board-page" }, overview(board), ...suites.map((suite) => suite.element), lost.element),
  );
  append(page, el("p", { class: "note" }, `Made by ${board.generator}.`));
  rebuild();
  showMeanings(page);
  const follow = (): void => {
    const asked = askedIn(location.hash);
    if (!asked) return;
    lost.show(asked);
    lost.element.scrollIntoView({ behavior: "auto" });
  };
  window.addEventListener("hashchange", follow);
  follow();
  document.body.dataset.shown = "board";
}

startPage<Board>(show);
